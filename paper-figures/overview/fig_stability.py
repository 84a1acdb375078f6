"""Stability: how the environment map's points tremble and pop along a path.

To be seen: Frame by frame along a short stretch of the columns' orbit: above, the jitter of the points
followed (line: median, band: up to the 95th percentile); below, the share of points that jump by over
a pixel against their place, and the share from which on a frame counts as a pop.
"""

from mirrorfigures import follow, main
from mirrorfigures.charts import steadiness
from mirrorfigures.text import steadiness_line

SCENE = "columns"
CASES = ["environment-map:size=64", "environment-map:size=256"]


def draw(figure):
    run = follow(SCENE, CASES, size="320x180", frames="0..16")
    figure.cite(run)
    figure.plot = steadiness({row["case"]: run.path(row) for row in run.rows})
    for row in run.rows:
        figure.finding(steadiness_line(row))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
