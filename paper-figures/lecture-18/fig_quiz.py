"""Lecture 18, quiz: which of the objects 1 to 4 are seen, directly and in the mirror?

To be seen: A flat mirror, and four columns placed so that ray tracing and environment mapping give
different answers. Colours tell the objects apart; the plan is in scenes/lecture.toml.

Claim: Directly 3 and 4; in the mirror 2, 3 and 4 by ray tracing but 1, 3 and 4 by environment
mapping, which looks the map up as if it had been taken from every point of the mirror.
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main, render
from mirrorfigures.evidence import object_ids, seen_directly, seen_in_mirrors

SIZE = "1280x640"  # twice as wide as high, as the plan's opening of 100 degrees asks
OBJECTS = ("object-1", "object-2", "object-3", "object-4")
LECTURE = {
    "directly": {"object-3", "object-4"},
    "in the mirror, ray traced": {"object-2", "object-3", "object-4"},
    "in the mirror, environment map": {"object-1", "object-3", "object-4"},
}


def draw(figure):
    truth, mapped = (render("lecture", case, size=SIZE) for case in ("truth", "environment-map"))
    figure.cite(truth, mapped)
    # The row of the map names the scene's objects just as the truth's does.
    ids = {name: i for name, i in object_ids(mapped.row).items() if name in OBJECTS}
    frames = {"ray-traced truth": truth.frame(), "environment map": mapped.frame()}
    traced_frame, mapped_frame = frames.values()
    ours = {
        "directly": seen_directly(traced_frame, ids),
        "in the mirror, ray traced": seen_in_mirrors(traced_frame, ids),
        "in the mirror, environment map": seen_in_mirrors(mapped_frame, ids),
    }
    rows = [[where, numbers(LECTURE[where]), numbers(ours[where])] for where in LECTURE]
    figure.table("Objects seen", ["where", "lecture", "ours"], rows)
    figure.number("seen", {where: sorted(names) for where, names in ours.items()})
    agreed = sum(ours[where] == LECTURE[where] for where in LECTURE)
    figure.finding(f"{agreed} of the lecture's {len(LECTURE)} answers come out the same.")
    figure.plot = picture(frames, rows)
    error = images.colour_error(mapped_frame.colour, traced_frame.colour)
    figure.compare(
        "environment map",
        images.to_srgb(traced_frame.colour),
        images.to_srgb(mapped_frame.colour),
        images.heat(error, traced_frame.mirror),
    )


def numbers(names: set[str]) -> str:
    return ", ".join(sorted(name.removeprefix("object-") for name in names)) or "none"


def picture(frames: dict, rows: list[list[str]]) -> plt.Figure:
    plot = plt.figure(figsize=(8.4, 4.0), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.945))
    axes = plot.subplot_mosaic([["left", "right"], ["table", "table"]], height_ratios=[1, 0.5])
    for axis, (title, frame) in zip((axes["left"], axes["right"]), frames.items(), strict=True):
        axis.imshow(images.to_srgb(frame.colour), interpolation="nearest")
        axis.set_title(title)
        axis.axis("off")
    axes["table"].axis("off")
    table = axes["table"].table(
        rows,
        colLabels=["objects seen", "lecture", "ours"],
        colWidths=[0.4, 0.2, 0.2],
        loc="center",
        cellLoc="left",
        colLoc="left",
        edges="horizontal",
    )
    for cell in table.get_celld().values():
        cell.set(edgecolor="#dfe3e8")
    table.scale(1, 1.35)
    return plot


if __name__ == "__main__":
    main(__file__, __doc__, draw)
