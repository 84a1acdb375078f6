"""Plans: coordinates in a plane, for diagrams of points in space."""

import numpy as np


class Plane:
    """Coordinates in the plane of three points, about the first: along the way to the second, and across it
    towards the third. Metres."""

    def __init__(self, origin: np.ndarray, along: np.ndarray, towards: np.ndarray):
        self.origin = np.asarray(origin, float)
        self.along = _unit(along - self.origin)
        across = towards - self.origin
        self.across = _unit(across - across @ self.along * self.along)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Of points, ... x 3."""
        return self.turn(np.asarray(points) - self.origin)

    def turn(self, vectors: np.ndarray) -> np.ndarray:
        """Of vectors, ... x 3."""
        return np.stack([vectors @ self.along, vectors @ self.across], -1)

    def away(self, points: np.ndarray) -> np.ndarray:
        """How far points lie from it."""
        return np.abs((np.asarray(points) - self.origin) @ np.cross(self.along, self.across))


def circle(axis, radius: float, centre=(0.0, 0.0), **style) -> None:
    """A circle, thin unless told otherwise."""
    turn = np.linspace(0, 2 * np.pi, 361)
    axis.plot(centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn), **{"lw": 0.8, **style})


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)
