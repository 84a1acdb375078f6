"""Pictures for paper and page: tone mapping, error maps, crops."""

from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image

ERROR_FULL_SCALE = 0.5
"""Colour error drawn brightest; fixed, so that heat maps compare across figures."""


def to_srgb(linear: np.ndarray, exposure_stops: float = 0.0) -> np.ndarray:
    """Linear to display values in [0, 1]: fixed exposure, clip, sRGB curve (IEC 61966-2-1)."""
    x = np.clip(np.nan_to_num(linear) * 2.0**exposure_stops, 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(x, 1 / 2.4) - 0.055)


def colour_error(ours: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Mean absolute difference of the displayed values, per pixel, in [0, 1]."""
    return np.abs(to_srgb(ours) - to_srgb(truth)).mean(axis=-1)


def heat(error: np.ndarray, mask: np.ndarray | None = None) -> np.ndarray:
    """Magma colours of an error map; grey outside the mask."""
    colours = matplotlib.colormaps["magma"](np.clip(error / ERROR_FULL_SCALE, 0, 1))[..., :3]
    return colours if mask is None else np.where(mask[..., None], colours, 0.82)


def to_image(display: np.ndarray) -> Image.Image:
    """Display values in [0, 1] as an 8-bit picture."""
    return Image.fromarray((np.clip(display, 0, 1) * 255 + 0.5).astype(np.uint8))


def box_around(mask: np.ndarray) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of the mask's true pixels."""
    ys, xs = np.nonzero(mask)
    if len(xs) == 0:
        raise ValueError("nothing in the mask to crop around")
    return int(xs.min()), int(ys.min()), int(xs.max()) + 1, int(ys.max()) + 1


def worst_boxes(error: np.ndarray, mask: np.ndarray, side: int, count: int) -> list[tuple]:
    """The squares with the largest summed error inside the mask, not overlapping."""
    remaining = np.where(mask, error, 0.0).astype(np.float64)
    boxes = []
    for _ in range(count):
        sums = np.pad(remaining.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
        windows = sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]
        top, left = np.unravel_index(np.argmax(windows), windows.shape)
        boxes.append((int(left), int(top), int(left) + side, int(top) + side))
        remaining[top : top + side, left : left + side] = 0.0
    return boxes


def write_film(pictures: list[Image.Image], file: Path, rate_hz: float) -> None:
    """An animated PNG that goes round for ever."""
    first, *others = pictures
    first.save(
        file, save_all=True, append_images=others, duration=round(1000 / rate_hz), loop=0, format="PNG"
    )
