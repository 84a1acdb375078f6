"""The search for reflection points of Estalella et al. 2006, section 4, walked again on the textures
that the method drew, so that figures can show its steps.

Vertices are n x 3, metres; texels are n x 2, integers, across and down.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .exr import read_channels

CROSSHAIR = np.array([(1, 0), (-1, 0), (0, 1), (0, -1)])
"""The neighbours looked at, in the shader's order: the first of two equals wins."""

OUTSIDE = -2.0
"""Below every N.B: no texel of the reflector."""

GUARD = 100_000
"""More steps than any texture allows."""


@dataclass(frozen=True)
class Textures:
    """T_P and T_N: a reflector's points and unit normals as the eye sees them, rows x columns x 3."""

    points: np.ndarray
    normals: np.ndarray
    mask: np.ndarray
    """True where the reflector is."""
    eye: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """Columns and rows."""
        return np.array(self.mask.shape[::-1])

    def at(self, texels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points and normals."""
        x, y = np.asarray(texels).T
        return self.points[y, x], self.normals[y, x]

    def within(self, mask: np.ndarray) -> "Textures":
        """The same of a part of the reflector."""
        return replace(self, mask=self.mask & mask)

    def quality(self, texels: np.ndarray, vertices: np.ndarray, inverse: bool = False) -> np.ndarray:
        """N.B of each vertex at its texel. Inverse: for the vertex that is reflected into it there."""
        x, y = np.clip(texels, 0, self.size - 1).T
        inside = self.mask[y, x] & (texels >= 0).all(-1) & (texels < self.size).all(-1)
        p, n = self.points[y, x], self.normals[y, x]
        seen = mirrored(vertices, p, n) if inverse else vertices
        return np.where(inside, (n * bisector(p, self.eye, seen)).sum(-1), OUTSIDE)


def textures(run, eye: np.ndarray) -> Textures:
    """What a run of `virtual-objects` on a scene of one reflector dumped of its pass `gbuffer`."""
    folder = Path(run.files) / "dump" / "virtual-objects" / "gbuffer"
    points, normals = (read_channels(folder / f"{name}.exr") for name in ("position", "normal"))
    p, n = (np.stack([image[c] for c in "RGB"], -1).astype(float) for image in (points, normals))
    return Textures(p, n, points["A"] == 1.0, np.asarray(eye, float))


def unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0)


def bisector(points: np.ndarray, eye: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """B: between the directions to the eye and to the vertex."""
    return unit(unit(eye - points) + unit(vertices - points))


def mirrored(vertices: np.ndarray, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """V' of V in the plane at a point: equation 1 with the sign its text means."""
    return vertices - 2.0 * ((vertices - points) * normals).sum(-1, keepdims=True) * normals


def search(
    textures: Textures, vertices: np.ndarray, start: np.ndarray, inverse: bool = False
) -> list[np.ndarray]:
    """The texels of all searches after each step, the start first: uphill in N.B by the crosshair until
    its centre is the best. `start`: one texel, or one for each vertex."""
    vertices = np.atleast_2d(np.asarray(vertices, float))
    at = np.broadcast_to(start, (len(vertices), 2)).copy()
    best = textures.quality(at, vertices, inverse)
    steps = [at.copy()]
    for _ in range(GUARD):
        centre = at.copy()
        for neighbour in CROSSHAIR:
            there = centre + neighbour
            quality = textures.quality(there, vertices, inverse)
            better = quality > best
            best = np.where(better, quality, best)
            at = np.where(better[:, None], there, at)
        if (at == centre).all():
            return steps
        steps.append(at.copy())
    raise RuntimeError("a search went round in circles")


def is_hidden(textures: Textures, texels: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Section 5.1: the vertex is behind the plane at the texel its search ended on."""
    p, n = textures.at(texels)
    return ((vertices - p) * n).sum(-1) < 0


def middle(mask: np.ndarray) -> np.ndarray:
    """The texel of a mask nearest to the middle of its bounding box."""
    places = np.argwhere(mask)[:, ::-1]
    centre = (places.min(axis=0) + places.max(axis=0)) / 2
    return places[((places - centre) ** 2).sum(-1).argmin()]


def sphere_root(centre, radius: float, eye, vertices) -> np.ndarray:
    """The points of a sphere that reflect outside vertices to the eye: Alhazen's, by bisection."""
    centre, eye, vertices = (np.asarray(v, float) for v in (centre, eye, vertices))
    u = unit(eye - centre)
    along = (vertices - centre) @ u
    across = vertices - centre - along[..., None] * u
    w = unit(across)
    low, high = np.zeros_like(along), np.arctan2(np.linalg.norm(across, axis=-1), along)
    for _ in range(60):
        angle = ((low + high) / 2)[..., None]
        tangent = np.cos(angle) * w - np.sin(angle) * u
        p = centre + radius * (np.cos(angle) * u + np.sin(angle) * w)
        # B leans towards the vertex before the root, towards the eye beyond it.
        beyond = ((unit(eye - p) + unit(vertices - p)) * tangent).sum(-1) < 0
        low, high = np.where(beyond, low, angle[..., 0]), np.where(beyond, angle[..., 0], high)
    return p
