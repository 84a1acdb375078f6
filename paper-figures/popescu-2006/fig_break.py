"""Depth image impostors: where they break (after slides 9 and 34).

To be seen: Bad pixels among those that show the statue, by the truth or the case. Left, the statue turned before
the mirror, its depth image kept as it was taken at 0 degrees: what it shows later was hidden then. Middle, the
gap between statue and mirror. As published; revised with images kept, one of each object and two; and a
searched map of all surroundings, taken anew in every frame. Right, parallax inside an object: a tube 0.5 m wide
that opens towards a mirror ball 0.4 m away, as deep as the axis says; bad at 1 px, as a share of the tube's
pixels. Billboards are beside them there.

Claim: "No support for objects very close to the reflector"; "lack of motion parallax" (slide 34, of billboards).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.evidence import object_ids
from mirrorfigures.variants import head, scene_file, thing

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
DEPTHS = (0.02, 0.1, 0.3, 0.8)
INSIDE = {
    "published": CASES["published"],
    "revised": "depth-impostors@revised:size=256,step_deg=10",
    "z-buffered map, revised": CASES["z-buffered map, revised"],
    "billboard": "billboard-impostors",
    "billboard, revised": "billboard-impostors@revised",
}
BALL = "sphere = { radius = 0.6, slices = 128, stacks = 64 }"
# Metres between two points of the statue that are taken for one.
NEAR = 0.03


def draw(figure):
    plot, axes = plt.subplots(1, 3, figsize=(12.8, 3.8), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    rows = []
    for axis, (places, label) in zip(axes[:2], ((TURNS, "turned, degrees"), (GAPS, "gap, metres (log)")), strict=True):
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
    axes[0].set(ylabel="bad, % of the statue's pixels")
    rows += inside(figure, axes[2])
    for axis in axes:
        axis.set(ylim=(0, None))
        axis.legend(fontsize=7)
    figure.plot = plot
    figure.table("Bad, % of the object's pixels", ["against", "case", "at the values above"], rows)
    turned = {name: said.split(", ")[-1] for label, name, said in rows if label.startswith("turned")}
    near = {name: said.split(", ")[-1] for label, name, said in rows if label.startswith("gap")}
    deep = {name: said.split(", ")[-1] for label, name, said in rows if label.startswith("depth")}
    figure.finding(
        f"Turned by 180 degrees: {listed(turned)}. A centimetre from the mirror: {listed(near)}. "
        f"{DEPTHS[-1]} m deep: {listed(deep)}."
    )


def inside(figure, axis):
    """Draws what is bad of a tube by its depth."""
    rows = []
    scenes = [scene_file("tube", tube(deep)) for deep in DEPTHS]
    truths = [render(scene, "truth", size=SIZE) for scene in scenes]
    figure.cite(*truths)
    for (name, case), colour, marker in zip(INSIDE.items(), COLOURS, MARKERS, strict=False):
        runs = [render(scene, case, size=SIZE) for scene in scenes]
        figure.cite(*runs)
        bad = [100 * strayed(*pair) for pair in zip(runs, truths, strict=True)]
        axis.plot(DEPTHS, bad, marker=marker, color=colour, ms=4, label=name)
        rows.append(["depth, metres", name, ", ".join(f"{b:.1f}" for b in bad)])
    axis.set(xlabel="depth of the tube, metres", ylabel="bad at 1 px, % of the tube's pixels")
    axis.grid(color=GRID, lw=0.6)
    return rows


def tube(deep):
    """Open towards a mirror ball."""
    profile = f"[[0.0, {deep}], [0.25, {deep}], [0.25, 0.0]]"
    shape = f'revolution = {{ profile = {profile}, curve = "polyline", slices = 64 }}'
    return (
        head(34.0, (1.6, 1.1, 2.6), (0.1, 0.8, 0.0), (0.0625, 0.125))
        + thing("ball", BALL, "mirror", (0, 0.8, 0))
        + thing("tube", shape, "paint", (1, 0.8, 0), (0, 0, -90))
    )


def strayed(run, truth):
    """Pixels bad at 1 px over those in which the truth shows the tube; there is nothing else."""
    traced = truth.frame()
    image = traced.shows(object_ids(run.row)["tube"]).sum()
    return run.row["accuracy"]["bad_share"]["1"] * traced.mirror.sum() / max(image, 1)


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
