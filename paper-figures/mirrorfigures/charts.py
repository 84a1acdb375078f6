"""Charts of rows: speed against accuracy; steadiness along a path."""

import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

from .figure import QUIET

# Okabe & Ito's palette: told apart by the colour-blind too.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
MARKERS = "osD^vPX"
GRID = "#e7eaee"
PANELS_ACROSS = 3

POP_SHARE = 0.005
"""A frame in which more of the points jump is a pop: the binary's threshold."""


def speed_against_accuracy(rows_by_scene: dict[str, list[dict]], floor: str = "none") -> plt.Figure:
    """One panel a scene: GPU ms of a frame (log) against the share of mirror pixels that are bad.

    The method `floor` draws the frame without reflections: a line, not a point.
    """
    drawn = [r for rows in rows_by_scene.values() for r in rows if r["method"] != floor]
    cases = dict.fromkeys(row["case"] for row in drawn)
    style = {case: (COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]) for i, case in enumerate(cases)}
    across = min(len(rows_by_scene), PANELS_ACROSS)
    down = -(-len(rows_by_scene) // across)
    # The legend has three columns, and an entry more for the line of the floor.
    below = 0.25 + 0.23 * -(-(len(style) + 1) // 3)
    inches = (2.9 * across + 0.6, 2.9 * down + below)
    plot, axes = plt.subplots(
        down, across, figsize=inches, sharey=True, squeeze=False, layout="constrained"
    )
    legend = below / inches[1]
    plot.get_layout_engine().set(rect=(0, legend, 1, 1 - legend))
    for axis in axes.flat[len(rows_by_scene) :]:
        axis.remove()
    for axis, (scene, rows) in zip(axes.flat, rows_by_scene.items(), strict=False):
        for row in rows:
            if row["method"] == floor:
                axis.axvline(row["frame_gpu_ms"]["median"], color=QUIET, lw=1, ls=":")
            else:
                _point(axis, row, *style[row["case"]])
        size = "x".join(str(n) for n in rows[0]["size"])
        axis.set(title=f"{scene}, {size}", xscale="log", ylim=(-4, 104), xlabel="frame, GPU ms (log)")
        axis.grid(True, which="both", color=GRID, lw=0.6)
        axis.margins(x=0.4)
        axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.xaxis.set_major_formatter("{x:g}")
        axis.xaxis.set_minor_formatter(NullFormatter())
    for axis in axes[:, 0]:
        axis.set_ylabel("bad at 1 px, % of mirror pixels\n(lower is better)")
    handles = [
        plt.Line2D([], [], color=c, marker=m, ls="", label=case) for case, (c, m) in style.items()
    ]
    handles.append(plt.Line2D([], [], color=QUIET, ls=":", label="frame without reflections"))
    plot.legend(handles=handles, loc="lower center", ncols=3, bbox_to_anchor=(0.5, 0.15 / inches[1]))
    return plot


def steadiness(paths_by_case: dict[str, list[dict]]) -> plt.Figure:
    """Jitter and popping share over the frames of a path, a colour a case."""
    plot, (jitter, popping) = plt.subplots(
        2, 1, figsize=(6.4, 4.4), sharex=True, layout="constrained", height_ratios=(2, 1)
    )
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    for (case, frames), colour in zip(paths_by_case.items(), COLOURS, strict=False):
        steady = [frame for frame in frames if frame["jitter_px"]]
        numbers = [frame["frame"] for frame in steady]
        median, p95 = ([frame["jitter_px"][key] for frame in steady] for key in ("median", "p95"))
        jitter.plot(numbers, median, "o-", color=colour, ms=3, label=case)
        jitter.fill_between(numbers, median, p95, color=colour, alpha=0.15, lw=0)
        popping.plot(
            [frame["frame"] for frame in frames[1:]],
            [100 * frame["popping"] for frame in frames[1:]],
            "o-",
            color=colour,
            ms=3,
        )
    popping.axhline(100 * POP_SHARE, color=QUIET, lw=1, ls=":")
    jitter.set(ylabel="jitter, px\n(median to p95)", ylim=(0, None))
    popping.set(ylabel="points that\njump, %", xlabel="frame", ylim=(0, None))
    popping.xaxis.get_major_locator().set_params(integer=True)
    for axis in (jitter, popping):
        axis.grid(color=GRID, lw=0.6)
    jitter.legend(fontsize=8)
    return plot


def _point(axis: plt.Axes, row: dict, colour: str, marker: str) -> None:
    time = row["frame_gpu_ms"]
    low, high = time["ci95"]
    spread = [[max(time["median"] - low, 0)], [max(high - time["median"], 0)]]
    bad = 100 * row["accuracy"]["bad_share"]["1"]
    axis.errorbar(time["median"], bad, xerr=spread, fmt=marker, color=colour, ms=7, capsize=3)
