"""Popescu et al. 2006, slide 39: what building simplified rotated depth maps takes.

To be seen: Milliseconds to build all rows of one depth image of 512 x 512 texels, a map every 10 degrees,
for at most 8, 16, 32 and 64 segments a row: on all cores of the processor, as published, and on the device, as
their slide 50 names for future work. The paper's numbers are those of its time; slopes can be compared.

Claim: "Number of segments 8, 16, 32, 64: construction time 210, 300, 480, 980 ms. Rigid body transformations,
color updates, and reflector updates do not require reconstruction."
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, main
from mirrorfigures.charts import COLOURS, GRID

PUBLISHED = {8: 210.0, 16: 300.0, 32: 480.0, 64: 980.0}
# The statue turns, and the image of it follows: of the things there, it alone is built anew in each frame.
FRAMES = "0..4"


def case(segments, build):
    return f"depth-impostors:build={build},objects=3,segments={segments},view=now"


def draw(figure):
    cases = [case(segments, build) for build in ("cpu", "gpu") for segments in PUBLISHED]
    run = bench("statue", cases, size="160x120", frames=FRAMES, repeat=1)
    figure.cite(run)
    cores = [row["prepare"]["cpu_ms"] for row in run.rows[: len(PUBLISHED)]]
    device = [on_device(row) for row in run.rows[len(PUBLISHED) :]]
    plot, axis = plt.subplots(figsize=(7.6, 4.0), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    lines = {"slide 39": list(PUBLISHED.values()), "all cores, ours": cores, "device, ours": device}
    for (label, times), colour, marker in zip(lines.items(), COLOURS, "osD", strict=False):
        axis.plot(list(PUBLISHED), times, marker=marker, color=colour, label=label)
    axis.set(xscale="log", yscale="log", xlabel="segments a row, at most", ylabel="build, ms (log)")
    axis.set_xticks(list(PUBLISHED), [str(n) for n in PUBLISHED])
    axis.minorticks_off()
    axis.grid(color=GRID, lw=0.6)
    axis.legend(fontsize=8)
    figure.plot = plot
    table = [
        [str(n), f"{slide:.0f}", f"{c:.0f}", f"{d:.0f}"]
        for (n, slide), c, d in zip(PUBLISHED.items(), cores, device, strict=True)
    ]
    figure.table("Build, ms", ["segments", "slide 39", "all cores", "device"], table)
    slopes = ", ".join(f"{name} {times[-1] / times[0]:.1f}" for name, times in lines.items())
    figure.finding(f"From 8 segments to 64 the time grows by: {slopes}.")


def on_device(row):
    """Median milliseconds of the passes that build rows."""
    times = {step["name"]: step["gpu_ms"]["median"] for step in row["passes"]}
    return sum(times.get(f"depth-impostors/{name}", 0.0) for name in ("rotate", "simplify"))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
