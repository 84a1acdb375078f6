"""Films: a run's panels taken apart, put together again under names, and written."""

import numpy as np
import pytest
from PIL import Image

from mirrorfigures import film, images
from mirrorfigures.films import CAPTION_PX, GAP_PX, change, named, panels


def test_a_film_has_a_picture_a_frame_and_a_panel_a_case(fake):
    cases = ["virtual-objects", "virtual-objects:widening=1", "truth"]
    shot = film("columns", cases, size="160x90", frames="3..7")
    rows = panels(shot, 3)
    assert len(rows) == 4 and {panel.size for row in rows for panel in row} == {(160, 90)}
    assert "--beside virtual-objects:widening=1 --beside truth" in fake.read_text()
    # The stand-in draws the truth from elsewhere, and every other case alike.
    method, same, truth = (np.asarray(panel) for panel in rows[0])
    assert (method == same).all() and (method != truth).any()
    assert change([row[0] for row in rows]).min() > 0
    film("columns", cases, size="160x90", frames="3..7")
    assert fake.read_text().count("--film") == 1


def test_panels_are_cropped_enlarged_and_named():
    row = [Image.new("RGB", (20, 10), colour) for colour in ("red", "blue")]
    whole = named(row, ["a", "b"], (5, 2, 11, 6), 3)
    assert whole.size == (2 * 18 + GAP_PX, 12 + CAPTION_PX)
    assert whole.getpixel((17, CAPTION_PX)) == (255, 0, 0)
    assert whole.getpixel((18, CAPTION_PX)) == (255, 255, 255)
    assert whole.getpixel((18 + GAP_PX, CAPTION_PX + 11)) == (0, 0, 255)


def test_a_written_film_plays_every_picture_at_its_rate(tmp_path):
    pictures = [Image.new("RGB", (8, 8), (shade, 0, 0)) for shade in (0, 51, 102)]
    images.write_film(pictures, tmp_path / "film.png", rate_hz=12.5)
    with Image.open(tmp_path / "film.png") as film:
        assert film.n_frames == 3 and film.info["duration"] == pytest.approx(80)
    assert change(pictures) == pytest.approx([0.2 / 3] * 2)
