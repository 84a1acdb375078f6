"""Patow 1995, sections 3 and 7: what the cost of searching a z-buffered map depends on.

To be seen: Above, the time of the reflecting pass a reflective pixel, and below what it counts there, against the
number of reflective pixels, of reflectors, and of triangles. Legends have the exponent of a power fitted: 0 is
flat, so that the whole is linear in reflective pixels. The table compares a map for each reflector with one for
all.

Claim: "The algorithm complexity only depends on the number of reflective pixels rendered" (section 3); one
z-buffered map could serve all reflectors of a scene (section 7).
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullLocator

from mirrorfigures import bench, main, paths
from mirrorfigures.charts import COLOURS, GRID, MARKERS

OWN, SHARED = "z-buffered-map", "z-buffered-map:map=scene"
REVISED = "z-buffered-map@revised:size=256,layers=2"
COUNTED = {OWN: "texels", REVISED: "visits"}
LABELS = {OWN: "published, texels examined", REVISED: "revised, cells visited"}
VIEW = "384x384"
SIDES = [128, 256, 384, 512]
REFLECTORS = [1, 2, 4]
SLICES = [4, 24, 72]

BALL = """[[objects]]
name = "sphere"
shape = { sphere = { radius = 1.0, slices = 32, stacks = 16 } }
material = "mirror"
"""


def kept(name, text):
    """A scene file beside the runs."""
    folder = paths.out() / ".scenes"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def shipped(name):
    return (paths.ROOT / "scenes" / f"{name}.toml").read_text(encoding="utf-8")


def with_reflectors(count):
    """Patow's room with so many balls on a ring about where his one is, as large as they fit."""
    room = shipped("patow-room")
    radius = 1.0 if count == 1 else 0.9 / (1.0 + 1.0 / np.sin(np.pi / count))
    ring = 0.0 if count == 1 else 1.1 * radius / np.sin(np.pi / count)
    balls = ""
    for i in range(count):
        x, y = ring * np.cos(2 * np.pi * i / count), ring * np.sin(2 * np.pi * i / count)
        ball = BALL.replace('"sphere"', f'"sphere-{i}"').replace("radius = 1.0", f"radius = {radius:.4f}")
        balls += f"{ball}position = [{x:.4f}, {y:.4f}, 0.0]\n\n"
    return kept(f"patow-room-reflectors-{count}", room.replace(BALL, balls))


def with_slices(slices):
    """`clutter-60` with balls of so many slices."""
    text = shipped("clutter-60")
    text = text.replace("slices = 24, stacks = 12", f"slices = {slices}, stacks = {max(slices // 2, 2)}")
    return kept(f"clutter-60-flat-{slices}", text)


def measured(figure, scene, size, cases):
    run = bench(scene, cases, size=size, frames="0..1", repeat=12)
    figure.cite(run)
    return run, dict(zip(cases, run.rows, strict=True))


def per_pixel(run, row, case):
    """Microseconds, and what is counted, a reflective pixel."""
    pixels = row["reflector_pixels"]
    time = min(run.pass_ms(row, "z-buffered-map/reflect"))
    return 1e3 * time / pixels, row["counters"][COUNTED[case]] / pixels


def exponent(x, y):
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def draw(figure):
    series = {
        "reflective pixels": [("patow-room", f"{side}x{side}") for side in SIDES],
        "reflectors": [(with_reflectors(count), VIEW) for count in REFLECTORS],
        "triangles": [(with_slices(slices), VIEW) for slices in SLICES],
    }
    plot, axes = plt.subplots(2, 3, figsize=(10.2, 5.6), layout="constrained", sharey="row")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    exponents, shared = {}, []
    for (label, points), column in zip(series.items(), axes.T, strict=True):
        cases = [OWN, REVISED, SHARED] if label == "reflectors" else [OWN, REVISED]
        x, costs = [], {OWN: [], REVISED: []}
        for place, (scene, size) in enumerate(points):
            run, rows = measured(figure, scene, size, cases)
            row = rows[OWN]
            pixels, triangles = row["reflector_pixels"], row["scene"]["triangles"]
            x.append({"reflective pixels": pixels, "triangles": triangles}.get(label) or REFLECTORS[place])
            for case, cost in costs.items():
                cost.append(per_pixel(run, rows[case], case))
            if SHARED in rows:
                shared.append([str(REFLECTORS[place]), *maps(rows[OWN], rows[SHARED])])
        exponents[label] = {case: [exponent(x, y) for y in zip(*cost, strict=True)] for case, cost in costs.items()}
        chart(column, label, x, costs, exponents[label])
    axes[0, 0].set_ylabel("µs a reflective pixel (log)" + (", software" if figure.is_software else ""))
    axes[1, 0].set_ylim(0, 1.3 * max(axis.dataLim.y1 for axis in axes[1]))
    axes[1, 0].set_ylabel("counted a reflective pixel")
    figure.plot = plot
    conclude(figure, exponents, shared)


def chart(column, label, x, costs, exponents):
    for (case, cost), colour, marker in zip(costs.items(), COLOURS, MARKERS, strict=False):
        for axis, y, power in zip(column, zip(*cost, strict=True), exponents[case], strict=True):
            name = LABELS[case] if axis is column[1] else LABELS[case].split(",")[0]
            axis.plot(x, y, color=colour, marker=marker, ms=5, label=f"{name}: {power:+.2f}")
    for axis in column:
        axis.set(xscale="log", xlabel=f"{label} (log)")
        axis.set_xticks(x, [f"{place:,.0f}" for place in x])
        axis.xaxis.set_minor_locator(NullLocator())
        axis.grid(True, which="both", color=GRID, lw=0.6)
        axis.legend(fontsize=7.5)
    column[0].set_yscale("log")


def maps(own, shared):
    """Wrong pixels, megabytes and capture of both, for the table."""
    both = (own, shared)
    return [
        *(f"{100 * row['accuracy']['bad_share']['1']:.1f} %" for row in both),
        *(f"{row['prepare']['bytes'] / 1e6:.0f}" for row in both),
        *(f"{row['prepare']['gpu_ms']:.0f}" for row in both),
        *(f"{per(row):.0f}" for row in both),
    ]


def per(row):
    return row["counters"]["texels"] / row["reflector_pixels"]


def conclude(figure, exponents, shared):
    kinds = ["bad at 1 px", "MB", "capture, ms", "texels a pixel"]
    header = ["reflectors", *(f"{kind}: {whose}" for kind in kinds for whose in ("own maps", "one map"))]
    figure.table("Published: a map for each reflector, and one for all (his section 7)", header, shared)
    figure.number("exponents_of_cost_a_pixel", exponents)
    time = [powers[case][0] for powers in exponents.values() for case in powers]
    work = [powers[case][1] for powers in exponents.values() for case in powers]
    figure.finding(
        f"The work a reflective pixel goes with powers of {min(work):+.2f} to {max(work):+.2f} of the number of "
        f"pixels, reflectors and triangles: flat, where a cost that followed them would go with 1. Its time goes with "
        f"{min(time):+.2f} to {max(time):+.2f}, what else ran on the machine included. One map "
        f"for {shared[-1][0]} reflectors leaves {shared[-1][2]} of their pixels bad, their own maps {shared[-1][1]}."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
