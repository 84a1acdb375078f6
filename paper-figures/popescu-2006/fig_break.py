"""Depth image impostors: where they break (after slides 9 and 34).

To be seen: Bad pixels among those that show the statue, by the truth or the case. Left, the statue turned before
the mirror, its depth image kept as it was taken at 0 degrees: what it shows later was hidden then. Right, the
gap between statue and mirror. As published; revised with images kept, one of each object and two; and a
searched map of all surroundings, taken anew in every frame.

Claim: "No support for objects very close to the reflector"; "lack of motion parallax" (slide 34, of billboards).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.evidence import object_ids

SIZE = "192x144"
KEPT = "depth-impostors@revised:size=256,step_deg=10,view=start"
CASES = {
    "published": "depth-impostors:size=256",
    "revised, one image": f"{KEPT},views=1",
    "revised, two": f"{KEPT},views=2",
    "z-buffered map, revised": "z-buffered-map@revised:size=256",
}
# Degrees and metres, by frame.
TURNS = {0: 0, 144: 60, 288: 120, 432: 180}
GAPS = {480: 2.0, 600: 1.0, 660: 0.5, 720: 0.01}
# Metres between two points of the statue that are taken for one.
NEAR = 0.03


def draw(figure):
    plot, axes = plt.subplots(1, 2, figsize=(9.0, 3.8), sharey=True, layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    rows = []
    for axis, (places, label) in zip(axes, ((TURNS, "turned, degrees"), (GAPS, "gap, metres (log)")), strict=True):
        truths = [render("statue", "truth", frame=frame, size=SIZE) for frame in places]
        figure.cite(*truths)
        for (name, case), colour, marker in zip(CASES.items(), COLOURS, MARKERS, strict=False):
            runs = [render("statue", case, frame=frame, size=SIZE) for frame in places]
            figure.cite(*runs)
            bad = [100 * lost(*pair) for pair in zip(runs, truths, strict=True)]
            axis.plot(list(places.values()), bad, marker=marker, color=colour, ms=4, label=name)
            rows.append([label, name, ", ".join(f"{b:.0f}" for b in bad)])
        axis.set(xlabel=label)
        axis.grid(color=GRID, lw=0.6)
    axes[1].set(xscale="log")
    axes[0].set(ylabel="bad, % of the statue's pixels", ylim=(0, None))
    axes[0].legend(fontsize=7.5)
    figure.plot = plot
    figure.table("Bad, % of the statue's pixels", ["against", "case", "at the values above"], rows)
    turned = {name: said.split(", ")[-1] for label, name, said in rows if label.startswith("turned")}
    near = {name: said.split(", ")[-1] for label, name, said in rows if label.startswith("gap")}
    figure.finding(
        "Turned by 180 degrees: " + listed(turned) + ". A centimetre from the mirror: " + listed(near) + "."
    )


def listed(numbers):
    return ", ".join(f"{name} {number} %" for name, number in numbers.items())


def lost(run, truth):
    """Share of the pixels in which either shows the statue and they do not show the same of it."""
    statue = object_ids(run.row)["statue.default"]
    ours, traced = run.frame(), truth.frame()
    either = ours.shows(statue) | traced.shows(statue)
    both = ours.shows(statue) & traced.shows(statue)
    same = both & (np.linalg.norm(ours.point - traced.point, axis=-1) < NEAR)
    return 1 - same.sum() / max(either.sum(), 1)


if __name__ == "__main__":
    main(__file__, __doc__, draw)
