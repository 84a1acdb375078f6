"""Tone mapping, error maps and crops against values known beforehand."""

import numpy as np
import pytest

from mirrorfigures import images


@pytest.mark.parametrize(
    ("linear", "display"), [(0.0, 0.0), (1.0, 1.0), (0.5, 0.7353569), (0.002, 0.02584), (7.0, 1.0)]
)
def test_srgb(linear, display):
    assert images.to_srgb(np.array([linear]))[0] == pytest.approx(display, abs=1e-5)


def test_exposure_is_in_stops():
    np.testing.assert_allclose(
        images.to_srgb(np.array([0.2]), 1.0), images.to_srgb(np.array([0.4])), atol=1e-12
    )


def test_values_that_are_no_numbers_are_black():
    assert images.to_srgb(np.array([np.nan]))[0] == 0.0


def test_colour_error_is_the_mean_over_channels():
    black, red = np.zeros((1, 1, 3)), np.array([[[1.0, 0.0, 0.0]]])
    assert images.colour_error(black, red)[0, 0] == pytest.approx(1 / 3)


def test_heat_rises_saturates_and_is_grey_off_the_mirror():
    error = np.array([[0.0, 0.25, 0.5, 0.9]])
    shown = images.heat(error, np.array([[True, True, True, False]]))
    assert shown[0, 0].sum() < shown[0, 1].sum() < shown[0, 2].sum()
    assert np.ptp(shown[0, 3]) == 0
    np.testing.assert_array_equal(images.heat(np.array([[0.5]])), images.heat(np.array([[2.0]])))


def test_worst_boxes_find_what_was_planted():
    error = np.zeros((40, 60))
    error[10:14, 20:24] = 1.0
    error[30:34, 50:54] = 0.5
    error[0:5, 0:5] = 9.0
    mask = np.ones_like(error, bool)
    mask[0:5, 0:5] = False
    (first, second) = images.worst_boxes(error, mask, side=4, count=2)
    assert first == (20, 10, 24, 14)
    assert second == (50, 30, 54, 34)


def test_box_around():
    mask = np.zeros((20, 30), bool)
    mask[4:9, 10:17] = True
    assert images.box_around(mask) == (10, 4, 17, 9)
    with pytest.raises(ValueError, match="nothing in the mask"):
        images.box_around(np.zeros((3, 3), bool))
