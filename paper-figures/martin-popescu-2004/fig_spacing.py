"""Reflection morphing's three sizes: the sampling cell, the ray map, the octree's depth.

To be seen: Left, how far from their places vertices are drawn, by the size of the cell: the eye stands at a third of
every cell, along each axis. What eight places leave between them falls with the square of the cell, down to what a node
itself errs by; by the nearest ray of each it is lost in the rays' own spacing. In the middle and right, what finer maps and
deeper octrees take and give: bytes of a location, rays looked at for a vertex and location, and vertices that the mirror
shows and leaves do not find.

Claim: "a ray map resolution of 256 x 256, an octree depth of 5" (section 8); the paper states no cell and no error.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main
from mirrorfigures.cameras import camera
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.morphing import morphed
from mirrorfigures.ray_octrees import BUFFERS, dumped
from mirrorfigures.variants import changed

SIZE, VIEW, WIDE_AND_HIGH = "128x96", "1280x720", (1280, 720)
METHOD = "reflection-morphing:files=none"
CELLS, MAPS, DEPTHS = (0.25, 0.5, 1, 2), (64, 128, 256, 512), (3, 4, 5, 6, 7, 8)
RULES = {"the nearest ray": "ray", "between four rays": "bundle"}
EYE, AT_THIRDS = "eye = [0.0, 1.6, 4.0]", "eye = [0.66667, 1.33333, 4.66667]"


def draw(figure):
    scene = changed("columns", EYE, AT_THIRDS)
    view = camera(scene, 0, VIEW)

    def run(choices):
        one = morphed(scene, 0, SIZE, f"{METHOD},{choices}", BUFFERS)
        figure.cite(one.run)
        return one

    # As good as a node at the eye.
    exact = run("cell=0.01,point=bundle")

    def error(one):
        known = exact.within & one.within
        here, there = (view.place(which.images[known]) * WIDE_AND_HIGH for which in (one, exact))
        return float(np.linalg.norm(here - there, axis=-1).mean())

    def row(one):
        tree, counters = dumped(one.run), one.run.row["counters"]
        lost = 100 * (1 - one.valid[exact.within].mean())
        return [tree.bytes / 1e6, counters["rays"] / counters["look-ups"], tree.largest, lost, error(one)]

    errors = {name: [error(run(f"cell={cell},point={rule}")) for cell in CELLS] for name, rule in RULES.items()}
    maps = np.array([row(run(f"map={size}")) for size in MAPS])
    depths = np.array([row(run(f"depth={depth}")) for depth in DEPTHS])
    slope = float(np.polyfit(np.log(CELLS), np.log(errors["between four rays"]), 1)[0])
    figure.number("slope of the error between four rays over the cell", slope)
    figure.plot = charts(errors, maps, depths)
    header = ["MB a location", "rays a look-up", "largest leaf", "vertices lost, %", "mean error, px"]
    cells = [[f"{cell} m", *(f"{errors[name][i]:.3f}" for name in RULES)] for i, cell in enumerate(CELLS)]
    figure.table("Mean error, pixels of a view 720 high", ["cell", *RULES], cells)
    figure.table("The ray map, depth 5, cells of 0.5 m", ["map", *header], table(MAPS, maps))
    figure.table("The depth, map of 256, cells of 0.5 m", ["depth", *header], table(DEPTHS, depths))
    near, between = (errors[name] for name in RULES)
    figure.finding(
        f"Between four rays the error grows with the cell to the power of {slope:.2f}; by the nearest ray it is "
        f"{min(near):.1f} to {max(near):.1f} px whatever the cell, {between[1]:.3f} px between four in cells of 0.5 m. A map "
        f"of 512 takes {maps[3, 0] / maps[2, 0]:.1f} times the bytes of one of 256, errs by {maps[3, 4] / maps[2, 4]:.2f} of "
        f"its pixels and loses {maps[3, 3]:.1f} % of the vertices instead of {maps[2, 3]:.0f} %. At depth 8 a look-up sees "
        f"{depths[5, 1]:.1f} rays instead of {depths[2, 1]:.1f} at depth 5, and {depths[5, 3]:.0f} % of the vertices are lost."
    )


def table(sizes, rows):
    return [[str(size), *(f"{value:.2f}" for value in row)] for size, row in zip(sizes, rows, strict=True)]


def charts(errors, maps, depths) -> plt.Figure:
    plot, axes = plt.subplots(1, 3, figsize=(10, 3.9), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    for (name, values), colour, marker in zip(errors.items(), COLOURS, MARKERS, strict=False):
        axes[0].plot(CELLS, values, color=colour, marker=marker, ms=4, label=name)
    last = errors["between four rays"][-1]
    squares = [last * (cell / CELLS[-1]) ** 2 for cell in CELLS]
    axes[0].plot(CELLS, squares, color="#66707c", ls=":", label="square of the cell")
    axes[0].set(title="mean error, px at 720 lines", xlabel="cell, m")
    shown = {"MB a location": 0, "rays a look-up": 1, "vertices lost, %": 3, "mean error, px": 4}
    for axis, sizes, rows in ((axes[1], MAPS, maps), (axes[2], DEPTHS, depths)):
        for (name, column), colour, marker in zip(shown.items(), COLOURS, MARKERS, strict=False):
            axis.plot(sizes, rows[:, column], color=colour, marker=marker, ms=4, label=name)
    axes[1].set(title="depth 5", xlabel="ray map, texels a side")
    axes[2].set(title="ray map of 256 x 256", xlabel="depth of the octree")
    for axis, sizes, scale in zip(axes, (CELLS, MAPS, DEPTHS), ("log", "log", "linear"), strict=True):
        axis.set(xscale=scale, yscale="log")
        axis.set_xticks(sizes, [str(size) for size in sizes])
        axis.minorticks_off()
        axis.grid(color=GRID, lw=0.6)
        axis.legend(fontsize=7.5)
    return plot


if __name__ == "__main__":
    main(__file__, __doc__, draw)
