"""The plane of a mirrored ray and a z-buffered map's centre, drawn from a pixel and the map itself.

Vectors are relative to the map's centre; names are Patow's (1995, section 2).
"""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from .charts import COLOURS, GRID
from .exr import Frame, read_channels
from .figure import INK, QUIET, WARN

LIMIT_DEG = 1.0
"""The paper's tolerable limit."""

# Axis, direction to the right and down of each face: Vulkan's order, +X -X +Y -Y +Z -Z.
_FACES = np.array(
    [
        [(1, 0, 0), (0, 0, -1), (0, -1, 0)],
        [(-1, 0, 0), (0, 0, 1), (0, -1, 0)],
        [(0, 1, 0), (1, 0, 0), (0, 0, 1)],
        [(0, -1, 0), (1, 0, 0), (0, 0, -1)],
        [(0, 0, 1), (1, 0, 0), (0, -1, 0)],
        [(0, 0, -1), (-1, 0, 0), (0, -1, 0)],
    ],
    float,
)


@dataclass(frozen=True)
class Arc:
    """One mirrored ray, and what the map holds along the arc from B to W."""

    b: np.ndarray
    """Unit mirrored direction."""
    w: np.ndarray
    """Reflector point."""
    s: np.ndarray
    """The point the ray meets, by the truth."""
    points: np.ndarray
    """S' of every texel touched, from B's to W's: layers x texels x 3; NaN where a list has ended."""
    angles: np.ndarray
    """Degrees between B and S' - W: layers x texels."""
    places: np.ndarray
    """Degrees of each texel's direction from B, in the plane."""

    def in_plane(self, vectors: np.ndarray) -> np.ndarray:
        """Along [W] and across it, towards B; what is off the plane is dropped."""
        along = self.w / np.linalg.norm(self.w)
        across = self.b - (self.b @ along) * along
        return np.stack([vectors @ along, vectors @ (across / np.linalg.norm(across))], axis=-1)

    def best(self, layer: int) -> int:
        """The texel of a layer's best predictor."""
        return int(np.nanargmin(self.angles[layer]))


def depth_layers(dump: Path) -> np.ndarray:
    """1/z of a dumped layered map, layers x 6 x size x size; 0 where nothing is."""
    channels = read_channels(dump)
    faces = [channels[f"face{i}.R"] for i in range(len([n for n in channels if n.endswith(".R")]))]
    words = np.ascontiguousarray(np.stack(faces), np.uint32)
    return words.view(np.float32).reshape(-1, 6, *words.shape[1:])


def arc_of(truth: Frame, pixel: tuple[int, int], layers: np.ndarray, centre: np.ndarray) -> Arc:
    """The arc of one pixel of the truth that shows a surface."""
    w, s = truth.position[pixel] - centre, truth.point[pixel] - centre
    b = (s - w) / np.linalg.norm(s - w)
    face, row, column = _touched(b, w, layers.shape[-1])
    size = layers.shape[-1]
    axis, right, down = np.moveaxis(_FACES[face], 1, 0)
    across, below = (2 * (column + 0.5) / size - 1)[:, None], (2 * (row + 0.5) / size - 1)[:, None]
    p = axis + across * right + below * down
    inverse = layers[:, face, row, column].astype(float)
    inverse[inverse == 0] = np.nan
    points = p / inverse[..., None]
    towards = points - w
    cosine = (towards @ b) / np.linalg.norm(towards, axis=-1)
    angles = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    plane = Arc(b, w, s, points, angles, np.empty(0))
    flat, start = plane.in_plane(p), plane.in_plane(b)
    turn = np.degrees(np.arctan2(flat[:, 1], flat[:, 0]) - np.arctan2(start[1], start[0]))
    return Arc(b, w, s, points, angles, -turn)


