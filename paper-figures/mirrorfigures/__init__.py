"""Draws the papers' figures from what the mirrorbench binary renders and measures.

A figure script asks `runs` for renders and rows (each run is made once and kept), reads frames with
`exr`, lays them out with `panels`, `charts` or `tables`, and hands the result to `Figure`, which
writes `paper-figures/out/<paper>/<figure>.{png,pdf,json}`. `page` makes the index of them all.
"""

from .exr import Frame, read_frame
from .figure import Figure, main
from .runs import Run, bench, film, follow, render

__all__ = ["Figure", "Frame", "Run", "bench", "film", "follow", "main", "read_frame", "render"]
