"""Lecture 18, "Refraction": a glass ball by environment map and by tracing, over the refractive index.

To be seen: Above, the ball of `glass-sphere` traced, and by environment map looked up along the ray bent
once, at the first surface. Below, over the index: the share of the ball's pixels where what is seen
through it is the same object in both, and how far apart the points are that are seen there.

Claim: "You can use environment mapping or ray tracing to get the RGB value." The map bends a ray by half and
leaves out where it passes the centre. For rays near the axis the two cancel on a wall at distance L behind
a ball of radius R where (n - 1) / n = R / L: at index 1.36 here (dotted).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main, render
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.exr import NO_OBJECT, read_channels
from mirrorfigures.variants import changed

INDICES = (1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0, 2.2, 2.4)
SHOWN = (1.0, 1.5, 2.4)
SIZE = "400x400"
# The ball's radius, and the wall's distance from its centre.
RADIUS_M, WALL_M = 0.8, 3.0


def draw(figure):
    pairs = {}
    for index in INDICES:
        scene = changed("glass-sphere", "index = 1.5", f"index = {index}")
        pairs[index] = [render(scene, case, size=SIZE) for case in ("truth", "environment-map")]
        figure.cite(*pairs[index])
    same, apart = np.array([judged(*pair) for pair in pairs.values()]).T
    plot = plt.figure(figsize=(9.0, 7.4), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.03, 1, 0.955))
    names = [[f"truth {n}" for n in SHOWN], [f"map {n}" for n in SHOWN], ["objects", "objects", "apart"]]
    axes = plot.subplot_mosaic(names, height_ratios=[1, 1, 0.95])
    for index in SHOWN:
        for run, row, title in zip(pairs[index], ("truth", "map"), ("traced", "by map"), strict=True):
            frame = run.frame()
            left, top, right, bottom = images.box_around(frame.mirror)
            crop = (slice(max(top - 30, 0), bottom + 30), slice(max(left - 30, 0), right + 30))
            axis = axes[f"{row} {index}"]
            axis.imshow(images.to_srgb(frame.colour)[crop], interpolation="nearest")
            axis.set_title(f"{title}, index {index}")
            axis.axis("off")
    axes["objects"].plot(INDICES, 100 * same, "o-", color=COLOURS[0])
    axes["objects"].set(ylabel="same object seen through, %", ylim=(0, 100))
    axes["apart"].plot(INDICES, apart, "s-", color=COLOURS[1])
    axes["apart"].axvline(1 / (1 - RADIUS_M / WALL_M), color="#7a8490", ls=":")
    axes["apart"].set(ylabel="points seen are apart, m (median)", ylim=(0, None))
    for name in ("objects", "apart"):
        axes[name].set_xlabel("refractive index")
        axes[name].grid(color=GRID, lw=0.6)
    figure.plot = plot
    figure.table(
        "Environment map against truth, by refractive index",
        ["index", "same object, %", "points apart, m"],
        [[f"{n}", f"{100 * s:.1f}", f"{a:.2f}"] for n, s, a in zip(INDICES, same, apart, strict=True)],
    )
    figure.finding(
        f"At index 1 the map shows the traced object through {100 * same[0]:.0f} % of the ball, at 1.5 through "
        f"{100 * same[INDICES.index(1.5)]:.0f} %, at 2.4 through {100 * same[-1]:.0f} %. Even without bending the map is "
        f"wrong, by {apart[0]:.2f} m in the median; it is least wrong at {INDICES[int(apart.argmin())]}, by "
        f"{apart.min():.2f} m, and off by {apart[-1]:.2f} m at 2.4."
    )


def judged(truth, mapped) -> tuple[float, float]:
    """Share of the glass's pixels through which both show the same object; where they do, the median
    distance in metres between the points of it."""
    glass = truth.frame().mirror & mapped.frame().mirror
    layers = [read_channels(run.exr()) for run in (truth, mapped)]
    ids = [layer["refracted.object"].astype(np.uint32) for layer in layers]
    points = [np.stack([layer[f"refracted.{axis}"] for axis in "XYZ"], axis=-1) for layer in layers]
    same = glass & (ids[0] == ids[1])
    found = same & (ids[0] != NO_OBJECT)
    apart = np.linalg.norm((points[0] - points[1])[found], axis=-1)
    return float(same[glass].mean()), float(np.median(apart))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
