"""Vertices as a run of `reflection-morphing` morphed them (Martin & Popescu 2004, section 6), and the rays of a
camera and spheres taken together (section 1.2), for the paper's diagrams.

Points are n x 3, metres.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .cameras import camera
from .runs import Run, render

CELL_M = 0.5
"""The method's distance between sampling locations (`cell`)."""

_MORPH, _REFLECTED = "reflection-morphing/morph", "reflection-morphing/reflected"
_BUFFERS = ((_MORPH, "corners"), (_MORPH, "points"), (_REFLECTED, "source_indices"))
CASE = "reflection-morphing"
"""Its case, where none is named."""


@dataclass(frozen=True)
class Morphed:
    """The scene's vertices, its meshes cut as the method cuts them, and one mirror's reflections of them."""

    run: Run
    eye: np.ndarray
    vertices: np.ndarray
    images: np.ndarray
    """Where they are drawn."""
    valid: np.ndarray
    """True where all eight locations see them."""
    within: np.ndarray
    """True where all eight see them between rays, or by one; not beyond the last."""
    points: np.ndarray
    """8 x n x 3: where on the mirror each sampling location sees them."""
    triangles: np.ndarray
    """m x 3 places of vertices."""

    def nearest(self, point) -> int:
        """The valid vertex nearest to a point."""
        apart = np.linalg.norm(self.vertices - point, axis=1)
        return int(np.where(self.valid, apart, np.inf).argmin())

    def reflected_at(self, vertex: int) -> np.ndarray:
        """The point of the mirror it is pushed from: the eight, interpolated at the eye."""
        return weights(self.eye) @ self.points[:, vertex]


def morphed(scene: str, frame: int, size: str, case: str = CASE, dump: tuple[str, ...] = ()) -> Morphed:
    """A frame of a scene of one mirror, by a case with nodes on a grid; the run has dumped `dump`, too."""
    wanted = (*(":".join(one) for one in _BUFFERS), *dump)
    run = render(scene, case, frame=frame, size=size, dump=wanted)
    corners, points, triangles = (
        np.load(Path(run.files) / "dump" / name / f"{variable}.npy") for name, variable in _BUFFERS
    )
    corners = corners.reshape(-1, 8).view(np.float32)
    points = points.view(np.float32).reshape(8, -1, 4)
    eye = camera(scene, frame, size).eye
    seen, within = (points[:, :, 3] != 0).all(0), (points[:, :, 3] > 0).all(0)
    places, images = corners[:, :3], corners[:, 4:7]
    return Morphed(run, eye, places, images, seen, within, points[:, :, :3], triangles.reshape(-1, 3))


def locations(eye: np.ndarray) -> np.ndarray:
    """The eight sampling locations round an eye, in the order of the method's slots: a node keeps its slot in
    every cell it is a corner of."""
    return CELL_M * (_base(eye) + _steps(eye))


def weights(eye: np.ndarray) -> np.ndarray:
    """Of the eight locations, in their order."""
    inside = eye / CELL_M - _base(eye)
    return np.where(_steps(eye) == 1, inside, 1 - inside).prod(-1)


def _base(eye: np.ndarray) -> np.ndarray:
    return np.floor(eye / CELL_M)


def _steps(eye: np.ndarray) -> np.ndarray:
    odd = np.array([(slot & 1, slot >> 1 & 1, slot >> 2 & 1) for slot in range(8)])
    return (odd - _base(eye).astype(int)) % 2


@dataclass(frozen=True)
class Ray:
    """A segment of the generalised camera's list of rays."""

    start: np.ndarray
    end: np.ndarray
    trace: tuple[int, ...]
    """The spheres met before it, in order."""


def generalised_rays(eye: np.ndarray, ways: np.ndarray, spheres, radius: float, box, order: int) -> list[Ray]:
    """Segments of rays from an eye in unit directions, mirrored by spheres about these centres up to `order`
    times and clipped by a box (low, high)."""
    rays = []
    centres = np.array(spheres, float)
    for way in ways:
        start, trace = eye, ()
        while True:
            hit, away = _first_sphere(start, way, centres, radius)
            end = start + (away if hit is not None else _to_box(start, way, box)) * way
            rays.append(Ray(start, end, trace))
            if hit is None or len(trace) == order:
                break
            normal = (end - centres[hit]) / radius
            start, way, trace = end, way - 2 * (way @ normal) * normal, (*trace, hit)
    return rays


def _first_sphere(start, way, centres, radius):
    """Which sphere a ray meets first, and how far off; the first is None where it meets none."""
    towards = start - centres
    b = towards @ way
    under = b * b - (towards**2).sum(-1) + radius**2
    away = np.where(under > 0, -b - np.sqrt(np.maximum(under, 0)), np.inf)
    away = np.where(away > 1e-6, away, np.inf)
    nearest = int(away.argmin())
    return (nearest, away[nearest]) if np.isfinite(away[nearest]) else (None, np.inf)


def _to_box(start, way, box) -> float:
    """How far a ray goes inside a box, which it starts in."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = [np.where(way == 0, np.inf, (side - start) / way) for side in box]
    return float(np.nanmin(np.maximum(*ends)))


def nearest_ray(rays: list[Ray], trace: tuple[int, ...], point: np.ndarray) -> Ray:
    """Of those with this trace."""
    return min((ray for ray in rays if ray.trace == trace), key=lambda ray: distance(ray, point))


def distance(ray: Ray, point: np.ndarray) -> float:
    """From a point to a segment."""
    along = ray.end - ray.start
    t = np.clip((point - ray.start) @ along / (along @ along), 0, 1)
    return float(np.linalg.norm(point - ray.start - t * along))
