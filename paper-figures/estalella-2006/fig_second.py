"""Estalella et al. 2006, section 7: second bounces, which the paper leaves open.

To be seen: Two mirror spheres among columns, from behind: what each shows of the other is black with one bounce, and
reflects with two; at the right ray traced, to four bounces. Below, where the two meet, and part of a hall of nine
mirror spheres and two dishes. What is seen by a third bounce stays black.

Claim: None; second bounces are future work there.
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main, render

ONCE, TWICE = "virtual-objects@revised", "virtual-objects@revised:bounces=2"
CASES = {"one bounce": ONCE, "two bounces": TWICE, "ray traced": "truth"}
# Scene, frame, size, and of it the close-up: left, top, right, bottom, as shares.
SPHERES = ("two-spheres", 240, "480x300", (0.2, 0.35, 0.42, 0.72))
HALL = ("hall-of-mirrors", 0, "128x96", (0.3, 0.3, 0.72, 0.7))


def draw(figure):
    plot, axes = plt.subplots(
        3, len(CASES), figsize=(10.4, 8.2), layout="constrained", height_ratios=(0.62, 1.0, 0.72)
    )
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95), h_pad=0.03, w_pad=0.03)
    table = []
    for column, (name, case) in zip(axes.T, CASES.items(), strict=True):
        for (whole, close), (scene, frame, size, box) in ((column[:2], SPHERES), ((None, column[2]), HALL)):
            run = render(scene, case, frame=frame, size=size)
            figure.cite(run)
            picture = images.to_srgb(run.frame().colour)
            if whole is not None:
                show(whole, picture)
                whole.set_title(name)
            show(close, cropped(picture, box))
            table += rows_of(run, scene, name) if case != "truth" else []
    figure.plot = plot
    header = ["scene", "method", "mirrors met", "share", "bad at 1 px", "missing"]
    figure.table("Errors by the mirrors the truth met", header, sorted(table))
    said = [f"{row[0]} {row[4]} ({row[1]})" for row in sorted(table) if row[2] == "2"]
    figure.finding(f"Bad at 1 px where the truth meets two mirrors: {', '.join(said)}.")


def rows_of(run, scene, name):
    for order in run.row["accuracy"]["by_order"]:
        shares = (order["share"], order["bad_share"]["1"], order["missing"])
        yield [scene, name, str(order["order"]), *(f"{share:.1%}" for share in shares)]


def cropped(picture, box):
    height, width, _ = picture.shape
    left, top, right, bottom = (round(at * side) for at, side in zip(box, (width, height) * 2, strict=True))
    return picture[top:bottom, left:right]


def show(axis, picture):
    axis.imshow(picture, interpolation="nearest")
    axis.set(xticks=[], yticks=[])
    axis.spines[:].set_visible(False)


if __name__ == "__main__":
    main(__file__, __doc__, draw)
