"""Scaling: what virtual objects cost as vertices and reflectors grow, and where others overtake them.

To be seen: Above, the work of a frame; below, the time of the reflecting passes. Left, one mirror and more
and more vertices; right, more and more mirrors that share the same part of the picture, with as many
vertices. Work is what each method does most, so that slopes compare, heights only roughly: texels a
search of the reflector looks at, texels and nodes of a map, nodes and triangles of a tree. Published work
is a first frame's, which starts from the centre; its times have the frame before. The dashed line adds the
capture of the map, due again wherever something moves.

Claim: None; ours is that the work is linear in vertices times reflectors, or better.
"""

import os
from math import sqrt

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import bench, main, paths
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.runs import RunFailed

SIZE = "320x200"
# MIRRORBENCH_SCALING=full: up to 3,000,000 vertices and 64 reflectors.
FULL = os.environ.get("MIRRORBENCH_SCALING") == "full"
VERTICES = [5_000, 30_000, 300_000] + ([1_000_000, 3_000_000] if FULL else [])
REFLECTORS = [1, 4, 16] + ([64] if FULL else [])
FEW, MANY = 1, 30_000
"""Reflectors while vertices grow, and vertices while reflectors do."""

PUBLISHED = "virtual-objects@published:subdivide=0"
REVISED = "virtual-objects@revised"
SEARCHED = "z-buffered-map@revised"
TRACED = "ray-traced"
WORK = {
    PUBLISHED: ("evaluations",),
    REVISED: ("evaluations",),
    SEARCHED: ("texels", "visits"),
    TRACED: ("nodes", "triangles"),
}

FLOOR, MIRROR, BALLS = 65 * 17, 25 * 13, 40
SCENE = """about = "Mirrors in a square on a floor among balls"

[camera]
fov_deg = 50.0
eye = [0.0, 4.0, 5.0]
target = [0.0, 0.4, 0.0]

[lighting]
ambient = [0.4, 0.4, 0.4]
sun = [0.6, 0.6, 0.6]
towards_sun = [0.45, 0.8, 0.4]

[environment]
gradient = {{ zenith = [0.18, 0.36, 0.75], horizon = [0.85, 0.9, 0.95], nadir = [0.32, 0.28, 0.24] }}

[materials]
mirror = {{ mirror = {{ reflectance = 0.95 }} }}
floor = {{ colour = [0.6, 0.57, 0.5] }}
ball = {{ checker = {{ even = [0.75, 0.12, 0.1], odd = [0.8, 0.5, 0.12], size = [0.125, 0.25] }} }}

[[objects]]
name = "floor"
material = "floor"
[objects.shape.revolution]
profile = [[6.0, 0.0], [4.0, 0.0], [2.0, 0.0], [0.0, 0.0]]
curve = "bezier"
slices = 64
stacks = 16

[[objects]]
name = "ball"
shape = {{ sphere = {{ radius = 0.3, slices = {slices}, stacks = {stacks} }} }}
material = "ball"
[objects.scatter]
count = {balls}
seed = 3
low = [-4.0, 0.3, -4.0]
high = [4.0, 1.5, 3.0]
clear = [{{ centre = [0.0, 0.0, 0.0], radius = 2.4 }}]
"""
OBJECT = """
[[objects]]
name = "mirror-{number}"
shape = {{ sphere = {{ radius = {radius:.4f}, slices = 24, stacks = 12 }} }}
material = "mirror"
position = [{x:.4f}, {radius:.4f}, {z:.4f}]
"""


