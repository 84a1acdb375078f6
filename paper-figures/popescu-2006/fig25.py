"""Popescu et al. 2006, slides 25, 26 and 28: how ray morphing closes the border of a billboard, from a run.

To be seen: From the side. A mirror ball over a floor whose near part is a billboard (thick) and whose rest the
environment map shows; the eye is to the right, and all rays drawn lie in the plane. Above, without morphing: a ray
that misses the billboard is looked up by its direction alone, as if it left the map's centre (dashed), so that the
floor goes on elsewhere. Below, with it: in a margin of the billboard's plane the direction looked up turns from that
of the plane's point, seen from the centre, to the ray's own. Right, the place shown by each pixel over the one that
belongs there: a leap at the border, or a way round it.

Claim: slides 25, 26 and 28 draw the morph; the transition becomes "continuous" (27).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.billboards import METHOD
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.evidence import object_ids
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.plans import circle
from mirrorfigures.variants import head, scene_file, thing

SIZE, MARGIN = "65x361", 0.3
CENTRE, RADIUS, NEAR, FAR = np.array([0.0, 0.9]), 0.8, 1.7, 5.0
# Of the pixels past the border, whose rays are drawn: every so many.
EVERY = 9


def draw(figure):
    scene = scene_file("border", text())
    cases = {"truth": "truth", "cut": f"{METHOD}:morph=0,filter=bilinear"}
    cases["morphed"] = f"{METHOD}:morph={MARGIN},filter=bilinear"
    runs = {name: render(scene, case, size=SIZE) for name, case in cases.items()}
    figure.cite(*runs.values())
    floor = [object_ids(runs["cut"].row)[name] for name in ("near", "far")]
    columns = {name: Column(run, floor) for name, run in runs.items()}
    truth = columns["truth"]
    drawn = np.flatnonzero(truth.floor & (truth.points[:, 0] > NEAR - 0.7))[::EVERY]
    plot, axes = plt.subplot_mosaic(
        [["cut", "places"], ["morphed", "places"]], figsize=(10.5, 4.8), layout="constrained", width_ratios=(1.3, 1)
    )
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.94))
    for name, title in (("cut", "no morphing (24)"), ("morphed", "ray morphing (25, 26, 28)")):
        lookups(axes[name], columns[name], truth, drawn)
        axes[name].set_title(title, fontsize=10)
    right = axes["places"]
    leap = {name: places(right, name, columns[name], truth) for name in ("cut", "morphed")}
    right.plot([0.7, 4.2], [0.7, 4.2], color=QUIET, lw=0.8, ls="--", label="the truth")
    right.axvline(NEAR, color=INK, lw=0.8)
    right.annotate("border", (NEAR, 0.75), xytext=(4, 0), textcoords="offset points", fontsize=8)
    right.set(xlabel="place that belongs there, m", ylabel="place shown, m", xlim=(0.7, 4.2), ylim=(0.7, 5.0))
    right.grid(color=GRID, lw=0.6)
    right.legend(fontsize=8, loc="upper left", bbox_to_anchor=(0.3, 1.0))
    figure.plot = plot
    for name, (largest, own) in leap.items():
        figure.number(f"widest step between two pixels beside the border, {name}, m", largest)
        figure.number(f"the truth's there, {name}, m", own)
    figure.finding(
        f"Beside the border the place shown leaps by {leap['cut'][0]:.2f} m where the truth steps "
        f"{leap['cut'][1]:.2f} m; with morphing by {leap['morphed'][0]:.2f} m at most."
    )


def text():
    """The ball over a floor of two parts."""
    ball = f"sphere = {{ radius = {RADIUS}, slices = 192, stacks = 96 }}"
    floor = "plane = {{ size = [{}, 3.4] }}"
    return (
        head(26.0, (4.0, 2.2, 0.0), (0.3, 0.8, 0.0), (0.25, 0.25))
        + thing("ball", ball, "mirror", (*CENTRE, 0))
        + thing("near", floor.format(2 * NEAR), "paint", (0, 0, 0))
        + thing(
            "far", floor.format(FAR - NEAR), "paint", ((NEAR + FAR) / 2, 0, 0), more='impostor = "backdrop"\n'
        )
    )


class Column:
    """The middle column of a run's frame: points as x and y."""

    def __init__(self, run, floor):
        frame = run.frame()
        middle = frame.mirror.shape[1] // 2
        self.at = frame.position[:, middle, :2]
        self.points = frame.point[:, middle, :2]
        self.floor = (frame.mirror & np.isin(frame.object, floor))[:, middle]


def lookups(axis, column, truth, drawn):
    """The rays of some pixels to where they meet the floor, and where the map was looked up instead."""
    for pixel in drawn:
        start, belongs, shown = column.at[pixel], truth.points[pixel], column.points[pixel]
        mapped = belongs[0] > NEAR
        axis.plot(*np.stack([start, belongs]).T, color=COLOURS[0], lw=1.0)
        if mapped and column.floor[pixel]:
            axis.plot(*np.stack([CENTRE, shown]).T, "--", color=COLOURS[1], lw=0.9)
        if column.floor[pixel]:
            axis.plot(*shown, "o", color=COLOURS[1] if mapped else COLOURS[0], ms=4)
    circle(axis, RADIUS, CENTRE, color=INK)
    axis.plot(*CENTRE, "+", color=INK, ms=6)
    axis.plot([-0.8, NEAR], [0, 0], color=INK, lw=3)
    axis.plot([NEAR, FAR], [0, 0], color=INK, lw=0.8)
    axis.set(aspect="equal", xlim=(-0.9, FAR), ylim=(-0.15, 1.8), xlabel="metres")


def places(axis, name, column, truth):
    """Draws x shown over x that belongs there; the widest step around the border, and the truth's beside it."""
    both = np.flatnonzero(column.floor & truth.floor)
    shown, belongs = column.points[both, 0], truth.points[both, 0]
    colour = COLOURS[1] if name == "cut" else COLOURS[2]
    label = "no morphing" if name == "cut" else "ray morphing"
    axis.plot(belongs, shown, ".-", color=colour, ms=3, lw=0.8, label=label)
    beside = np.abs(belongs[:-1] - NEAR) < 0.25
    step = np.where(beside & (np.diff(both) == 1), np.abs(np.diff(shown)), 0)
    widest = int(step.argmax())
    return float(step[widest]), float(np.abs(np.diff(belongs))[widest])


if __name__ == "__main__":
    main(__file__, __doc__, draw)
