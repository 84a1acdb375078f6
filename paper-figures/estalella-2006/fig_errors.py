"""Estalella et al. 2006: what eye distance, tessellation and texture size cost in accuracy.

To be seen: Mirror pixels more than a pixel off, and the 95th percentile of displacements. From left to right: on the
kitchen's path to the bowl; against the longest edge of triangles, on a mirror sphere, where the revised searches with
no further splits leave nothing but the bend of reflected edges, which grows with the square of their length; against
the longest edge of the sphere's own triangles, where each method is held against the same mesh ray traced, and that
against a round sphere; against the tolerance of the revised splits; against the textures' size.

Claim: "The scene loader subdivides geometry which is too large (typically too long and/or thin)" (section 6); what
is too large is not said, nor how large the textures are.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.runs import compare
from mirrorfigures.variants import alike

SIZE = "320x180"
KITCHEN, CLOSE = "kitchen-table1", 144
FRAMES = (0, 48, 96, 144, 192)
# The eye at the ends of the kitchen's path, metres from the bowl's middle.
FARTHEST, NEAREST = np.array([1.8, 0.7, 1.5]), np.array([0.436, 0.251, 0.363])
EDGES = (1.0, 0.5, 0.25)
# Of the mirror's triangles, metres; those of the round one are too short to be told from it.
MESHES, ROUND = (0.4, 0.2, 0.1), 0.0125
TOLERANCES = (2.0, 0.5, 0.125)
TEXTURES = (128, 256, 512, 1024)
PUBLISHED, REVISED = "virtual-objects", "virtual-objects@revised"
NAMES = ("published", "revised", "mesh")


def draw(figure):
    eyes = [FARTHEST + (NEAREST - FARTHEST) * frame / FRAMES[-1] for frame in FRAMES]
    distances = np.linalg.norm(eyes, axis=1).round(1)
    panels = [
        ("eye to bowl, m", distances, {
            "published": [(KITCHEN, f"{PUBLISHED}:subdivide=0.37", frame) for frame in FRAMES],
            "revised": [(KITCHEN, REVISED, frame) for frame in FRAMES],
        }),
        ("longest edge, m", EDGES, {
            "published": [("columns", f"{PUBLISHED}:subdivide={edge:g},texture=2048", 0) for edge in EDGES],
            "revised": [
                ("columns", f"{REVISED}:split_px=0,subdivide={edge:g},texture=1024", 0) for edge in EDGES
            ],
        }),
        ("mirror's edges, m", MESHES, {
            "published": [
                (mirror(edge), f"{PUBLISHED}:subdivide=0.25,texture=2048", 0) for edge in MESHES
            ],
            "revised": [(mirror(edge), REVISED, 0) for edge in MESHES],
            "mesh": [(mirror(edge), "truth", 0) for edge in MESHES],
        }),
        ("tolerance of splits, px", TOLERANCES, {
            "revised": [(KITCHEN, f"{REVISED}:split_px={px:g}", CLOSE) for px in TOLERANCES],
        }),
        ("texture, texels", TEXTURES, {
            "published": [
                (KITCHEN, f"{PUBLISHED}:subdivide=0.125,texture={texels}", CLOSE) for texels in TEXTURES
            ],
            "revised": [(KITCHEN, f"{REVISED}:texture={texels}", CLOSE) for texels in TEXTURES],
        }),
    ]  # fmt: skip
    plot, axes = plt.subplots(2, len(panels), figsize=(11.6, 4.8), sharex="col", layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    table, slopes = [], []
    for (shares, displacements), (label, places, series) in zip(axes.T, panels, strict=True):
        for name, asked in series.items():
            runs = [render(scene, case, frame=frame, size=SIZE) for scene, case, frame in asked]
            figure.cite(*runs)
            bad, p95 = errors(runs, asked)
            which = NAMES.index(name)
            style = {"color": COLOURS[which], "marker": MARKERS[which], "ms": 4, "label": name}
            shares.plot(places, 100 * bad, **style)
            displacements.plot(places, p95, **style)
            if axes[0, 0] is not shares:  # along the path it is no power
                slope = np.polyfit(np.log(places), np.log(p95), 1)[0]
                slopes.append(f"{name}, {label.split(',')[0]}: {slope:.2f}")
            for place, run, share, px in zip(places, runs, bad, p95, strict=True):
                work = run.row["counters"] or {}
                table.append([
                    name, f"{label.replace(',', ' in')}: {place:.4g}", f"{share:.1%}", f"{px:.3f}",
                    *(f"{work.get(key, 0):,.0f}" for key in ("searches", "halved", "no-room")),
                ])  # fmt: skip
        shares.set(ylim=(0, None))
        displacements.set(xscale="log", yscale="log", xlabel=f"{label} (log)")
        displacements.set_xticks(places, [f"{place:.4g}" for place in places])
        displacements.minorticks_off()
        for axis in (shares, displacements):
            axis.grid(color=GRID, lw=0.6)
    axes[0, 0].set_ylabel("bad at 1 px, %")
    axes[1, 0].set_ylabel("displacement, p95, px (log)")
    axes[0, 2].legend(fontsize=8)
    titles = ("kitchen", *2 * ["sphere among columns"], *2 * [f"kitchen, frame {CLOSE}"])
    for axis, title in zip(axes[0], titles, strict=True):
        axis.set_title(title)
    figure.plot = plot
    header = ["method", "at", "bad at 1 px", "p95, px", "searches", "triangles halved", "no room"]
    figure.table(f"Errors, {SIZE}", header, table)
    figure.finding(f"Exponents of the 95th percentile, fitted: {'; '.join(slopes)}.")


def mirror(edge):
    """The scene `columns` with a mirror of triangles with edges so long."""
    return alike("columns", "edge = 0.05", f"edge = {edge:g}")


def errors(runs, asked):
    """Share of mirror pixels bad at 1 px, and the 95th percentile of displacements, of each run: against
    the truth of its scene, or a truth itself against that of the round mirror."""
    judged = [
        compare(render(mirror(ROUND), "truth", size=SIZE), run) if case == "truth" else run.row["accuracy"]
        for run, (_, case, _) in zip(runs, asked, strict=True)
    ]
    return (
        np.array([accuracy["bad_share"]["1"] for accuracy in judged]),
        np.array([accuracy["displacement_px"]["p95"] for accuracy in judged]),
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
