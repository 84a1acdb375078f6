"""Simplified rotated depth maps (Popescu et al. 2006, slides 36 to 38), made again from a depth image that
the method drew, so that figures can show their steps. As src/geometry/depth_rows, plainly.

Places are (across, down) in texels; heights are metres above the farthest thing shown, NaN where nothing is.
"""

from pathlib import Path

import numpy as np

from .exr import read_channels
from .runs import Run

DUMP = "depth-impostors/portrait"

STEEPEST = 10.0
"""Texels a surface may fall per texel across before a silhouette is between two."""


def depth_image(run: Run, layer: int) -> np.ndarray:
    """A layer's heights, square; taken under parallel rays, so that heights are metres."""
    channels = read_channels(Path(run.files) / "dump" / DUMP / "point.exr")
    albedo = read_channels(Path(run.files) / "dump" / DUMP / "albedo.exr")
    heights = channels[f"face{layer}.A"].astype(np.float64)
    heights[albedo[f"face{layer}.A"] == 0] = np.nan
    return heights - np.nanmin(heights)


def along(heights: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Heights of the texels at places; NaN outside."""
    texels = np.floor(places).astype(int)
    inside = ((texels >= 0) & (texels < len(heights))).all(-1)
    x, y = np.where(inside[..., None], texels, 0).T
    return np.where(inside.T, heights[y, x], np.nan).T


def rotated(heights: np.ndarray, angle: float) -> np.ndarray:
    """The depth image turned, so that lines at `angle` become rows; the nearest texel's heights."""
    size = len(heights)
    x = np.arange(size) + 0.5 - size / 2
    unit, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    return along(heights, size / 2 + x[None, :, None] * unit + x[:, None, None] * across)


def simplify(row: np.ndarray, most: int, texel: float) -> list[tuple]:
    """A row as at most so many segments ((x, height), (x, height)); `texel` is a texel's width, metres."""
    pieces = _runs(row, STEEPEST * texel)
    while len(pieces) < most:
        errors = [_error(row, *piece) for piece in pieces]
        largest = max((error for error, _ in errors), default=0.0)
        if largest <= 0.25 * texel:
            break
        split = []
        room = most - len(pieces)
        for piece, (error, worst) in zip(pieces, errors, strict=True):
            if 2 * error >= largest and room > 0:
                split += [(piece[0], worst), (worst, piece[1])]
                room -= 1
            else:
                split.append(piece)
        pieces = split
    return [((a + 0.5, row[a]), (b + 0.5, row[b])) for a, b in pieces]


def _runs(row, jump):
    there = np.flatnonzero(~np.isnan(row))
    if not len(there):
        return []
    parted = (np.diff(there) > 1) | (np.abs(np.diff(row[there])) > jump)
    ends = np.flatnonzero(parted)
    return list(zip(there[np.r_[0, ends + 1]], there[np.r_[ends, len(there) - 1]], strict=True))


def _error(row, first, last):
    """The largest error of the segment over a piece, and where."""
    if last - first < 2:
        return 0.0, first
    line = np.linspace(row[first], row[last], last - first + 1)
    off = np.abs(row[first : last + 1] - line)
    return off.max(), first + int(off.argmax())
