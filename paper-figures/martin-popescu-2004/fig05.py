"""Martin & Popescu 2004, Figure 5: vertex morphing, from a run.

To be seen: Left, the sampling cell round the eye C (wireframe): each of its eight corners sees the vertex V at a
point of the mirror of its own, found in the corner's ray octree. Right, these eight points on the mirror, as large
as their weights, and where the eye sees V: by interpolation, and by a sphere's closed form. Points are those of
rays, which lie a third of a degree apart; without that error the interpolated point would be better.

Claim: "Each vertex is projected onto the 8 sampling locations using the ray octrees, and then the resulting 8
projection points are trilinearly interpolated to find the final projection point" (1.2). "In Figure 5 the wireframe
box shows the current sampling cell" (6).
"""

import itertools

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.morphing import CELL_M, locations, morphed, weights
from mirrorfigures.reflection_search import sphere_root, unit

SCENE, SIZE, FRAME = "columns", "640x360", 12
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
POINT = (0.5472, 2.0, 1.5035)


def draw(figure):
    drawn = morphed(SCENE, FRAME, SIZE)
    figure.cite(drawn.run)
    vertex = drawn.nearest(POINT)
    v, seen, p = drawn.vertices[vertex], drawn.points[:, vertex], drawn.reflected_at(vertex)
    roots = np.stack([sphere_root(CENTRE, RADIUS, corner, v) for corner in locations(drawn.eye)])
    root = sphere_root(CENTRE, RADIUS, drawn.eye, v)
    plot = plt.figure(figsize=(9.6, 4.4), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    draw_space(plot.add_subplot(1, 2, 1, projection="3d"), drawn.eye, v, seen)
    draw_points(plot.add_subplot(1, 2, 2), drawn.eye, seen, p, root)
    figure.plot = plot
    rays_mm = 1000 * np.linalg.norm(seen - roots, axis=1)
    apart_mm = 1000 * float(np.linalg.norm(p - root))
    ideal_mm = 1000 * float(np.linalg.norm(weights(drawn.eye) @ roots - root))
    figure.number("eight points from the closed form, mm", rays_mm.tolist())
    figure.finding(
        f"The eight points lie {rays_mm.min():.1f} to {rays_mm.max():.1f} mm from where these locations would see V, "
        f"the interpolated one {apart_mm:.1f} mm from where the eye sees it; interpolated between exact points it "
        f"would lie {ideal_mm:.1f} mm off, inside the mirror."
    )


def draw_space(axis, eye, v, seen):
    turn, tilt = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, np.pi, 13))
    ball = np.stack([np.sin(tilt) * np.sin(turn), np.cos(tilt), np.sin(tilt) * np.cos(turn)], -1)
    plotted = lambda points: np.moveaxis(np.asarray(points)[..., [0, 2, 1]], -1, 0)  # noqa: E731 (y is up)
    axis.plot_wireframe(*plotted(CENTRE + RADIUS * ball), color=QUIET, lw=0.3)
    corners = locations(eye)
    for a, b in itertools.combinations(corners, 2):
        if np.isclose(np.linalg.norm(a - b), CELL_M):
            axis.plot(*plotted([a, b]), color=INK, lw=1)
    for corner, point in zip(corners, seen, strict=True):
        axis.plot(*plotted([corner, point, v]), color=COLOURS[0], lw=0.7)
    for name, point in (("C", eye), ("V", v)):
        axis.plot(*plotted([point]), "o", color=COLOURS[1], ms=5)
        axis.text(*plotted(point), f"  {name}", weight="bold")
    axis.set(xlim=(-1, 2), ylim=(-1, 4), zlim=(0, 2.5))
    axis.set_box_aspect((3, 5, 2.5))
    axis.view_init(22, -28)
    axis.set(xlabel="x, metres", ylabel="z", zlabel="")
    axis.tick_params(labelsize=6)
    axis.set_title("the cell, and where its corners see V")


def draw_points(axis, eye, seen, p, root):
    """On the mirror's tangent plane where the eye sees the vertex."""
    normal = unit(root - CENTRE)
    right = unit(np.cross((0, 1, 0), normal))
    up = np.cross(normal, right)
    flat = lambda points: 1000 * np.stack([(points - root) @ right, (points - root) @ up], -1)  # noqa: E731
    at = flat(seen)
    axis.scatter(*at.T, s=12 + 400 * weights(eye), color=COLOURS[0], alpha=0.6, label="of the eight locations")
    axis.plot(*flat(p), "P", color=COLOURS[1], ms=9, label="interpolated")
    axis.plot(0, 0, "x", color=INK, ms=8, mew=2, label="closed form at the eye")
    axis.set(aspect="equal", xlabel="across, mm", ylabel="up, mm", title="their points on the mirror")
    axis.grid(color=GRID, lw=0.6)
    axis.legend(fontsize=8, loc="best")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