def _touched(b: np.ndarray, w: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Face, row and column of each texel the arc touches, in order from B to W."""
    t = np.linspace(0, 1, 40 * size)[:, None]
    d = (1 - t) * b + t * w / np.linalg.norm(w)
    face = 2 * np.abs(d).argmax(axis=1)
    face += np.take_along_axis(d, face[:, None] // 2, axis=1)[:, 0] < 0
    axis, right, down = np.moveaxis(_FACES[face], 1, 0)
    major = (d * axis).sum(1)
    column, row = (
        np.clip((0.5 + 0.5 * (d * v).sum(1) / major) * size, 0, size - 1).astype(int)
        for v in (right, down)
    )
    cells = np.stack([face, row, column], axis=1)
    first = np.concatenate([[True], (np.diff(cells, axis=0) != 0).any(axis=1)])
    return tuple(cells[first].T)


def draw_arc(arc: Arc, labels: list[str]) -> plt.Figure:
    """Left: the plane. Right: expression (2) along the arc. One colour a layer."""
    plot, (plane, chart) = plt.subplots(
        1, 2, figsize=(9.6, 4.4), layout="constrained", width_ratios=(1.15, 1)
    )
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    for layer, (points, angles, label) in enumerate(
        zip(arc.points, arc.angles, labels, strict=True)
    ):
        colour = COLOURS[layer]
        plane.plot(*arc.in_plane(points).T, ".", ms=3, color=colour, label=label)
        chart.plot(arc.places, angles, ".", ms=3, color=colour, label=label)
        if np.isfinite(angles).any():
            best = arc.best(layer)
            chart.plot(arc.places[best], angles[best], "o", mfc="none", ms=9, color=colour)
    _vectors(plane, arc)
    plane.set(aspect="equal", xlabel="along [W], metres", ylabel="across it, metres")
    plane.set_title("the reflection plane")
    plane.margins(0.1)
    plane.legend(fontsize=7.5, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
    chart.axhline(LIMIT_DEG, color=WARN, lw=1, ls="--")
    chart.text(0, LIMIT_DEG * 1.1, " tolerable limit", color=WARN, fontsize=7.5, va="bottom")
    chart.set(
        yscale="log",
        xlabel="texels along the arc, degrees from B (t = 0) to W (t = 1)",
        ylabel="angle between B and S' − W, degrees",
    )
    chart.set_title("expression (2) of every texel touched")
    chart.grid(color=GRID, lw=0.6)
    return plot


def _vectors(axis: plt.Axes, arc: Arc) -> None:
    w, s, b = (arc.in_plane(v) for v in (arc.w, arc.s, arc.b))
    reach = np.linalg.norm(w)
    turn = np.linspace(np.arctan2(b[1], b[0]), 0, 100)
    axis.plot(0.5 * reach * np.cos(turn), 0.5 * reach * np.sin(turn), color=QUIET, lw=0.8)
    axis.plot(*zip(w, s, strict=True), color=INK, lw=1)
    arrows = {"B": (np.zeros(2), 0.9 * reach * b), "W": (np.zeros(2), w), "S": (np.zeros(2), s)}
    for name, (tail, head) in arrows.items():
        faint = {"alpha": 0.45} if name == "S" else {}
        beside = (-6, -14) if name == "W" else (4, 4)
        axis.annotate("", head, tail, arrowprops={"arrowstyle": "->", "color": INK, "lw": 1, **faint})
        axis.annotate(name, head, xytext=beside, textcoords="offset points", weight="bold")
    axis.annotate(
        "", w + 0.9 * reach * b, w, arrowprops={"arrowstyle": "->", "color": INK, "lw": 1.4}
    )
    axis.plot(0, 0, "o", color=INK, ms=4)
    axis.annotate("centre", (0, 0), xytext=(-4, -12), textcoords="offset points", fontsize=7.5)


def middle_pixel(mask: np.ndarray) -> tuple[int, int]:
    """The pixel of a mask nearest to the mean of all."""
    places = np.argwhere(mask)
    if len(places) == 0:
        raise FileNotFoundError("no pixel shows what the figure is about")
    nearest = ((places - places.mean(axis=0)) ** 2).sum(axis=1).argmin()
    return tuple(int(i) for i in places[nearest])
