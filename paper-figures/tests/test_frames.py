"""Reading frames, and what they say about objects. Frames made by hand have known answers."""

import dataclasses

import numpy as np
import OpenEXR
import pytest

from mirrorfigures import exr, render
from mirrorfigures.evidence import (
    displacement,
    distance_to_mirror,
    object_ids,
    seen_directly,
    seen_in_mirrors,
)
from mirrorfigures.exr import ENVIRONMENT, FOUND, NO_OBJECT, Frame, cube_faces


def flat_frame(shift: int = 0, size: int = 64) -> Frame:
    """A mirror over the whole frame showing object 3, a wall whose point at pixel (x, y) is
    (0.01 x, 0.01 y, 0), drawn `shift` pixels to the right; columns shifted in show the sky."""
    x, y = np.meshgrid(np.arange(size) - shift, np.arange(size))
    found = x >= 0
    point = np.stack([0.01 * x, 0.01 * y, 0 * x], -1).astype(np.float32)
    grey = np.full((size, size, 3), 0.5, np.float32)
    return Frame(
        colour=grey,
        depth=np.full((size, size), 2.5, np.float32),
        reflection=grey,
        point=point,
        object=np.where(found, 3, NO_OBJECT).astype(np.uint32),
        order=np.ones((size, size), np.uint32),
        status=np.where(found, FOUND, ENVIRONMENT).astype(np.uint32),
        direct_object=np.zeros((size, size), np.uint32),
        reflector=np.zeros((size, size), np.uint32),
        position=np.zeros((size, size, 3), np.float32),
        normal=np.zeros((size, size, 3), np.float32),
    )


@pytest.mark.parametrize("shift", [0, 1, 7, 20])
def test_a_frame_shifted_by_k_pixels_measures_k(shift):
    moved, points = displacement(flat_frame(shift), flat_frame(), 3, samples=10_000)
    assert len(moved) == len(points) == 64 * (64 - shift)
    np.testing.assert_allclose(moved, shift, atol=0.001)


def test_points_the_truth_does_not_see_are_left_out():
    ours = flat_frame()
    behind = dataclasses.replace(ours, point=ours.point + np.float32([0, 0, 0.5]))
    assert len(displacement(behind, flat_frame(), 3)[0]) == 0
    assert len(displacement(ours, flat_frame(), 2)[0]) == 0


def test_samples_bound_the_work():
    moved, _ = displacement(flat_frame(), flat_frame(), 3, samples=100)
    assert 50 <= len(moved) <= 100


def test_distance_to_mirror():
    assert distance_to_mirror(flat_frame()) == 2.5


def test_what_the_toy_scene_shows(fake):
    run = render("lecture", "truth")
    frame = run.frame()
    assert frame.colour.shape == (90, 160, 3)
    ids = object_ids(run.row)
    assert list(ids) == ["object-1", "object-2", "object-3", "object-4", "floor", "mirror"]
    balls = {name: i for name, i in ids.items() if name.startswith("object")}
    assert seen_in_mirrors(frame, ids) == {*balls, "floor"}
    assert seen_directly(frame, balls) == set(balls)
    # Take one away where it is seen directly; its reflection does not count.
    gone = np.where(frame.direct_object == balls["object-1"], ids["floor"], frame.direct_object)
    without = dataclasses.replace(frame, direct_object=gone)
    assert seen_directly(without, balls) == set(balls) - {"object-1"}


def test_a_missing_layer_is_named(fake, tmp_path):
    path = render("columns", "truth").exr()
    channels = exr.read_channels(path)
    del channels["shown.status"]
    OpenEXR.File({}, {n: np.ascontiguousarray(c) for n, c in channels.items()}).write(
        str(tmp_path / "poor.exr")
    )
    with pytest.raises(KeyError, match="shown.status"):
        exr.read_frame(tmp_path / "poor.exr")


def test_cube_faces_come_in_order(fake):
    run = render("lecture", "environment-map", dump="environment-map/capture")
    faces = cube_faces(run.files / "dump" / "environment-map" / "capture" / "radiance.exr")
    assert faces.shape == (6, 128, 128, 3)
    # Seen from the middle of the toy scene: up is sky, down is floor, whose channels are equal.
    np.testing.assert_allclose(np.ptp(faces[3], axis=-1), 0, atol=1e-6)
    assert np.ptp(faces[2], axis=-1).min() > 0.1
    assert run.frame().colour.shape == (90, 160, 3), "the dump is not mistaken for the frame"
    with pytest.raises(KeyError, match="face0.R"):
        cube_faces(run.exr())
