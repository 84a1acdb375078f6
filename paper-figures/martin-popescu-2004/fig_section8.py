"""Martin & Popescu 2004, section 8: what a sampling location takes, and how fast vertices are morphed.

To be seen: Bytes of a location's octree, rays in its leaves (the mean over all leaves of a full tree, over those that
hold rays, and the fullest), the time to trace and build it, and vertices a second, as the eye comes nearer to the
mirror. Bands are the paper's ranges, which do not all meet ours at one distance: see the table. The mirror is a
sphere of 1 m on a floor of 12 m; the paper gives no dimensions. Its scene was probably smaller beside its mirror.

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

SCENE, SIZE, FRAMES = "columns-dolly", "128x96", (0, 72, 108, 130, 145, 160, 190)
# So small a cell that its eight locations are all where the eye is, and that none is kept for the next frame.
CASE = "reflection-morphing:cell=0.01,files=none"
MIRROR, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
LEAVES = 8**5
# What a ray in a leaf takes, if the paper's bytes and rays are of the same leaves.
ENTRY_BYTES = 12
PAPER = {"MB": (4.1, 5.4), "mean": (10.4, 13.5), "largest": (227, 353)}
PAPER_S, PAPER_DYNAMIC, PAPER_STATIC = 180, 20e3, 200e3
HEADER = [
    "metres to the mirror", "rays", "MB", f"MB at {ENTRY_BYTES} B a ray in a leaf", "mean of all leaves",
    "mean of those with rays", "largest", "rays a look-up", "build, ms", "dynamic vertices a second", "static",
]  # fmt: skip


@dataclass(frozen=True)
class Location:
    """Of one location, or of the eight of a cell, which are a centimetre apart."""

    away: float
    octree: Octree
    examined: float
    """Rays a look-up."""
    build_ms: float
    dynamic: float
    static: float

    @property
    def megabytes(self):
        return self.octree.bytes / 1e6

    @property
    def megabytes_of_entries(self):
        return ENTRY_BYTES * self.octree.lists.sum() / 1e6

    @property
    def mean_of_all(self):
        return self.octree.lists.sum() / LEAVES

    @property
    def mean(self):
        return self.octree.lists[self.octree.lists > 0].mean()

    @property
    def largest(self):
        return self.octree.lists.max()


def draw(figure):
    found = [location(figure, frame) for frame in FRAMES]
    found.sort(key=lambda it: it.away)
    figure.plot = charts(found)
    paper = ["paper", "", "4.1 - 5.4", "", "10.4 - 13.5", "", "227 - 353", "", "about 180,000", "20,000", "200,000"]
    title = "A sampling location (vertices a second: the best frame's)"
    figure.table(title, HEADER, [paper, *map(cells, found)])
    ranges = {
        "bytes": within(found, lambda it: it.megabytes, PAPER["MB"]),
        "mean over all leaves": within(found, lambda it: it.mean_of_all, PAPER["mean"]),
        f"bytes at {ENTRY_BYTES} a ray in a leaf": within(found, lambda it: it.megabytes_of_entries, PAPER["MB"]),
        "largest leaf": within(found, lambda it: it.largest, PAPER["largest"]),
    }
    figure.number("metres from the mirror at which ours are in the paper's range", ranges)
    said = "; ".join(f"{name} {far[0]:.2f} to {far[1]:.2f} m" for name, far in ranges.items())
    nearest, farthest = max(far[0] for far in ranges.values()), min(far[1] for far in ranges.values())
    verdict = f"all do at {nearest:.2f} to {farthest:.2f} m" if nearest <= farthest else "nowhere do all"
    slowest = min(found, key=lambda it: it.dynamic)
    built, static = ([of(it) for it in found] for of in (lambda it: it.build_ms, lambda it: it.static / 1e6))
    figure.finding(
        f"Ours are in the paper's ranges at these distances: {said}; {verdict}. A location is built in {min(built):.0f} to "
        f"{max(built):.0f} ms. Of dynamic vertices at least {slowest.dynamic:,.0f} a second are looked up "
        f"({slowest.examined:.0f} rays a look-up), of static ones {min(static):.0f} to {max(static):.0f} million morphed."
    )


def location(figure, frame):
    drawn = render(SCENE, CASE, frame=frame, size=SIZE, dump=BUFFERS)
    timed = bench(SCENE, [CASE], size=SIZE, frames=f"{frame}..{frame + 2}", repeat=4)
    figure.cite(drawn, timed)
    counters = drawn.row["counters"]
    passes = {one["name"]: one for one in timed.row["passes"] if not one["prepare"]}

    # The least, as what else a machine does only adds to it.
    def least_ms(name):
        return passes[f"reflection-morphing/{name}"]["gpu_ms"]["min"]

    asked = least_ms("look-up-still") + least_ms("look-up-moving")
    return Location(
        away=float(np.linalg.norm(camera(SCENE, frame, SIZE).eye - MIRROR) - RADIUS),
        octree=dumped(drawn),
        examined=counters["rays"] / counters["look-ups"],
        build_ms=passes["reflection-morphing/octree"]["cpu_ms"] / 8,
        dynamic=1e3 * counters["look-ups"] / 8 / asked,
        static=1e3 * passes["reflection-morphing/morph"]["invocations"] / least_ms("morph"),
    )


def within(found, of, band):
    """From which distance to which a number that falls with distance is in a band."""
    away, values = np.array([[it.away, of(it)] for it in found]).T
    return [float(np.exp(np.interp(-np.log(edge), -np.log(values), np.log(away)))) for edge in band[::-1]]


def charts(found):
    plot, axes = plt.subplots(2, 3, figsize=(10, 5.8), layout="constrained", sharex=True)
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95))
    away = [it.away for it in found]
    bytes_of = {
        "arrays of the octree": lambda it: it.megabytes,
        f"{ENTRY_BYTES} B a ray in a leaf": lambda it: it.megabytes_of_entries,
    }
    means = {"of all $32^3$": lambda it: it.mean_of_all, "of those with rays": lambda it: it.mean}
    lines = [
        ("megabytes a location", bytes_of, PAPER["MB"]),
        ("rays a leaf, mean", means, PAPER["mean"]),
        ("rays in the fullest leaf", {"": lambda it: it.largest}, PAPER["largest"]),
        ("rays looked at a look-up", {"": lambda it: it.examined}, None),
        ("milliseconds a build", {"": lambda it: it.build_ms}, (1e3 * PAPER_S, 1.1e3 * PAPER_S)),
        ("vertices a second", {"static": lambda it: it.static, "dynamic": lambda it: it.dynamic}, None),
    ]
    for axis, (title, curves, band) in zip(axes.flat, lines, strict=True):
        for (label, of), colour, marker in zip(curves.items(), COLOURS, "os", strict=False):
            axis.plot(away, [of(it) for it in found], color=colour, marker=marker, ms=4, label=label)
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
    for axis in (axes[0, 0], axes[0, 1], axes[1, 2]):
        axis.legend(fontsize=7.5)
    for axis in axes[1]:
        axis.set_xlabel("metres from the mirror (log)")
    return plot


def cells(it):
    sizes = [f"{it.octree.rays:,}", f"{it.megabytes:.2f}", f"{it.megabytes_of_entries:.2f}"]
    leaves = [f"{it.mean_of_all:.1f}", f"{it.mean:.1f}", f"{it.largest:,}", f"{it.examined:.1f}"]
    rates = [f"{it.build_ms:.0f}", f"{it.dynamic:,.0f}", f"{it.static:,.0f}"]
    return [f"{it.away:.2f}", *sizes, *leaves, *rates]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
