"""The sampling cell, the octrees and the generalised camera of reflection morphing's figures."""

import numpy as np
import pytest

from mirrorfigures import render
from mirrorfigures.morphing import (
    Ray,
    distance,
    generalised_rays,
    locations,
    nearest_ray,
    weights,
)
from mirrorfigures.ray_octrees import BUFFERS, Octree, dumped

EYE = np.array([0.6, 1.7, -0.2])


def test_eight_locations_weigh_as_the_eye_lies_between_them():
    around, parts = locations(EYE), weights(EYE)
    assert parts.sum() == pytest.approx(1) and (parts > 0).all()
    assert parts @ around == pytest.approx(EYE)
    # A node has one slot whatever cell asks for it: even ones the first.
    assert around[0] == pytest.approx([1.0, 2.0, 0.0])


def test_rays_meet_spheres_in_turn_and_end_at_the_box():
    eye, ahead = np.array([0.0, 1.0, 4.0]), np.array([[0.0, 0.0, -1.0]])
    spheres, box = [(0.0, 1.0, 0.0), (0.0, 1.0, 8.0)], (np.full(3, -10.0), np.full(3, 10.0))
    # Straight at the first, back at the second, and again.
    rays = generalised_rays(eye, ahead, spheres, 1.0, box, 3)
    assert [ray.trace for ray in rays] == [(), (0,), (0, 1), (0, 1, 0)]
    assert [ray.end[2] for ray in rays] == pytest.approx([1, 7, 1, 7])
    # Past both.
    (past,) = generalised_rays(eye, np.array([[0.6, 0.0, -0.8]]), spheres, 1.0, box, 3)
    assert past.end[0] == pytest.approx(10.0) and past.trace == ()


def test_the_nearest_ray_is_one_of_its_trace():
    along_x = Ray(np.zeros(3), np.array([2.0, 0, 0]), (0,))
    along_y = Ray(np.zeros(3), np.array([0, 2.0, 0]), (1,))
    assert nearest_ray([along_x, along_y], (1,), np.array([1.0, 0, 0])) is along_y
    assert distance(along_x, np.array([3.0, 0, 0])) == pytest.approx(1.0)
    assert distance(along_x, np.array([1.0, 0, 0.5])) == pytest.approx(0.5)


def test_an_octree_is_as_large_as_its_leaves_say(fake):
    tree = dumped(render("columns", "reflection-morphing", size="32x24", dump=BUFFERS))
    # Eight leaves of one ray each; arrays of 9, 9, 8 and 32 words.
    assert (tree.rays, tree.entries, tree.mean, tree.largest) == (4, 8, 1.0, 1)
    assert tree.bytes == 4 * (9 + 9 + 8 + 32)


def test_the_mean_is_of_leaves_that_hold_rays():
    tree = Octree(bytes=0, rays=5, lists=np.array([0, 2, 0, 4]))
    assert (tree.entries, tree.mean, tree.largest) == (6, 3.0, 4)
