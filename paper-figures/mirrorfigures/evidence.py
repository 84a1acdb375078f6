"""What frames say about objects: which are seen, and how far from their place they are drawn.

The binary judges whole frames; some figures ask about one object, which the layers answer.
"""

import numpy as np

from .exr import Frame

ENOUGH_PIXELS = 4
"""An object counts as visible from this many pixels on."""


def object_ids(row: dict) -> dict[str, int]:
    """Ids by name: the row lists the scene's objects in the order of their ids."""
    return {name: i for i, name in enumerate(row["scene"]["objects"])}


def seen_in_mirrors(frame: Frame, objects: dict[str, int]) -> set[str]:
    """The objects a mirror of the frame shows."""
    return {name for name, i in objects.items() if frame.shows(i).sum() >= ENOUGH_PIXELS}


def seen_directly(frame: Frame, objects: dict[str, int]) -> set[str]:
    """The objects seen without a mirror."""
    direct = frame.direct_object[~frame.mirror]
    return {name for name, i in objects.items() if (direct == i).sum() >= ENOUGH_PIXELS}


def displacement(ours: Frame, truth: Frame, object_id: int, samples: int = 500) -> tuple:
    """How far ours draws an object's points from where the truth does.

    For about `samples` pixels of ours that show the object, evenly spread: the distance in pixels to
    the pixel in which the truth shows the nearest point of it, if that is the same point to within
    the spacing of the truth's own points; else the truth does not see it. Good to half a pixel.

    Returns (displacement in pixels, the points shown, n x 3, metres), of equal length.
    """
    targets = truth.shows(object_id)
    if not targets.any() or not ours.shows(object_id).any():
        return np.empty(0), np.empty((0, 3))
    target_pixels, target_points = _pixels_points(truth, targets)
    pixels, points = _pixels_points(ours, ours.shows(object_id))
    step = -(-len(points) // samples)
    pixels, points = pixels[::step], points[::step]
    spacing = _spacing(truth, targets)
    nearest = np.empty(len(points), np.int64)
    squared = np.empty(len(points))
    for start in range(0, len(points), 32):  # blocks, so that the table of distances stays small
        block = slice(start, start + 32)
        table = ((points[block, None, :] - target_points[None, :, :]) ** 2).sum(-1)
        nearest[block] = table.argmin(axis=1)
        squared[block] = table.min(axis=1)
    met = squared <= (1.5 * spacing[nearest]) ** 2
    moved = np.linalg.norm(pixels - target_pixels[nearest], axis=1)
    return moved[met], points[met]


def _pixels_points(frame: Frame, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    ys, xs = np.nonzero(mask)
    return np.stack([xs, ys], axis=1).astype(np.float64), frame.point[mask].astype(np.float64)


def _spacing(frame: Frame, mask: np.ndarray) -> np.ndarray:
    """Per true pixel: distance to the point the pixel to the right, left, below or above shows,
    the largest of those on the same object."""
    result = np.zeros(mask.shape)
    for axis in (0, 1):
        apart = np.linalg.norm(np.diff(frame.point, axis=axis), axis=-1)
        here, beside = ((slice(None),) * axis + (part,) for part in (slice(-1), slice(1, None)))
        apart *= mask[here] & mask[beside]
        for part in (here, beside):
            result[part] = np.maximum(result[part], apart)
    return result[mask]


def distance_to_mirror(frame: Frame) -> float:
    """Metres from the camera to the nearest point of a mirror, along the view direction."""
    return float(frame.depth[frame.mirror].min())


