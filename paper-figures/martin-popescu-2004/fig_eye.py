"""Reflection morphing without its preprocess: rays made at the eye in every frame, error and time by method.

To be seen: Above, the mirror sphere while it, the columns and the particle all move: rays made at the eye put
everything where the truth has it. Below, what is wrong against what a frame takes. Nodes on a grid have eight octrees
built anew in each frame, as the mirror moves; hollow marks leave out what is so prepared. The passes all methods
share are left out: what the eye sees directly, and the composite. Rays at the eye are told by the vertices they are
asked for: the finer the meshes are cut beforehand, the less is wrong. Virtual objects, revised, cut them where it shows.

Claim: "If the reflectors move, the ray octrees need be recomputed" (section 3); "it might also be extended to allow
moving reflectors" (section 9); "Preprocessing takes about 3 minutes per sampling location" (section 8).
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, images, main, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS

SCENE, FRAME, FRAMES = "columns-moving", 30, "30..32"
SIZE, TIMED = "640x360", "320x180"
EYE = "reflection-morphing:nodes=eye"
CASES = {
    "ray-traced": ["ray-traced"],
    "virtual-objects@published": ["virtual-objects"],
    "virtual-objects@revised": ["virtual-objects@revised"],
    "rays at the eye": [f"{EYE},map={size},subdivide=0.1" for size in (64, 256)],
    "rays at the eye, edges of 0.25 m": [EYE],
    "rays at a grid's nodes": ["reflection-morphing:files=none"],
}
SHARED = ("direct-view/", "footprint/", "record/", "composite")
BUILD = ("gbuffer", "rays", "clear", "count", "sum", "fill")


def draw(figure):
    plot = plt.figure(figsize=(10, 8), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.03, 1, 0.96))
    above, below = plot.subfigures(2, 1, height_ratios=[1, 1.5])
    pictures(figure, above.subplots(1, 3))
    cases = [case for group in CASES.values() for case in group]
    run = bench(SCENE, cases, size=TIMED, frames=FRAMES, repeat=1)
    figure.cite(run)
    rows = dict(zip(cases, run.rows, strict=True))
    chart(below.subplots(), rows)
    figure.plot = plot
    header = ["case", "bad at 1 px", "p95, px", "own passes, ms", "of these, rays and lists", "prepare, ms"]
    figure.table("Error and time a frame (GPU and CPU milliseconds)", header, [cells(*it) for it in rows.items()])
    said = rows[f"{EYE},map=256,subdivide=0.1"]
    figure.finding(
        f"Rays at the eye, 256 x 256: bad at 1 px {bad(said):.2f} %, rays and lists in {build(said):.0f} ms, all own "
        f"passes in {own(said):.0f} ms"
        + (" (software)." if said["device"]["is_software"] else ".")
        + f" Ray tracing: {own(rows['ray-traced']):.0f} ms; virtual objects, revised: "
        f"{own(rows['virtual-objects@revised']):.0f} ms, bad {bad(rows['virtual-objects@revised']):.2f} %; a grid's nodes: "
        f"{prepare(rows['reflection-morphing:files=none']):.0f} ms of octrees a frame, bad "
        f"{bad(rows['reflection-morphing:files=none']):.1f} %."
    )


def pictures(figure, axes):
    shown = {"truth": "truth", "rays at the eye": f"{EYE},subdivide=0.1", "environment map": "environment-map"}
    for axis, (name, case) in zip(axes, shown.items(), strict=True):
        run = render(SCENE, case, frame=FRAME, size=SIZE)
        figure.cite(run)
        axis.imshow(images.to_srgb(run.frame().colour), interpolation="nearest")
        axis.set(xticks=[], yticks=[], title=name, xlim=(150, 490))
        axis.spines[:].set_visible(False)


def chart(axis, rows):
    for i, (name, cases) in enumerate(CASES.items()):
        colour, marker = COLOURS[i % len(COLOURS)], MARKERS[i]
        # What is exact has a place below all others.
        wrong = [max(bad(rows[case]), 0.01) for case in cases]
        times = [own(rows[case]) + prepare(rows[case]) for case in cases]
        axis.plot(times, wrong, color=colour, marker=marker, label=name)
        if max(prepare(rows[case]) for case in cases) > 1:
            bare = [own(rows[case]) for case in cases]
            axis.plot(bare, wrong, color=colour, marker=marker, mfc="none", ls="")
    for case in CASES["rays at the eye"]:
        size = case.split("map=")[1].split(",")[0]
        place = (own(rows[case]) + prepare(rows[case]), bad(rows[case]))
        axis.annotate(f"{size}$^2$", place, xytext=(4, 4), textcoords="offset points", fontsize=8)
    software = any(row["device"]["is_software"] for row in rows.values())
    label = "milliseconds a frame, own passes and prepare" + (" (software)" if software else "")
    axis.set(xscale="log", yscale="log", xlabel=label, ylabel="bad at 1 px, % (0.01: none)")
    axis.grid(color=GRID)
    axis.legend(fontsize=8)


def bad(row):
    return 100 * row["accuracy"]["bad_share"]["1"]


def milliseconds(row, counts):
    """Of the passes that count: medians, added up."""
    passes = [entry for entry in row["passes"] if counts(entry["name"]) and not entry["prepare"]]
    return sum((entry["gpu_ms"]["median"] if entry["gpu_ms"] else 0) for entry in passes)


def own(row):
    return milliseconds(row, lambda name: not name.startswith(SHARED))


def build(row):
    return milliseconds(row, lambda name: name.startswith("reflection-morphing/") and name.endswith(BUILD))


def prepare(row):
    """In each frame, where that is called again for what moved; on the CPU, too."""
    made = row["prepare"]
    return made["gpu_ms"] + made["cpu_ms"] if made and made["calls"] == len(row["frames"]) else 0


def cells(case, row):
    p95 = row["accuracy"]["displacement_px"]
    rays = f"{build(row):.1f}" if EYE in case else ""
    numbers = [f"{bad(row):.2f} %", f"{p95['p95']:.2f}" if p95 else "", f"{own(row):.1f}", rays]
    return [case, *numbers, f"{prepare(row):.1f}"]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
