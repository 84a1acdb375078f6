"""Lecture 18, "Notice the poor resolution at the rim of the circle": what a texel of a sphere map covers.

To be seen: Against the distance from the disc's centre, from the directions the GPU's map holds (dots)
and in closed form (lines): a texel's extent towards the rim and across, in degrees, and its solid
angle beside that of the mean texel.

Claim: The resolution is poor at the rim. In closed form the solid angle is 4 a unit of the disc's area
everywhere, on the rim too; what is poor is its shape: long as 1 / cos, thin as cos of the normal's angle.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.exr import read_channels

BINS = np.concatenate([np.linspace(0.0, 0.9, 19), [0.94, 0.97, 0.985, 0.995]])


def draw(figure):
    # Nothing but sky: every texel's evidence is its direction.
    case = "environment-map:projection=sphere,source=ball,size=256"
    run = render("sky", case, size="320x320", dump="environment-map/ball")
    figure.cite(run)
    point = read_channels(run.files / "dump" / "environment-map" / "ball" / "map_point.exr")
    direction = np.stack([point[c] for c in "RGB"], axis=-1).astype(np.float64)
    side = len(direction)
    rho, away, across, solid = measured(direction)
    step = 2 / side
    plot, (extent, area) = plt.subplots(1, 2, figsize=(8.6, 3.7), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.94))
    r = np.linspace(0, 0.996, 400)
    cosine = np.sqrt(1 - r**2)
    centres = (BINS[1:] + BINS[:-1]) / 2
    which = np.digitize(rho, BINS) - 1
    means = [np.array([v[which == i].mean() for i in range(len(centres))]) for v in (away, across, solid)]
    for mean, line, colour, label in (
        (means[0], 2 / cosine, COLOURS[1], "towards the rim: 2 / cos"),
        (means[1], 2 * cosine, COLOURS[0], "across: 2 cos"),
    ):
        extent.plot(r, np.degrees(line * step), color=colour, label=label)
        extent.plot(centres, np.degrees(mean * step), "o", color=colour, ms=4)
    extent.set(xlabel="distance from the centre of the disc", ylabel="extent of a texel, degrees", ylim=(0, None))
    extent.set_title(f"a texel's extent, {side} texels across")
    area.axhline(1, color=COLOURS[2], label="closed form")
    area.plot(centres, means[2] / 4, "o", color=COLOURS[2], ms=4, label="measured")
    area.set(xlabel="distance from the centre of the disc", ylabel="solid angle, of the mean texel", ylim=(0, 1.3))
    area.set_title("a texel's solid angle")
    for axis in (extent, area):
        axis.grid(color=GRID, lw=0.6)
        axis.legend(fontsize=8)
    figure.plot = plot
    worst = float(np.abs(means[2] / 4 - 1).max())
    figure.number("largest difference of the solid angle from the closed form", worst)
    figure.finding(
        f"Measured, the solid angle is the same to {100 * worst:.1f} % in all rings up to 0.99 of the radius: the rim "
        f"has as many texels as it should, but slivers. At 0.99 they are {means[0][-1] / means[1][-1]:.0f} times "
        f"as long as wide; the outermost texel reaches over {np.degrees(2 * np.sqrt(2 * step)):.0f} degrees."
    )


def measured(direction: np.ndarray) -> tuple:
    """Per texel inside the disc: distance from the centre, how far the direction turns away from the
    centre and across, and the solid angle, the last three a unit of the disc."""
    side = len(direction)
    s, t = np.meshgrid(*(2 * ((np.arange(side) + 0.5) / side - 0.5),) * 2)
    t = -t
    # Central differences along columns and rows, turned into the disc's polar directions.
    along_s = (direction[1:-1, 2:] - direction[1:-1, :-2]) / (4 / side)
    along_t = (direction[:-2, 1:-1] - direction[2:, 1:-1]) / (4 / side)
    s, t = s[1:-1, 1:-1], t[1:-1, 1:-1]
    rho = np.hypot(s, t)
    inside = (rho < BINS[-1]) & (rho > 1e-3)
    unit_s, unit_t = (np.where(inside, v / np.maximum(rho, 1e-9), 0)[..., None] for v in (s, t))
    away = np.linalg.norm(unit_s * along_s + unit_t * along_t, axis=-1)
    across = np.linalg.norm(unit_s * along_t - unit_t * along_s, axis=-1)
    solid = np.linalg.norm(np.cross(along_s, along_t), axis=-1)
    return rho[inside], away[inside], across[inside], solid[inside]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
