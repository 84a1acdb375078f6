"""Martin & Popescu 2004, section 8: what a sampling location takes, and how fast vertices are morphed.

To be seen: Bytes of a location's octree, rays in its leaves (the mean over all leaves of a full tree, over those that
hold rays, and the fullest), the time to trace and build it, and vertices a second, as the eye comes nearer to the
mirror. Bands are the paper's ranges. The mirror is a sphere of 1 m on a floor of 12 m, where these do not meet ours at one
distance: leaves are as wide as the box is, and the fullest one lies where rays leave the mirror. On a floor of 6 m they do.
The paper gives no dimensions.

Claim: "With a ray map resolution of 256 x 256, an octree depth of 5, and one reflective bounce allowed, the
preprocessed data required 4.1 - 5.4 MB of space for a sampling location. A location's average number of rays at a leaf
was in the 10.4 - 13.5 range, and its maximum number of rays was in the 227 - 353 range. Preprocessing takes about 3
minutes per sampling location." "20,000 dynamic vertices per second and 200,000 static vertices per second", on a
Pentium 4 of 2 GHz.
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import bench, main, render
from mirrorfigures.cameras import camera
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.ray_octrees import BUFFERS, Octree, dumped
from mirrorfigures.variants import changed

SCENE, SIZE, FRAMES = "columns-dolly", "128x96", (0, 72, 108, 130, 145, 160, 190)
# So small a cell that its eight locations are all where the eye is, and that none is kept for the next frame.
CASE = "reflection-morphing:cell=0.01,files=none"
MIRROR, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
FLOOR, SMALL_FLOOR = "plane = { size = [12.0, 12.0] }", "plane = { size = [6.0, 6.0] }"
LEAVES = 8**5
# What a ray in a leaf takes, if the paper's means are over all leaves.
ENTRY_BYTES = 12
PAPER = {"MB": (4.1, 5.4), "mean": (10.4, 13.5), "largest": (227, 353)}
PAPER_S, PAPER_DYNAMIC, PAPER_STATIC = 180, 20e3, 200e3
HEADER = [
    "floor, m", "metres to the mirror", "rays", "MB", f"MB at {ENTRY_BYTES} B a ray in a leaf", "mean of all leaves",
    "mean of those with rays", "largest", "rays a look-up", "build, ms", "dynamic vertices a second", "static",
]  # fmt: skip


@dataclass(frozen=True)
class Rates:
    """Of the eight locations of a cell, a centimetre apart."""

    rays_a_look_up: float
    build_ms: float
    dynamic: float
    static: float


@dataclass(frozen=True)
class Location:
    """One location."""

    away: float
    octree: Octree
    rates: Rates | None


def draw(figure):
    small_scene = changed(SCENE, FLOOR, SMALL_FLOOR)
    wide = by_distance(location(figure, frame, SCENE, timed=True) for frame in FRAMES)
    small = by_distance(location(figure, frame, small_scene, timed=False) for frame in FRAMES)
    figure.plot = charts(wide, small)
    paper = ["", "4.1 - 5.4", "", "10.4 - 13.5", "", "227 - 353", "", "about 180,000", "20,000", "200,000"]
    rows = [["", "paper", *paper], *(cells("12", it) for it in wide), *(cells("6", it) for it in small)]
    figure.table("A sampling location (vertices a second: the best frame's)", HEADER, rows)
    verdicts = [f"{verdict(found)} on a floor of {floor} m" for found, floor in ((wide, 12), (small, 6))]
    rates = [it.rates for it in wide]
    slowest = min(rates, key=lambda it: it.dynamic)
    built, static = [it.build_ms for it in rates], [it.static / 1e6 for it in rates]
    figure.finding(
        f"Ours are in the paper's ranges at these distances: {'; '.join(verdicts)}. A location is built in "
        f"{min(built):.0f} to {max(built):.0f} ms. Of dynamic vertices at least {slowest.dynamic:,.0f} a second are looked "
        f"up ({slowest.rays_a_look_up:.0f} rays a look-up), of static ones {min(static):.0f} to {max(static):.0f} million "
        "morphed."
    )


def by_distance(locations):
    return sorted(locations, key=lambda it: it.away)


def verdict(found) -> str:
    """Where the mean over leaves with rays and the fullest leaf are as in the paper, and what bytes would be."""
    mean = within(found, lambda it: it.octree.mean, PAPER["mean"])
    largest = within(found, lambda it: it.octree.largest, PAPER["largest"])
    both = [max(mean[0], largest[0]), min(mean[1], largest[1])]
    said = f"mean {mean[0]:.2f} to {mean[1]:.2f} m, fullest leaf {largest[0]:.2f} to {largest[1]:.2f} m"
    if both[0] > both[1]:
        return f"{said}, nowhere both"
    away = np.log([it.away for it in found])
    megabytes = np.log([1e-6 * it.octree.entries for it in found])
    bytes_each = [mb / np.exp(np.interp(np.log(far), away, megabytes)) for mb, far in zip(PAPER["MB"][::-1], both)]
    return (
        f"{said}, both {both[0]:.2f} to {both[1]:.2f} m, and its bytes if a ray in a leaf takes "
        f"{min(bytes_each):.0f} to {max(bytes_each):.0f}"
    )


def location(figure, frame, scene, *, timed):
    drawn = render(scene, CASE, frame=frame, size=SIZE, dump=BUFFERS)
    figure.cite(drawn)
    away = float(np.linalg.norm(camera(SCENE, frame, SIZE).eye - MIRROR) - RADIUS)
    return Location(away, dumped(drawn), rates_of(figure, frame, drawn.row["counters"]) if timed else None)


def rates_of(figure, frame, counters) -> Rates:
    timed = bench(SCENE, [CASE], size=SIZE, frames=f"{frame}..{frame + 2}", repeat=4)
    figure.cite(timed)
    passes = {one["name"]: one for one in timed.row["passes"] if not one["prepare"]}

    # The least, as what else a machine does only adds to it.
    def least_ms(name):
        return passes[f"reflection-morphing/{name}"]["gpu_ms"]["min"]

    asked = least_ms("look-up-still") + least_ms("look-up-moving")
    return Rates(
        rays_a_look_up=counters["rays"] / counters["look-ups"],
        build_ms=passes["reflection-morphing/octree"]["cpu_ms"] / 8,
        dynamic=1e3 * counters["look-ups"] / 8 / asked,
        static=1e3 * passes["reflection-morphing/morph"]["invocations"] / least_ms("morph"),
    )


def within(found, of, band):
    """From which distance to which a number that falls with distance is in a band."""
    away, values = np.array([[it.away, of(it)] for it in found]).T
    return [float(np.exp(np.interp(-np.log(edge), -np.log(values), np.log(away)))) for edge in band[::-1]]


def charts(wide, small):
    plot, axes = plt.subplots(2, 3, figsize=(10, 5.8), layout="constrained", sharex=True)
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95))
    bytes_of = {
        "arrays of the octree": [it.octree.bytes / 1e6 for it in wide],
        f"{ENTRY_BYTES} B a ray in a leaf": [entry_megabytes(it) for it in wide],
    }
    means = {
        "of all $32^3$": [it.octree.entries / LEAVES for it in wide],
        "of those with rays": [it.octree.mean for it in wide],
    }
    floors = {"floor of 12 m": wide, "floor of 6 m": small}
    fullest = {name: [it.octree.largest for it in found] for name, found in floors.items()}
    rates = [it.rates for it in wide]
    speeds = {"static": [it.static for it in rates], "dynamic": [it.dynamic for it in rates]}
    lines = [
        ("megabytes a location", bytes_of, PAPER["MB"]),
        ("rays a leaf, mean", means, PAPER["mean"]),
        ("rays in the fullest leaf", fullest, PAPER["largest"]),
        ("rays looked at a look-up", {"": [it.rays_a_look_up for it in rates]}, None),
        ("milliseconds a build", {"": [it.build_ms for it in rates]}, (1e3 * PAPER_S, 1.1e3 * PAPER_S)),
        ("vertices a second", speeds, None),
    ]
    away = [it.away for it in wide]
    for axis, (title, curves, band) in zip(axes.flat, lines, strict=True):
        for (label, values), colour, marker in zip(curves.items(), COLOURS, "os", strict=False):
            axis.plot(away, values, color=colour, marker=marker, ms=4, label=label)
        if band:
            axis.axhspan(*band, color="#e8590c", alpha=0.35, lw=0, label="paper")
        axis.set(title=title, xscale="log", yscale="log")
        axis.set_xticks([0.5, 1, 2, 3], ["0.5", "1", "2", "3"])
        axis.minorticks_off()
        axis.grid(color=GRID, lw=0.6)
    for value, name in ((PAPER_STATIC, "static"), (PAPER_DYNAMIC, "dynamic")):
        axes[1, 2].axhline(value, color="#e8590c", ls=":", lw=1)
        at = {"va": "bottom", "ha": "right", "fontsize": 7.5, "color": "#e8590c"}
        axes[1, 2].annotate(f"paper, {name}", (away[-1], value), **at)
    for axis in (*axes[0], axes[1, 2]):
        axis.legend(fontsize=7.5)
    for axis in axes[1]:
        axis.set_xlabel("metres from the mirror (log)")
    return plot


def entry_megabytes(it) -> float:
    return 1e-6 * ENTRY_BYTES * it.octree.entries


def cells(floor, it):
    tree, rates = it.octree, it.rates
    sizes = [f"{tree.rays:,}", f"{tree.bytes / 1e6:.2f}", f"{entry_megabytes(it):.2f}"]
    leaves = [f"{tree.entries / LEAVES:.1f}", f"{tree.mean:.1f}", f"{tree.largest:,}"]
    speeds = [""] * 4
    if rates:
        speeds = [f"{rates.rays_a_look_up:.1f}", f"{rates.build_ms:.0f}", f"{rates.dynamic:,.0f}", f"{rates.static:,.0f}"]
    return [floor, f"{it.away:.2f}", *sizes, *leaves, *speeds]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
