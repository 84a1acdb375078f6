"""Screen space: how much of a mirror the screen can answer.

To be seen: A bar a view. What the screen answers, rightly (to 1 px) or not; where it has no answer,
whether the environment shown instead is right or wrong, which is what tracing mends. Expected:
flat mirrors that face what the eye faces find most of it on the screen; convex ones in front of the
eye send most rays past it, the nearer the eye the more, and the fallback has to do the work.
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, main
from mirrorfigures.charts import COLOURS

SIZE = "480x270"
CASE = "screen-space"
# Scene and frame; the last one of `columns-dolly` is seen from 0.3 m.
VIEWS = [
    ("columns", 0),
    ("columns-dolly", 192),
    ("two-spheres", 0),
    ("patow-room", 0),
    ("clutter-150", 0),
    ("sticks", 0),
    ("stress-pole", 0),
    ("stress-gap", 60),
    ("teapot", 0),
    ("kitchen", 0),
    ("hall-of-mirrors", 0),
    ("lecture", 0),
]
PARTS = [
    ("from the screen, right", COLOURS[2]),
    ("from the screen, wrong", COLOURS[1]),
    ("not on the screen: environment, right", COLOURS[5]),
    ("not on the screen: environment, wrong", "#c5cbd3"),
]


def draw(figure):
    names, parts, table = [], [], []
    for scene, frame in VIEWS:
        frames = f"{frame}..{frame + 1}"
        alone, traced = (
            bench(scene, [CASE], size=SIZE, frames=frames, repeat=1, fallback=fallback)
            for fallback in ("none", "ray")
        )
        figure.cite(alone, traced)
        row = alone.row
        names.append(f"{scene}, frame {frame}")
        parts.append(shares(row, bad(traced.row)))
        visits = row["counters"]["visits"] / row["reflector_pixels"]
        numbers = [f"{100 * part:.1f} %" for part in parts[-1]]
        table.append([names[-1], *numbers, f"{visits:.0f}", f"{100 * bad(row):.1f} %"])
    plot, axis = plt.subplots(figsize=(8.2, 4.6), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.12, 1, 0.88))
    left = [0.0] * len(names)
    for i, (label, colour) in enumerate(PARTS):
        width = [100 * part[i] for part in parts]
        axis.barh(names, width, left=left, color=colour, label=label, height=0.72)
        left = [a + b for a, b in zip(left, width, strict=True)]
    axis.set(xlim=(0, 100), xlabel="% of mirror pixels")
    axis.invert_yaxis()
    plot.legend(loc="lower center", ncols=2, bbox_to_anchor=(0.5, 0.03))
    figure.plot = plot
    header = ["view", *(label for label, _ in PARTS), "cells visited a ray", "bad at 1 px"]
    figure.table(f"Where the answers come from, {SIZE}", header, table)


def bad(row):
    return row["accuracy"]["bad_share"]["1"]


def shares(row, wrong):
    """A row's pixels as PARTS has them; `wrong` is what stays bad with all the others traced."""
    hits = row["counters"]["hits"] / row["reflector_pixels"]
    mended = bad(row) - wrong
    return [hits - wrong, wrong, 1.0 - hits - mended, mended]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
