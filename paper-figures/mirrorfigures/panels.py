"""Picture figures: the truth beside a method, the error between them, close-ups and numbers."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

from . import images
from .figure import Figure
from .runs import Run, render
from .text import accuracy_lines, verdict

FRAME_COLOURS = ("#e8590c", "#0b7285")
"""Of the close-ups; they stand out on light and dark alike."""

COLUMN_IN = 3.5


def comparison(figure: Figure, truth: Run, label: str, method: Run) -> None:
    """Columns: truth, method, colour error over the mirror. Below each, the same two close-ups: the
    squares, a fifth of the mirror wide, where the method errs most.
    """
    figure.cite(truth, method)
    traced, ours = truth.frame(), method.frame()
    error = images.colour_error(ours.colour, traced.colour)
    pictures = (
        images.to_srgb(traced.colour),
        images.to_srgb(ours.colour),
        images.heat(error, traced.mirror),
    )
    titles = ("ray-traced truth", label, "colour error over the mirror")
    boxes = _close_ups(error, traced.mirror)
    height, width = error.shape
    plot, axes = plt.subplots(
        2,
        3,
        figsize=(3 * COLUMN_IN, COLUMN_IN * (height / width + 0.5) + 1.3),
        gridspec_kw={"height_ratios": [height / width, 0.5]},
        layout="constrained",
    )
    plot.get_layout_engine().set(rect=(0, 0.045, 1, 0.945), h_pad=0.02, w_pad=0.03)
    for (above, below), title, picture in zip(axes.T, titles, pictures, strict=True):
        _picture(above, picture, title, boxes)
        _zooms(below, picture, boxes)
    axes[1, 1].text(
        0.5, -0.06, accuracy_lines(method.row), transform=axes[1, 1].transAxes, ha="center", va="top"
    )
    _colour_bar(plot, axes[1, 2])
    figure.compare(label, *pictures)
    figure.plot = plot


def contest(figure: Figure, truth: Run, left: tuple[str, Run], right: tuple[str, Run]) -> None:
    """Columns: a method, the truth, another method. Below each, the same two close-ups: the squares, a
    fifth of the mirror wide, where the two methods together err most.
    """
    labels, methods = zip(left, right, strict=True)
    figure.cite(methods[0], truth, methods[1])
    traced, drawn = truth.frame(), [method.frame() for method in methods]
    errors = [images.colour_error(frame.colour, traced.colour) for frame in drawn]
    pictures = [images.to_srgb(frame.colour) for frame in (drawn[0], traced, drawn[1])]
    boxes = _close_ups(sum(errors), traced.mirror)
    height, width = errors[0].shape
    plot, axes = plt.subplots(
        2,
        3,
        figsize=(3 * COLUMN_IN, COLUMN_IN * (height / width + 0.5) + 1.3),
        gridspec_kw={"height_ratios": [height / width, 0.5]},
        layout="constrained",
    )
    plot.get_layout_engine().set(rect=(0, 0.045, 1, 0.945), h_pad=0.02, w_pad=0.03)
    titles = (labels[0], "ray-traced truth", labels[1])
    for (above, below), title, picture in zip(axes.T, titles, pictures, strict=True):
        _picture(above, picture, title, boxes)
        _zooms(below, picture, boxes)
    for axis, method in zip((axes[1, 0], axes[1, 2]), methods, strict=True):
        numbers = accuracy_lines(method.row)
        axis.text(0.5, -0.06, numbers, transform=axis.transAxes, ha="center", va="top")
    for label, ours, error in zip(labels, (pictures[0], pictures[2]), errors, strict=True):
        figure.compare(label, pictures[1], ours, images.heat(error, traced.mirror))
    figure.plot = plot


def revision(figure: Figure, scene: str, published: str, revised: str, *, frame: int, size: str) -> None:
    """A contest of two variants of a method on a frame of a scene, and how far each errs."""
    truth, first, second = (
        render(scene, case, frame=frame, size=size) for case in ("truth", published, revised)
    )
    contest(figure, truth, ("as published", first), ("revised", second))
    figure.finding(f"Published: {verdict(first.row)} Revised: {verdict(second.row)}")


def single(figure: Figure, run: Run, label: str) -> None:
    """One picture, for a figure that has nothing to be compared with."""
    figure.cite(run)
    picture = images.to_srgb(run.frame().colour)
    height, width, _ = picture.shape
    plot, axis = plt.subplots(figsize=(5.2, 5.2 * height / width + 0.5), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.945))
    _picture(axis, picture, label, [])
    figure.plot = plot


def strip(figure: Figure, scene: str, cases: dict[str, str], frames: tuple[int, ...], *, size: str) -> None:
    """Frames of a path side by side: the cases above, by name, the truth below; how far each errs in each."""
    plot, axes = plt.subplots(len(cases) + 1, len(frames), layout="constrained", squeeze=False)
    rows = []
    for column, frame in zip(axes.T, frames, strict=True):
        truth = render(scene, "truth", frame=frame, size=size)
        figure.cite(truth)
        traced = truth.frame()
        column[0].set_title(f"frame {frame}")
        _show(column[-1], images.to_srgb(traced.colour))
        for axis, (name, case) in zip(column, cases.items(), strict=False):
            ours = render(scene, case, frame=frame, size=size)
            figure.cite(ours)
            drawn = ours.frame()
            error = images.colour_error(drawn.colour, traced.colour)
            pictures = images.to_srgb(traced.colour), images.to_srgb(drawn.colour)
            _show(axis, pictures[1])
            figure.compare(f"{name}, frame {frame}", *pictures, images.heat(error, traced.mirror))
            said = accuracy_lines(ours.row).replace("\n", "; ").split(": ", 1)[1]
            rows.append([name, str(frame), said])
    for axis, name in zip(axes[:, 0], [*cases, "ray traced"], strict=True):
        axis.set_ylabel(name)
    height, width, _ = traced.colour.shape
    column = max(3.0, 8.4 / len(frames))
    plot.set_size_inches(column * len(frames), len(axes) * column * height / width + 0.6)
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95), h_pad=0.02, w_pad=0.03)
    figure.table("Error", ["case", "frame", "bad at 1 px"], rows)
    said = (f"{name}, frame {frame}: bad at 1 px {bad}" for name, frame, bad in rows)
    figure.finding("; ".join(said).capitalize() + ".")
    figure.plot = plot


def contact_sheet(rows: list[list], names: list[str], places: list[str], box: tuple) -> plt.Figure:
    """Pictures of a film: a row a case, a column a frame, each the part inside `box`."""
    width, height = box[2] - box[0], box[3] - box[1]
    column = 9.6 / len(places)
    plot, axes = plt.subplots(
        len(names),
        len(places),
        figsize=(9.6, column * height / width * len(names) + 0.8),
        layout="constrained",
        squeeze=False,
    )
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95), h_pad=0.02, w_pad=0.03)
    for line, name, pictures in zip(axes, names, zip(*rows, strict=True), strict=True):
        for axis, picture, place in zip(line, pictures, places, strict=True):
            _picture(axis, np.asarray(picture.crop(box)), place if name == names[0] else "", [])
        line[0].set_ylabel(name)
    return plot


def _close_ups(error: np.ndarray, mask: np.ndarray) -> list[tuple]:
    left, top, right, bottom = images.box_around(mask)
    side = max(8, min(right - left, bottom - top) // 5)
    return images.worst_boxes(error, mask, side, len(FRAME_COLOURS))


def _show(axis: plt.Axes, picture: np.ndarray) -> None:
    axis.imshow(picture, interpolation="nearest")
    axis.set(xticks=[], yticks=[])
    axis.spines[:].set_visible(False)


def _picture(axis: plt.Axes, picture: np.ndarray, title: str, boxes: list[tuple]) -> None:
    _show(axis, picture)
    axis.set_title(title)
    for (left, top, right, bottom), colour in zip(boxes, FRAME_COLOURS, strict=False):
        axis.add_patch(
            Rectangle((left, top), right - left, bottom - top, fill=False, ec=colour, lw=1.3)
        )


def _zooms(axis: plt.Axes, picture: np.ndarray, boxes: list[tuple]) -> None:
    axis.axis("off")
    for i, ((left, top, right, bottom), colour) in enumerate(zip(boxes, FRAME_COLOURS, strict=True)):
        inset = axis.inset_axes([i * 0.5 + 0.005, 0.0, 0.49, 1.0])
        _show(inset, picture[top:bottom, left:right])
        inset.spines[:].set(visible=True, color=colour, linewidth=2)


def _colour_bar(plot: plt.Figure, axis: plt.Axes) -> None:
    scale = plt.cm.ScalarMappable(plt.Normalize(0, images.ERROR_FULL_SCALE), "magma")
    place = axis.inset_axes([0.1, -0.11, 0.8, 0.05])
    bar = plot.colorbar(scale, cax=place, orientation="horizontal")
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=7, length=2, pad=1)
    bar.set_label("mean absolute difference as displayed; grey: no mirror", fontsize=7, labelpad=1)
