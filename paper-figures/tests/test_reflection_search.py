"""The search walked again: on textures of a sphere made by hand, whose reflection points are known."""

import numpy as np
import pytest

from mirrorfigures import paths
from mirrorfigures.cameras import camera
from mirrorfigures.reflection_search import (
    Textures,
    bisector,
    is_hidden,
    middle,
    mirrored,
    search,
    sphere_root,
    unit,
)

EYE = np.array([0.0, 0.0, 4.0])
PLACES = 2 * (np.arange(201) + 0.5) / 201 - 1


def sphere(half: float = 0.3) -> Textures:
    """The unit sphere at the origin seen from EYE; `half` is half the image at distance 1."""
    x, y = np.meshgrid(half * PLACES, -half * PLACES)
    rays = unit(np.stack([x, y, -np.ones_like(x)], -1))
    along = -(rays @ EYE)
    inside = along**2 - EYE @ EYE + 1
    mask = inside > 0
    points = EYE + (along - np.sqrt(np.where(mask, inside, 0)))[..., None] * rays
    return Textures(points, unit(points), mask, EYE)


def texel_of(point: np.ndarray) -> np.ndarray:
    """Where the eye sees a point on that image, in texels from the centre of the first."""
    towards = point - EYE
    across = np.array([towards[0], -towards[1]]) / -towards[2] / 0.3
    return (across + 1) / 2 * 201 - 0.5


def test_a_search_climbs_to_the_texel_of_the_closed_form():
    textures = sphere()
    vertices = np.array([[2.0, 0.5, 1.5], [-1.0, 2.0, 3.0], [0.3, -3.0, 0.0], [1.5, 1.5, 0.5]])
    steps = search(textures, vertices, middle(textures.mask))
    for vertex, found in zip(vertices, steps[-1], strict=True):
        root = sphere_root(np.zeros(3), 1.0, EYE, vertex)
        assert np.abs(found - texel_of(root)).max() <= 1.0
        # The law of reflection holds at the root, and the image of V lies behind it on the eye's ray.
        assert unit(root) @ bisector(root, EYE, vertex) == pytest.approx(1.0, abs=1e-12)
        image = mirrored(vertex, root, unit(root))
        assert unit(image - EYE) @ unit(root - EYE) == pytest.approx(1.0, abs=1e-12)
    assert not is_hidden(textures, steps[-1], vertices).any()
    # One step moves by one texel or not at all.
    moved = [np.abs(a - b).sum(-1).max() for a, b in zip(steps[1:], steps, strict=False)]
    assert max(moved) == 1


def test_what_lies_in_the_shadow_is_hidden():
    textures = sphere()
    behind = np.array([[0.0, 0.0, -2.0], [0.4, 0.2, -3.0]])
    found = search(textures, behind, middle(textures.mask))[-1]
    assert is_hidden(textures, found, behind).all()
    # From the eye the sphere's edge recedes by 1 / sqrt(15) a metre. Well beyond it nothing is hidden;
    # just beyond it a texel is too coarse to tell.
    edge = 6 / np.sqrt(15)
    beside = np.array([[1.5 * edge, 0.0, -2.0], [1.1 * edge, 0.0, -2.0]])
    found = search(textures, beside, middle(textures.mask))[-1]
    assert is_hidden(textures, found, beside).tolist() == [False, True]


def test_an_inverse_search_finds_a_vertex_that_is_reflected_into_the_hidden_one():
    textures = sphere()
    hidden = np.array([[0.3, 0.1, -1.5]])
    first = search(textures, hidden, middle(textures.mask))[-1]
    found = search(textures, hidden, first, inverse=True)[-1]
    p, n = textures.at(found)
    image = mirrored(hidden, p, n)
    assert float((n * bisector(p, EYE, image)).sum()) > 0.999


def test_a_search_stays_on_the_part_it_is_given():
    textures = sphere()
    half = textures.within(np.broadcast_to(PLACES[None, :] < 0, textures.mask.shape))
    found = search(half, np.array([[2.0, 0.0, 1.5]]), middle(half.mask))[-1]
    assert half.mask[found[0, 1], found[0, 0]] and found[0, 0] == 99


def test_cameras_are_read_off_scenes(tmp_path, monkeypatch):
    monkeypatch.setattr(paths, "SCENES", tmp_path)
    keys = "{ time_s = 0.0, eye = [0.0, 0.0, 4.0], target = [0.0, 0.0, 0.0] },"
    keys += "{ time_s = 1.0, eye = [0.0, 0.0, 2.0], target = [0.0, 0.0, 0.0] }"
    (tmp_path / "a.toml").write_text(f"rate_hz = 10.0\n[camera]\nfov_deg = 90.0\nkeys = [{keys}]\n")
    seen = camera("a", 5, "200x100")
    assert seen.eye == pytest.approx([0, 0, 3]) and seen.half_width == pytest.approx(2.0)
    assert seen.place(np.array([1.0, 0.5, 0.0])) == pytest.approx([0.5 + 1 / 12, 0.5 - 0.5 / 6])
    assert seen.widened(2).place(np.array([3.0, 0.0, 0.0])) == pytest.approx([0.75 - 0.125, 0.5])
    still = "[camera]\nfov_deg = 90.0\neye = [0.0, 0.0, 1.0]\ntarget = [0.0, 0.0, 0.0]\norbit = { period_s = 4.0 }\n"
    (tmp_path / "b.toml").write_text(still)
    assert camera("b", 0, "10x10").forward == pytest.approx([0, 0, -1])
    assert camera("b", 24, "10x10").eye == pytest.approx([1, 0, 0])