def scene(vertices, reflectors):
    """A scene of about so many vertices; mirrors in a square of 3 m, however many."""
    side = round(sqrt(reflectors))
    stacks = round(sqrt(max(vertices - FLOOR - reflectors * MIRROR, 0) / BALLS / 2))
    text = SCENE.format(slices=2 * stacks, stacks=stacks, balls=BALLS)
    for number in range(reflectors):
        x, z = (3 * ((place + 0.5) / side - 0.5) for place in (number % side, number // side))
        text += OBJECT.format(number=number, radius=1.2 / side, x=x, z=z)
    folder = paths.out() / ".scenes"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"scaling-{vertices}-{reflectors}.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


class Point:
    """What one case takes on one scene."""

    def __init__(self, figure, case, vertices, reflectors):
        self.refused = None
        try:
            path, repeat = scene(vertices, reflectors), 3 if vertices * reflectors <= 1_000_000 else 1
            run = bench(path, [case], size=SIZE, frames="0..1", repeat=repeat)
        except RunFailed as refused:
            self.refused = str(refused).split(": ", 2)[-1]
            return
        figure.cite(run)
        row = run.row
        self.vertices, self.reflectors = row["scene"]["vertices"], reflectors
        self.counters = row["counters"]
        self.work = sum(self.counters.get(name, 0) for name in WORK[case])
        own = [entry for entry in row["passes"] if entry["name"].split("/")[0] == row["method"]]
        self.ms = sum(entry["gpu_ms"]["median"] for entry in own if not entry["prepare"])
        self.prepare = row["prepare"]["gpu_ms"] + row["prepare"]["cpu_ms"]


def exponent(sizes, values):
    """Of the power law fitted to the points, least squares of logarithms."""
    if len(sizes) < 2:
        return None
    return float(np.polyfit(np.log(sizes), np.log(values), 1)[0])


def draw(figure):
    axes_of = {
        "vertices": [(vertices, FEW) for vertices in VERTICES],
        "reflectors": [(MANY, reflectors) for reflectors in REFLECTORS],
    }
    plot, axes = plt.subplots(2, 2, figsize=(9.2, 7.2), layout="constrained", sharey="row")
    plot.get_layout_engine().set(rect=(0, 0.03, 1, 0.97))
    fits, said, crossed = {}, [], []
    for column, (along, scenes) in zip(axes.T, axes_of.items(), strict=True):
        lines = {case: measured(figure, case, scenes) for case in WORK}
        said += [text for case, line in lines.items() for text in refusals(case, scenes, line)]
        kept = {case: [p for p in line if not p.refused] for case, line in lines.items()}
        for axis, value in zip(column, ("work", "ms"), strict=True):
            chart(axis, kept, along, value)
        fits[along] = {
            case: {
                value: exponent([getattr(p, along) for p in line], [getattr(p, value) for p in line])
                for value in ("work", "ms")
            }
            for case, line in kept.items()
        }
        table(figure, along, kept)
        crossed += [row for case in (PUBLISHED, REVISED) for row in crossings(kept, case, along)]
    axes[0, 0].set_ylabel("texels, nodes, triangles (log)")
    axes[1, 0].set_ylabel("reflecting passes, GPU ms (log)")
    axes[1, 0].legend(fontsize=7.5)
    figure.plot = plot
    figure.number("exponents", fits)
    header = ["along", "virtual objects", "against", "work", "time", "time with the first call"]
    figure.table("Cross-overs: where the other is cheaper or dearer", header, crossed)
    slopes = [
        f"{case}: work {by['work']:.2f}, time {by['ms']:.2f} in {along}"
        for along, cases in fits.items()
        for case, by in cases.items()
        if by["work"] is not None
    ]
    figure.finding("Exponents: " + "; ".join(slopes) + ". " + " ".join(said))


def measured(figure, case, scenes):
    return [Point(figure, case, *numbers) for numbers in scenes]


def refusals(case, scenes, points):
    return [
        f"Refused, {case} with {vertices:,} vertices and {reflectors} reflectors: {point.refused}."
        for (vertices, reflectors), point in zip(scenes, points, strict=True)
        if point.refused
    ]


def chart(axis, lines, along, value):
    for (case, line), colour, marker in zip(lines.items(), COLOURS, MARKERS, strict=False):
        sizes = [getattr(point, along) for point in line]
        axis.plot(sizes, [getattr(p, value) for p in line], color=colour, marker=marker, ms=5, label=case)
        if case == SEARCHED and value == "ms":
            whole = [point.ms + point.prepare for point in line]
            axis.plot(sizes, whole, color=colour, marker=marker, ms=5, ls="--", label="with its capture")
    axis.set(xscale="log", yscale="log", xlabel=f"{along} (log)")
    fixed = {"vertices": f"{FEW} reflector", "reflectors": f"about {MANY:,} vertices"}[along]
    axis.set_title(f"{dict(work='work', ms='time')[value]}, {fixed}, {SIZE}")
    axis.grid(True, which="major", color=GRID, lw=0.6)


def table(figure, along, lines):
    header = [along, "case", "searches", "steps", "evaluations", "halved", "work", "ms", "first call, ms"]
    rows = [
        [
            f"{getattr(point, along):,}", case,
            *(f"{point.counters.get(n, 0):,.0f}" for n in ("searches", "steps", "evaluations", "halved")),
            f"{point.work:,.0f}", f"{point.ms:.1f}", f"{point.prepare:.1f}",
        ]
        for case, line in lines.items()
        for point in line
    ]  # fmt: skip
    figure.table(f"Work and time of a frame, by {along}", header, rows)


def crossings(lines, case, along):
    """From where on the others are cheaper than a case, in work and in time."""
    ours = {getattr(point, along): point for point in lines[case]}
    costs = [
        (lambda p: p.work, lambda p: p.work),
        (lambda p: p.ms, lambda p: p.ms),
        (lambda p: p.ms, lambda p: p.ms + p.prepare),
    ]
    for other in (SEARCHED, TRACED):
        sizes = [(getattr(point, along), point) for point in lines[other]]
        pairs = [
            [(n, mine(ours[n]), theirs(point)) for n, point in sizes if n in ours] for mine, theirs in costs
        ]
        if pairs[0]:
            yield [along, case, other, *map(crossing, pairs)]


def crossing(pairs):
    """From which size on the second is cheaper: interpolated between the scenes in logarithms."""
    ahead = [np.log(mine / theirs) for _, mine, theirs in pairs]
    if min(ahead) > 0:
        return f"cheaper throughout, {pairs[0][1] / pairs[0][2]:.1f} times at {pairs[0][0]:,}"
    if max(ahead) < 0:
        return "dearer throughout"
    for (low, *_), (high, *_), a, b in zip(pairs, pairs[1:], ahead, ahead[1:], strict=False):
        if (a < 0) != (b < 0):
            at = np.exp(np.interp(0, sorted((a, b)), np.log([low, high] if a < b else [high, low])))
            return f"{'cheaper' if b > 0 else 'dearer'} from about {float(f'{at:.2g}'):,.0f} on"
    return "level"


if __name__ == "__main__":
    main(__file__, __doc__, draw)
