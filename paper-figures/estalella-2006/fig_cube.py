"""Estalella et al. 2006: the search of the reflector as the eye sees it, beside those of cube maps about it.

To be seen: Above, a mirror sphere before which two quads stand ever nearer: steps of a search, and the
share of wrong pixels, over those that show the quads. Steps along B - N, our guess at the search of 2005, run wild
near the reflector, the shorter the step the nearer; Newton's steps on the same maps arrive everywhere. Below,
the kitchen: what is wrong against the texels read, for textures and cube maps of several sizes; a sample
of a cube map reads four. Left half way to the bowl, right nearest to it.

Claim: "An order of magnitude speedup compared to [EMD*05]"; "flickering is completely avoided while in the
previous case a high number of iterations would be needed"; "the view-dependent nature of the textures used
for the search avoids potential resolution problems when the viewpoint is close to the reflector".
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import bench, follow, main, paths, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.exr import NO_OBJECT

DISTANCES = (1.05, 1.2, 1.5, 2.0, 4.0, 10.0)
GAPS = [round(distance - 1, 2) for distance in DISTANCES]
STEPS = [2, 5, 10, 20, 50]
SMALL = "240x180"
NEAR = {
    "screen: walk, then Newton": "virtual-objects:start=centre,point=newton,image=push",
    "cube: along B - N": "virtual-objects:reflector_map=cube,image=push",
    "cube: a quarter of B - N": "virtual-objects:reflector_map=cube,image=push,step=0.25",
    "cube: Newton": "virtual-objects:reflector_map=cube,image=push,search=newton",
}
SIZE, FRAMES = "320x180", {"half way": 96, "nearest": 192}
RULES = "virtual-objects:subdivide=0.37,image=push"
CUBE = f"{RULES},reflector_map=cube"
KITCHEN = {
    "screen: texels": [RULES],
    "screen: walk, then Newton": [f"{RULES},point=newton{more}" for more in (",texture=160", "")],
    "screen: coarse to fine, Newton": [
        f"{RULES},point=newton,start=pyramid,frustum=fitted{more}" for more in (",texture=80", "")
    ],
    "cube: along B - N": [CUBE, f"{CUBE},step=0.1,most_steps=256"],
    # Searches for hidden vertices, which have no point, go on for as long as they may.
    "cube: Newton": [f"{CUBE},search=newton,most_steps=12,cube_size={size}" for size in (16, 64, 256)],
    "screen, revised": ["virtual-objects@revised:texture=160", "virtual-objects@revised"],
    "cube: Newton, revised": [f"virtual-objects@revised:reflector_map=cube,cube_size={n}" for n in (64, 256)],
}
# Along the path, where the walk goes on from the frame before.
WARM = [KITCHEN["screen: walk, then Newton"][1], KITCHEN["cube: Newton"][2]]
# As much is wrong with either of a pair.
EQUAL = [
    KITCHEN["screen: coarse to fine, Newton"][1],
    KITCHEN["cube: Newton"][2],
    KITCHEN["screen, revised"][1],
    KITCHEN["cube: Newton, revised"][1],
]
PATH = (96, 104)

SCENE = """about = "Two quads before a mirror sphere"

[camera]
fov_deg = 40.0
eye = [-2.35, 0.0, 3.2]
target = [0.0, 0.0, 0.0]

[lighting]
ambient = [0.45, 0.45, 0.45]
sun = [0.6, 0.58, 0.55]
towards_sun = [0.5, 0.7, 0.4]

[environment]
gradient = {{ zenith = [0.18, 0.36, 0.75], horizon = [0.85, 0.9, 0.95], nadir = [0.32, 0.28, 0.24] }}

[materials]
mirror = {{ mirror = {{ reflectance = 1.0 }} }}
quad = {{ checker = {{ even = [0.85, 0.75, 0.2], odd = [0.65, 0.12, 0.1], size = [{square}, {square}] }} }}

