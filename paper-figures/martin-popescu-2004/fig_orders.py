"""Reflection morphing over several mirrors: a projection of every vertex for each chain of them.

To be seen: Two mirror spheres among columns, from behind, and where they meet. With one bounce each shows the other
black. Rays at the eye are followed from mirror to mirror, and those of each chain give vertices a place of their own:
reflections of reflections stand where the truth has them. Octrees at a grid's nodes know the same chains, by fewer rays,
and what any of eight nodes lacks is missing.

Claim: "In the future, reflection morphing could be extended to render higher order reflections. Much of the necessary
framework for this is already in place" (section 9).
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main, render

SCENE, FRAME, SIZE = "two-spheres", 240, "480x300"
CASES = {
    "rays at the eye, one bounce": "reflection-morphing:nodes=eye",
    "rays at the eye, three": "reflection-morphing:nodes=eye,bounces=3",
    "a grid's nodes, three": "reflection-morphing:files=none,bounces=3",
    "ray traced": "truth",
}
# Left, top, right, bottom of the close-up, as shares.
BOX = (0.2, 0.35, 0.42, 0.72)


def draw(figure):
    plot, axes = plt.subplots(2, len(CASES), figsize=(11.5, 5.6), layout="constrained", height_ratios=(0.62, 1.0))
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.94), h_pad=0.03, w_pad=0.03)
    table = []
    for (whole, close), (name, case) in zip(axes.T, CASES.items(), strict=True):
        run = render(SCENE, case, frame=FRAME, size=SIZE)
        figure.cite(run)
        picture = images.to_srgb(run.frame().colour)
        height, width, _ = picture.shape
        left, top, right, bottom = (round(at * side) for at, side in zip(BOX, (width, height) * 2, strict=True))
        for axis, part in ((whole, picture), (close, picture[top:bottom, left:right])):
            axis.imshow(part, interpolation="nearest")
            axis.set(xticks=[], yticks=[])
            axis.spines[:].set_visible(False)
        whole.set_title(name, fontsize=9)
        if case != "truth":
            table += [[name, *cells] for cells in by_order(run.row)]
    figure.plot = plot
    figure.table("Errors by the mirrors the truth met", ["method", "mirrors met", "share", "bad at 1 px", "missing"], table)
    second = {row[0]: row[3] for row in table if row[1] == "2"}
    figure.finding(
        "Bad at 1 px where the truth meets two mirrors: " + ", ".join(f"{bad} ({name})" for name, bad in second.items()) + "."
    )


def by_order(row):
    for order in row["accuracy"]["by_order"]:
        shares = (order["share"], order["bad_share"]["1"], order["missing"])
        yield [str(order["order"]), *(f"{share:.1%}" for share in shares)]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
