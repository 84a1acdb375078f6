"""Films for the page: the panels of a filmed run, cropped, enlarged and named."""

import numpy as np
from PIL import Image, ImageDraw, ImageSequence

from .figure import INK
from .runs import Run

CAPTION_PX = 16
GAP_PX = 4


def panels(run: Run, count: int) -> list[list[Image.Image]]:
    """For each picture of a filmed run, its panels from left to right."""
    with Image.open(run.files / "film.png") as film:
        pictures = [picture.convert("RGB") for picture in ImageSequence.Iterator(film)]
    width = pictures[0].width // count
    boxes = [(i * width, 0, (i + 1) * width, pictures[0].height) for i in range(count)]
    return [[picture.crop(box) for box in boxes] for picture in pictures]


def named(row: list[Image.Image], captions: list[str], box: tuple, scale: int) -> Image.Image:
    """The part of each panel inside `box` (left, top, right, bottom), enlarged, its name above it."""
    width, height = scale * (box[2] - box[0]), scale * (box[3] - box[1])
    whole = Image.new(
        "RGB", (len(row) * (width + GAP_PX) - GAP_PX, height + CAPTION_PX), "white"
    )
    for i, (panel, caption) in enumerate(zip(row, captions, strict=True)):
        left = i * (width + GAP_PX)
        ImageDraw.Draw(whole).text((left + 2, 2), caption, fill=INK)
        part = panel.crop(box).resize((width, height), Image.Resampling.NEAREST)
        whole.paste(part, (left, CAPTION_PX))
    return whole


def change(pictures: list[Image.Image]) -> np.ndarray:
    """Mean absolute change of the displayed values, 0 to 1, from each picture to the next."""
    values = np.stack([np.asarray(picture, np.float32) for picture in pictures]) / 255
    return np.abs(np.diff(values, axis=0)).mean(axis=(1, 2, 3))
