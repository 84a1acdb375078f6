"""Popescu et al. 2006, slides 36 to 38: a ray in a depth image, and in a row of a rotated one.

To be seen: Left, a statue's depth image (light is near) and a ray across it; below, what the ray passes: each
texel's height along its line, and the ray's own. Right, the depth image turned by the multiple of 10 degrees
that lies nearest to the ray, so that the ray is nearly a row; below, that row as 8 segments and as 32, and the
same ray. Where it first goes below the surface it is hit: texel after texel on the left, among a few segments
on the right, a little beside the ray's own line.

Claim: "Epipolar-like constraints: intersection computed as 1D search. Still too many steps along epipolar
segment" (36). "Pre-rotate depth map. All rays ever needed project to rows. Pre-simplify rows" (37).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.depth_rows import DUMP, along, depth_image, rotated, simplify
from mirrorfigures.figure import QUIET

SIZE = 256
CASE = f"depth-impostors@revised:objects=2,rays=parallel,size={SIZE},step_deg=10,view=start,views=1"
# The floor is the first; a place and a direction in texels, and heights at the ray's ends as shares.
LAYER, PLACE, TURN_DEG, HEIGHTS = 1, (138.0, 128.0), 14.5, (0.97, 0.02)
STEP = np.radians(10.0)
# The thickness shown over the width shown.
THICK = 0.6


def draw(figure):
    run = render("statue", CASE, size="192x144", dump=DUMP)
    figure.cite(run)
    heights = depth_image(run, LAYER)
    size, top = len(heights), np.nanmax(heights)
    texel = top / THICK / size
    turn = np.radians(TURN_DEG)
    unit = np.array([np.cos(turn), np.sin(turn)])
    middle = np.array(PLACE) * size / SIZE
    steps = np.arange(-0.44 * size, 0.44 * size)
    places = middle + steps[:, None] * unit
    ray = np.linspace(HEIGHTS[0] * top, HEIGHTS[1] * top, len(steps))
    surface = along(heights, places)
    nearest = np.round(turn / STEP) * STEP
    turned = rotated(heights, nearest)
    back = np.array([[np.cos(nearest), np.sin(nearest)], [-np.sin(nearest), np.cos(nearest)]])
    line = size / 2 + (places - size / 2) @ back.T
    row = int(np.clip(line[len(line) // 2, 1], 0, size - 1))
    plot, axes = plt.subplots(2, 2, figsize=(9.0, 6.6), layout="constrained", height_ratios=(1.7, 1))
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    for axis, image, at, title in (
        (axes[0, 0], heights, places, "depth image, and a ray (36)"),
        (axes[0, 1], turned, line, f"turned by {np.degrees(nearest):.0f} degrees, and the row (37)"),
    ):
        axis.imshow(image, cmap="bone", interpolation="nearest", extent=(0, size, size, 0))
        axis.plot(*at.T, color=COLOURS[1], lw=1.2)
        axis.set(title=title, xticks=[], yticks=[], xlim=(0, size), ylim=(size, 0))
    axes[0, 1].axhline(row + 0.5, color=COLOURS[5], lw=1.2, ls="--")
    marched = np.flatnonzero((surface[:-1] > -1) & (ray[:-1] >= surface[:-1]) & (ray[1:] < surface[1:]))
    texels = int(marched[0]) + 2 if len(marched) else len(steps)
    left, right = axes[1]
    left.plot(steps, surface, ".", color=QUIET, ms=2, label="texels")
    left.plot(steps, ray, color=COLOURS[1], lw=1.2, label="ray")
    read = draw_row(right, turned[row], texel, line, ray)
    for axis, what in ((left, "texels along the ray"), (right, "texels along the row")):
        axis.set(xlabel=what, ylabel="height, m", ylim=(-0.05 * top, 1.1 * top))
        axis.grid(color=GRID, lw=0.6)
        axis.legend(fontsize=7.5, loc="upper right")
    figure.plot = plot
    figure.number("texels read before the hit", texels)
    figure.number("segments of the row", read)
    figure.finding(
        f"This ray reads {texels} texels until it is hit; the row has {read[8]} segments at most 8, {read[32]} at "
        "most 32."
    )


def draw_row(axis, row, texel, line, ray):
    """A row's texels, its segments, and the ray; how many segments each budget takes."""
    axis.plot(np.arange(len(row)) + 0.5, row, ".", color=QUIET, ms=2, label="texels")
    used = {}
    for most, colour, style in ((8, COLOURS[0], "o-"), (32, COLOURS[2], "s-")):
        segments = simplify(row, most, texel)
        used[most] = len(segments)
        for i, (start, end) in enumerate(segments):
            name = f"{len(segments)} segments" if i == 0 else None
            axis.plot(*zip(start, end, strict=True), style, color=colour, ms=2.5, lw=1, label=name)
    axis.plot(line[:, 0], ray, color=COLOURS[1], lw=1.2, label="ray")
    return used


if __name__ == "__main__":
    main(__file__, __doc__, draw)