[[objects]]
name = "sphere"
shape = {{ sphere = {{ radius = 1.0, edge = 0.02 }} }}
material = "mirror"
"""
QUAD = """
[[objects]]
name = "quad-{azimuth}"
shape = {{ plane = {{ size = [{size}, {size}] }} }}
material = "quad"
rotation_deg = [-90.0, {azimuth}.0, 0.0]
position = [{x}, 0.0, {z}]
"""
# Degrees from +z round the vertical; unit vectors.
PLACES = {35: (0.57358, 0.81915), 70: (0.93969, 0.34202)}


def scene(distance):
    """The sphere and two quads so many radii from its centre, facing it."""
    size = 0.4 * distance
    text = SCENE.format(square=f"{size / 8:.5f}")
    for azimuth, (x, z) in PLACES.items():
        text += QUAD.format(azimuth=azimuth, size=size, x=f"{distance * x:.5f}", z=f"{distance * z:.5f}")
    folder = paths.out() / ".scenes"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"cube-{distance}.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def draw(figure):
    plot, axes = plt.subplots(2, 2, figsize=(9.6, 7.4), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.03, 1, 0.97))
    near = approach(figure, axes[0])
    rows = [kitchen(figure, axis, name, frame) for axis, (name, frame) in zip(axes[1], FRAMES.items())]
    axes[1, 0].legend(fontsize=7)
    figure.plot = plot
    warm = path(figure)
    times(figure)
    best = [min(row, key=lambda p: p["bad"] + 1e-9 * p["reads"]) for row in rows]
    figure.finding(
        "Bad at 1 px over the quads' pixels (above 1: wrong where they are not, too) at "
        + ", ".join(f"{d:g}" for d in DISTANCES)
        + " radii: "
        + "; ".join(f"{name} {', '.join(f'{v:.2g}' for v in wrong)}" for name, (_, wrong) in near.items())
        + ". In the kitchen the least is wrong with "
        + "; ".join(f"{p['case']} ({p['bad']:.2%}, {p['reads']:,.0f} texels, {name})" for name, p in zip(FRAMES, best))
        + ". From frame to frame, steps a search: "
        + "; ".join(f"{case} {steps:.1f}" for case, steps in warm)
        + "."
    )


def approach(figure, axes):
    """Steps and wrong shares of each search at each distance."""
    found = {name: ([], []) for name in NEAR}
    for distance in DISTANCES:
        size = f"subdivide={0.4 * distance / 12:.4f}"
        truth, *runs = [
            render(scene(distance), case, size=SMALL)
            for case in ("truth", *(f"{case},{size}" for case in NEAR.values()))
        ]
        figure.cite(*runs)
        frame = truth.frame()
        quads = np.mean(frame.object[frame.mirror] != NO_OBJECT)
        for (steps, wrong), run in zip(found.values(), runs, strict=True):
            steps.append(run.row["counters"]["steps"] / run.row["counters"]["searches"])
            wrong.append(run.row["accuracy"]["bad_share"]["1"] / quads)
    for (name, values), colour, marker in zip(found.items(), COLOURS, MARKERS, strict=False):
        for axis, value in zip(axes, values, strict=True):
            axis.plot(GAPS, value, color=colour, marker=marker, ms=5, label=name)
    for axis, label in zip(axes, ("steps a search (log)", "bad at 1 px over the quads' pixels"), strict=True):
        axis.set(xscale="log", xlabel="gap between quads and mirror over its radius (log)", ylabel=label)
        axis.set_xticks(GAPS, [f"{gap:g}" for gap in GAPS])
        axis.minorticks_off()
        axis.grid(color=GRID, lw=0.6)
    axes[0].set_yscale("log")
    axes[0].set_yticks(STEPS, STEPS)
    axes[0].minorticks_off()
    axes[0].legend(fontsize=7)
    header = ["search", *(f"{d:g}" for d in DISTANCES)]
    kinds = {"Steps a search": (0, "{:.1f}"), "Bad at 1 px over the quads' pixels": (1, "{:.1%}")}
    for title, (which, form) in kinds.items():
        table = [[name, *(form.format(v) for v in values[which])] for name, values in found.items()]
        figure.table(title, header, table)
    return found


def kitchen(figure, axis, name, frame):
    """Work and what is wrong in one frame; a point for each case."""
    cases = [case for group in KITCHEN.values() for case in group]
    runs = [render("kitchen-table1", case, frame=frame, size=SIZE) for case in cases]
    figure.cite(*runs)
    points = [point(case, run.row) for case, run in zip(cases, runs, strict=True)]
    for (group, members), colour, marker in zip(KITCHEN.items(), COLOURS * 2, MARKERS * 2, strict=False):
        own = [p for p, case in zip(points, cases, strict=True) if case in members]
        reads, bad = [p["reads"] for p in own], [100 * p["bad"] for p in own]
        axis.plot(reads, bad, color=colour, marker=marker, ms=5, lw=0.8, label=group)
    axis.set(xscale="log", yscale="log", xlabel="texels read, points and normals (log)")
    axis.set(ylabel="bad at 1 px, % (log)", title=f"Kitchen, {name} (frame {frame})")
    axis.set_xticks([3e5, 1e6, 3e6], ["300,000", "1,000,000", "3,000,000"])
    axis.set_yticks([1, 3, 10, 30, 100], [1, 3, 10, 30, 100])
    axis.minorticks_off()
    axis.grid(color=GRID, lw=0.6)
    header = ["case", "bad at 1 px", "steps", "samples", "texels read"]
    table = [
        [p["case"], f"{p['bad']:.2%}", *(f"{p[k]:,.0f}" for k in ("steps", "samples", "reads"))] for p in points
    ]
    figure.table(f"Kitchen, {name}, a frame by itself", header, table)
    return points


def point(case, row):
    counters = row["counters"]
    samples = counters["evaluations"]
    # Between texels a sample reads four; the walk reads one, Newton's few steps after it not told apart.
    reads = samples * (4 if "reflector_map=cube" in case else 1)
    bad = row["accuracy"]["bad_share"]["1"]
    return {"case": case, "bad": bad, "steps": counters["steps"], "samples": samples, "reads": reads}


def times(figure):
    """What searches, and what they search in, takes half way; the maps of the cube are made once."""
    frame = FRAMES["half way"]
    run = bench("kitchen-table1", EQUAL, size=SIZE, frames=f"{frame}..{frame + 1}", repeat=3)
    figure.cite(run)
    steps = ("gbuffer", "start", "cells", "search", "clear", "split")
    table = []
    for case, row in zip(EQUAL, run.rows, strict=True):
        ms = {entry["name"]: entry["gpu_ms"]["median"] for entry in row["passes"] if not entry["prepare"]}
        parts = [ms.get(f"virtual-objects/{step}", 0.0) for step in steps]
        table.append([case, *(f"{part:.2f}" for part in parts), f"{sum(parts):.1f}"])
    figure.table("Kitchen, half way: GPU ms of the passes, in software", ["case", *steps, "sum"], table)


def path(figure):
    """Steps a search along the path, its first frame left out."""
    run = follow("kitchen-table1", WARM, size=SIZE, frames="{}..{}".format(*PATH))
    figure.cite(run)
    mean = lambda counters: sum(c["steps"] for c in counters) / sum(c["searches"] for c in counters)  # noqa: E731
    warm = [(case, mean(run.path_counters(row)[1:])) for case, row in zip(WARM, run.rows, strict=True)]
    figure.table("Steps a search from frame to frame", ["case", "steps"], [[c, f"{s:.2f}"] for c, s in warm])
    return warm


if __name__ == "__main__":
    main(__file__, __doc__, draw)
