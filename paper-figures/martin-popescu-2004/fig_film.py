"""Martin & Popescu 2004, the video: motion parallax in the reflections, as a film.

To be seen: The eye slides by the mirror sphere, a centimetre and a half a frame, from one front column to the other,
while the cubic particle passes. Ray traced, near columns move before far ones and the particle before both. Rays at
eight nodes and at the eye follow; through nodes, what no ray passes by from all eight is missing. In the environment
map all things lie elsewhere and keep their gaps. The contact sheet has six of the film's frames.

Claim: "Environment mapping does not provide motion parallax, in other words, distant and near reflected objects do not
move with respect to each other as the desired view translates" (abstract); "the accompanying video".
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import film, main, render
from mirrorfigures.films import named, panels
from mirrorfigures.variants import changed

# `columns` with a slide in place of the circle, between the two front columns; seconds.
CIRCLE = """eye = [0.0, 1.6, 4.0]
target = [0.0, 1.0, 0.0]
orbit = { period_s = 20.0 }"""
SLIDE = """keys = [
    { time_s = 3.0, eye = [-0.27, 1.3, 2.0], target = [-0.08, 1.0, 0.0] },
    { time_s = 4.5, eye = [0.27, 1.3, 2.0], target = [0.08, 1.0, 0.0] },
]"""
SIZE, FIRST, FRAMES = "320x180", 72, 36
CASES = {
    "ray traced": "truth",
    "eight nodes, published": "reflection-morphing@published",
    "rays at the eye": "reflection-morphing:nodes=eye",
    "environment map": "environment-map",
}
# About the sphere.
BOX = (62, 0, 258, 180)
# A near column and a far one on the same side of the mirror.
NEAR, FAR = "column-2", "column-6"
STILLS = range(0, FRAMES, 7)
ENDS = (FIRST, FIRST + FRAMES - 1)


def draw(figure):
    first, *beside = CASES.values()
    scene = changed("columns", CIRCLE, SLIDE)
    shot = film(scene, [first, *beside], size=SIZE, frames=f"{FIRST}..{FIRST + FRAMES}")
    figure.cite(shot)
    pictures = panels(shot, len(CASES))
    figure.film(", ".join(CASES), [named(row, list(CASES), BOX, 2) for row in pictures], rate_hz=12.0)
    figure.plot = sheet(pictures)
    rows = []
    for name, case in CASES.items():
        runs = [render(scene, case, frame=frame, size=SIZE) for frame in ENDS]
        figure.cite(*runs)
        gaps = [gap(run) for run in runs]
        judged = [run.row["accuracy"] for run in runs]
        wrong = f"{100 * np.mean([one['bad_share']['4'] for one in judged]):.0f} %" if all(judged) else ""
        rows.append([name, *(f"{px:.1f}" for px in gaps), f"{gaps[1] - gaps[0]:+.1f}", wrong])
    header = ["case", "gap, first frame, px", "last", "change", "wrong by 4 px, both frames"]
    figure.table("Of a far column's picture from a near one's, in the mirror", header, rows)
    changes = ", ".join(f"{row[0]} {row[3]} px" for row in rows)
    wrong = ", ".join(f"{row[0]} {row[4]}" for row in rows[1:])
    figure.finding(
        f"From the first frame to the last a far column's picture moves against a near one's by: {changes}. Of the "
        f"mirror's pixels wrong by more than 4 px: {wrong}."
    )


def gap(run) -> float:
    """Pixels from the middle of the far column, as mirrored, to that of the near one, across."""
    frame, names = run.frame(), run.row["scene"]["objects"]
    middles = [np.nonzero(frame.shows(names.index(name)))[1] for name in (FAR, NEAR)]
    return float(np.diff([across.mean() if across.size else np.nan for across in middles])[0])


def sheet(pictures) -> plt.Figure:
    """Cases from top to bottom, time from left to right."""
    plot, axes = plt.subplots(len(CASES), len(STILLS), figsize=(9.6, 6.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.03, 1, 0.97), h_pad=0.01, w_pad=0.01)
    for i, (line, name) in enumerate(zip(axes, CASES, strict=True)):
        for axis, frame in zip(line, STILLS, strict=True):
            axis.imshow(pictures[frame][i].crop(BOX))
            axis.set(xticks=[], yticks=[])
            axis.spines[:].set_visible(False)
        line[0].set_ylabel(name, fontsize=8)
    for axis, frame in zip(axes[0], STILLS, strict=True):
        axis.set_title(f"frame {FIRST + frame}")
    return plot


if __name__ == "__main__":
    main(__file__, __doc__, draw)
