"""Lecture 18, "Solution 1" and "Solution 2": the map looked up per vertex, or per fragment, on a square mirror.

To be seen: One square mirror, two triangles. Colours looked up at its corners and blended make a
gradient, with the diagonal showing. Rays blended from the corners and looked up at each pixel give the
picture of rays computed at each pixel but for a slight warp; that is an environment map's picture, larger
than the truth as it ignores where the mirror is.

Claim: Solution 1 is bad: "it would smoothly interpolate between the values at the four corners. That's not
what real mirrors do." Solution 2 is good.
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main, render

SIZE = "640x480"
CASES = {
    "solution 1: colours per vertex": "environment-map:shade_at=vertex",
    "solution 2: rays per vertex": "environment-map:shade_at=vertex-ray",
    "rays per pixel": "environment-map",
    "ray-traced truth": "truth",
}


def draw(figure):
    runs = {title: render("square-mirror", case, size=SIZE) for title, case in CASES.items()}
    figure.cite(*runs.values())
    frames = {title: run.frame() for title, run in runs.items()}
    left, top, right, bottom = images.box_around(frames["ray-traced truth"].mirror)
    frame = 24
    crop = (slice(max(top - frame, 0), bottom + frame), slice(max(left - frame, 0), right + frame))
    plot, axes = plt.subplots(1, 4, figsize=(10.6, 3.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.93))
    for axis, (title, seen) in zip(axes, frames.items(), strict=True):
        axis.imshow(images.to_srgb(seen.colour)[crop], interpolation="nearest")
        axis.set_title(title)
        axis.axis("off")
    figure.plot = plot
    pixel = frames["rays per pixel"]
    off = {
        title: float(images.colour_error(seen.colour, pixel.colour)[pixel.mirror].mean())
        for title, seen in list(frames.items())[:2]
    }
    figure.number("mean difference from rays per pixel", off)
    figure.table(
        "Against rays per pixel",
        ["", "mean difference of the displayed colour, %"],
        [[title, f"{100 * value:.1f}"] for title, value in off.items()],
    )
    one, two = off.values()
    figure.finding(
        f"Displayed colours differ from those of rays per pixel by {100 * one:.0f} % on the mean with solution 1 and by "
        f"{100 * two:.0f} % with solution 2, whose blended rays bend edges a little."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
