"""Estalella et al. 2006, Figure 5: the widened frustum, computed from the textures of two runs.

To be seen: Left, a plan: the camera has turned so far that the sphere is partly out of view. Points of the
mirror at its middle height that the view's textures hold, and those that only textures 1.2 times as wide add;
lines are the edges of the two frusta at that height.
Right, these textures, and where the searches for points of the columns end: orange, at the border of the
texture, which stopped them; the frame is the view.

Claim: "The modified frustum has a larger field of view and captures more of the reflector"; without it
"vertices that should be reflected in the hidden part of the reflector will have a reflection point on the border".
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

from mirrorfigures import main, render
from mirrorfigures.cameras import camera, description
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.plans import circle
from mirrorfigures.reflection_search import bisector, is_hidden, middle, search, textures

SCENE, SIZE, FRAME = "columns-turn", "320x180", 48
WIDENINGS = (1.0, 1.2)
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
TEXELS = 320  # across the view; wider textures have more, so that a texel shows as much
SLAB_M = 0.02  # of points at the middle height
REACHED_DEG = 3.0  # a search that ends with N so near to B was not stopped


def draw(figure):
    view = camera(SCENE, FRAME, SIZE)
    vertices = column_points()
    plot, axes = plt.subplot_mosaic(
        [["plan", "1.0"], ["plan", "1.2"]], figsize=(9.6, 4.6), layout="constrained", width_ratios=(1.15, 1)
    )
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    drawn, stopped = [], []
    for widening in WIDENINGS:
        case = f"virtual-objects:widening={widening:g},texture={round(widening * TEXELS)}"
        run = render(SCENE, case, frame=FRAME, size=SIZE, dump="virtual-objects/gbuffer")
        figure.cite(run)
        drawn.append(textures(run, view.eye))
        stopped.append(draw_texture(axes[f"{widening:.1f}"], drawn[-1], vertices, widening))
    draw_plan(axes["plan"], view, drawn)
    figure.plot = plot
    figure.number("searches of the columns' points, stopped at the border", [len(vertices), *stopped])
    figure.finding(
        f"Of {len(vertices)} points of the columns, {stopped[0]} searches are stopped at the border of the view, "
        f"and {stopped[1]} at that of the wider textures. Those still lack the rest of the sphere, but where "
        "they end, and with them the stretched triangles, is out of view."
    )


def column_points() -> np.ndarray:
    """Points of the columns a quarter of a metre apart, as `subdivide` puts vertices."""
    columns = [o for o in description(SCENE)["objects"] if o["name"].startswith("column")]
    turn = np.arange(0, 2 * np.pi, np.pi / 24)
    ring = [(np.cos(a), h, np.sin(a)) for h in np.arange(-1.5, 1.6, 0.25) for a in turn]
    radius = columns[0]["shape"]["cylinder"]["radius"]
    return np.concatenate([np.array(c["position"]) + np.array(ring) * (radius, 1, radius) for c in columns])


def draw_texture(axis, drawn, vertices: np.ndarray, widening: float) -> int:
    """Returns how many searches the texture's border stopped."""
    found = search(drawn, vertices, middle(drawn.mask))[-1]
    p, n = drawn.at(found)
    cosine = (n * bisector(p, drawn.eye, vertices)).sum(-1)
    border = ((found == 0) | (found == drawn.size - 1)).any(-1)
    stopped = border & (cosine < np.cos(np.radians(REACHED_DEG))) & ~is_hidden(drawn, found, vertices)
    axis.imshow(np.where(drawn.mask[..., None], 0.75 + 0.25 * drawn.normals, 1.0), interpolation="nearest")
    axis.plot(*found[~stopped].T, ".", color=COLOURS[0], ms=1.5)
    axis.plot(*found[stopped].T, "o", color=COLOURS[1], ms=3.5, clip_on=False)
    width, height = drawn.size
    corner = (1 - 1 / widening) / 2 * drawn.size - 0.5
    axis.add_patch(Rectangle(corner, width / widening, height / widening, fill=False, ec=INK, lw=1))
    axis.set(xticks=[], yticks=[], title=f"widening {widening:g}: {stopped.sum()} searches stopped")
    return int(stopped.sum())


def draw_plan(axis, view, drawn):
    circle(axis, RADIUS, CENTRE[[0, 2]], color=QUIET)
    for k in (1, 0):  # the view's over the wider ones'
        points = drawn[k].points[drawn[k].mask]
        points = points[np.abs(points[:, 1] - CENTRE[1]) < SLAB_M]
        label = "view" if k == 0 else f"{WIDENINGS[k]:g} times as wide"
        axis.plot(points[:, 0], points[:, 2], ".", color=COLOURS[k], ms=5, label=label)
        for side in (-1, 1):
            edge = frustum_edge(view.widened(WIDENINGS[k]), side)
            axis.plot(edge[:, 0], edge[:, 2], color=COLOURS[k], lw=1)
    axis.plot(view.eye[0], view.eye[2], "o", color=INK, ms=4)
    axis.annotate("O", view.eye[[0, 2]], xytext=(6, -4), textcoords="offset points", weight="bold")
    axis.annotate("ρ", CENTRE[[0, 2]], ha="center")
    axis.set(aspect="equal", xlim=(-2.6, 1.8), ylim=(2.9, -1.3), xlabel="x, metres", ylabel="z, metres")
    axis.grid(color=GRID, lw=0.6)
    axis.set_title("from above")
    axis.legend(fontsize=8, loc="upper left", title="texels of")


def frustum_edge(view, side: int) -> np.ndarray:
    """Where the frustum's left (-1) or right (1) face cuts the plane of the mirror's middle height."""
    away = np.linspace(0.05, 5.0, 300)[:, None]
    ray = view.forward + side * view.half_width * view.right
    up = ((CENTRE[1] - view.eye[1]) / away - ray[1]) / view.up[1]
    points = view.eye + away * (ray + up * view.up)
    return points[np.abs(up[:, 0]) < view.half_height]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
