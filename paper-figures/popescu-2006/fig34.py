"""Popescu et al. 2006, slide 34: what billboards cannot show, measured.

To be seen: Mirror pixels that are wrong at 1 px as a box leaves a mirror ball, from a centimetre to two metres: all
methods on the same scene; and the intersections of a pixel between two facing mirrors, over numbers of diffuse and
reflective things and orders.

Claim: "No support for objects very close to the reflector; limited accuracy: flat reflection, lack of motion
parallax"; the cost is "O(K*(D+R))" (16).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.billboards import METHOD
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.variants import head, scene_file, thing

GAPS = (0.01, 0.1, 0.3, 1.0, 2.0)
CASES = {
    "published": METHOD,
    "revised": f"{METHOD}@revised",
    "z-buffered map": "z-buffered-map@revised:size=256",
    "environment map": "environment-map",
}
CHECKS = (0.2, 0.2)
BALL = "sphere = { radius = 0.8, slices = 96, stacks = 48 }"
SMALL = "sphere = { radius = 0.25, slices = 24, stacks = 12 }"
WALL = "plane = { size = [6.0, 6.0] }"
BOX = "box = { size = [0.5, 0.5, 0.5] }"


def gap_scene(gap):
    """A box beside a mirror ball, its face so far from the ball's surface."""
    ball = thing("ball", BALL, "mirror", (0, 0.8, 0))
    box = thing("box", BOX, "paint", (0.8 + gap + 0.25, 0.8, 0.3))
    return scene_file("gap", head(40.0, (0.6, 1.6, 5.0), (0.3, 0.8, 0.0), CHECKS) + ball + box)


def grid_scene(diffuse, reflective):
    """Two flat mirrors, the eye between them, so that rays go to and fro; aside of those so many boxes, and mirror
    balls to make up the number."""
    parts = [(f"box-{i}", BOX, "paint") for i in range(diffuse)]
    parts += [(f"ball-{i}", SMALL, "mirror") for i in range(reflective - 2)]
    aside = [(4.0 + i, 3.0, 0.0) for i in range(len(parts))]
    text = head(40.0, (0.3, 0.1, 1.5), (0.0, 0.0, -2.0), CHECKS)
    text += thing("wall-1", WALL, "mirror", (0, 0, -2), (90, 0, 0))
    text += thing("wall-2", WALL, "mirror", (0, 0, 2), (-90, 0, 0))
    text += "".join(thing(*part, at) for part, at in zip(parts, aside, strict=True))
    return scene_file("grid", text)


def draw(figure):
    plot, (gaps, counts) = plt.subplots(1, 2, figsize=(9.6, 3.8), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    table = []
    for (name, case), colour, marker in zip(CASES.items(), COLOURS, MARKERS, strict=False):
        runs = [render(gap_scene(gap), case, size="160x120") for gap in GAPS]
        figure.cite(*runs)
        shares = [100 * run.row["accuracy"]["bad_share"]["1"] for run in runs]
        gaps.plot(GAPS, shares, color=colour, marker=marker, label=name)
        table.append([name, *(f"{share:.2f} %" for share in shares)])
    gaps.set(xscale="log", xlabel="gap, m", ylabel="bad at 1 px, % of mirror pixels", ylim=(0, None))
    gaps.legend(fontsize=8)
    figure.table("Bad at 1 px by the gap between box and ball", ["case", *(f"{gap:g} m" for gap in GAPS)], table)
    fitted(figure, counts)
    for axis in (gaps, counts):
        axis.grid(color=GRID, lw=0.6)
    figure.plot = plot


def fitted(figure, axis):
    """The most intersections of a pixel, all billboards tested at every order, against K (D + R)."""
    sizes, most = [], []
    for k in (1, 2, 4):
        for d in (1, 4):
            for r in (2, 8):
                run = render(grid_scene(d, r), f"{METHOD}:last=all,bounces={k},size=32", size="96x64")
                figure.cite(run)
                sizes.append(k * (d + r))
                most.append(run.row["counters"]["most_intersections"])
    slope, offset = np.polyfit(sizes, most, 1)
    axis.plot(sizes, most, "o", color=COLOURS[0], ms=4)
    line = np.array([0, max(sizes)])
    axis.plot(line, slope * line + offset, color=COLOURS[1], lw=1, label=f"{slope:.2f} K (D + R) {offset:+.1f}")
    axis.set(xlabel="K (D + R)", ylabel="intersections of a pixel, most", ylim=(0, None))
    axis.legend(fontsize=8)
    figure.number("slope", float(slope))
    figure.finding(
        f"The most intersections a pixel grow as {slope:.2f} K (D + R) {offset:+.1f} over {len(sizes)} grids; by the "
        f"slide's own rule they are K (D + R - 1)."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
