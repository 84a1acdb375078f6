"""Popescu et al. 2006, slides 10, 14 and 35: what an impostor has to provide, measured.

To be seen: Of billboards and depth images on the scene `statue`, small, so that its checkers alias: what it takes to
make the impostors of a frame anew, processor and device together; what is read a mirrored ray to find what it meets;
and the error of the mirror's colours against 64 rays a pixel, beside that of the truth's one ray (line): with mip maps, or
from one level, which aliases like it.

Claim: "Impostor has to provide fast construction, fast intersection with ray, antialiasing" (10): of billboards
"YES, YES, YES" (14), of depth images "YES, ???, YES" (35).
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, main, render
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.figure import INK
from mirrorfigures.runs import compare

SCENE, SIZE = "statue", "160x120"
FRAMES = "0..4"
DEPTH = "depth-impostors:size=256,view=now,objects=3"
CASES = {
    "billboards, mip maps": "billboard-impostors",
    "billboards, one level": "billboard-impostors:filter=bilinear",
    "depth images, march": f"{DEPTH},search=march",
    "depth images, rows": DEPTH,
    "depth images, one level": f"{DEPTH},filter=bilinear",
    "depth images, revised": DEPTH.replace(":", "@revised:"),
}
READ = {"billboard-impostors": ("intersections",), "depth-impostors": ("texels", "segments")}


def draw(figure):
    fine, single = (render(SCENE, f"truth:spp={n}", size=SIZE) for n in (64, 1))
    runs = {name: render(SCENE, case, size=SIZE) for name, case in CASES.items()}
    figure.cite(fine, single, *runs.values())
    timed = bench(SCENE, list(CASES.values()), size=SIZE, frames=FRAMES, repeat=1)
    figure.cite(timed)
    built = [row["prepare"]["gpu_ms"] + row["prepare"]["cpu_ms"] for row in timed.rows]
    reads = [read(run.row) for run in runs.values()]
    errors = [compare(fine, run)["flip"]["mean"] for run in runs.values()]
    floor = compare(fine, single)["flip"]["mean"]
    plot, axes = plt.subplots(1, 3, figsize=(10.5, 3.3), sharey=True, layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.06, 1, 0.93))
    panels = zip(
        axes,
        (built, reads, errors),
        ("construction (ms a frame)", "intersection (reads a ray, log)", "antialiasing (FLIP against 64 rays)"),
        strict=True,
    )
    for axis, values, title in panels:
        axis.barh(list(CASES), values, color=COLOURS[0], height=0.6)
        axis.set_title(title, fontsize=10)
        axis.grid(axis="x", color=GRID, lw=0.6)
        axis.set_axisbelow(True)
    axes[1].set(xscale="log", xlim=(1, None))
    axes[2].axvline(floor, color=INK, lw=1)
    axes[2].text(floor, -0.5, "truth, one ray ", ha="right", fontsize=8)
    axes[0].set(ylim=(5.6, -0.8))
    figure.plot = plot
    table = [
        [name, f"{ms:.1f}", f"{least:.1f}", f"{flip:.3f}"]
        for name, ms, least, flip in zip(CASES, built, reads, errors, strict=True)
    ]
    figure.table("Requirements", ["impostor", "built, ms a frame", "reads a ray", "FLIP"], table)
    figure.number("FLIP of the truth's one ray a pixel", floor)
    said = ", ".join(f"{name} {flip:.3f}" for name, flip in zip(CASES, errors, strict=True))
    figure.finding(
        f"FLIP against 64 rays a pixel: {said}; one ray of the truth {floor:.3f}. A ray reads {reads[2]:.1f} texels by the "
        f"march, {reads[3]:.1f} of rows."
    )


def read(row):
    """Reads a pixel that shows a mirror."""
    return sum(row["counters"][name] for name in READ[row["method"]]) / row["reflector_pixels"]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
