"""Estalella et al. 2006, Figure 4: reflected, hidden and unreflected regions, and the inverse search, computed
on a plan.

To be seen: Every point of the plan through the observer O and a mirror sphere is searched for as a vertex, on
the textures of a run. Left, an open mirror, a cap of the sphere: searches that stop inside it (A, reflected),
at its rim and in its shadow (C, hidden), at its rim elsewhere (B, unreflected). Middle, the whole sphere, its
closed partner, with the half-space test: B is gone, and C too wide. Lines are the borders in closed form. Right,
a hidden V: points that an inverse search from the middle visits, and their images V', up to R*; and the image in
the plane where the search for V itself ended (the shortcut).

Claim: "All the search computations are performed with the closed reflector [...] In practice this means that in
our implementation we do not have B regions." For a hidden vertex "it is sufficient to check the plane
half-space condition at the end of the standard search, and simply use the plane defined by R and N".
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

from mirrorfigures import main, render
from mirrorfigures.cameras import camera
from mirrorfigures.charts import COLOURS
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.reflection_search import (
    bisector,
    is_hidden,
    middle,
    mirrored,
    search,
    sphere_root,
    textures,
    unit,
)

SCENE, SIZE = "columns", "640x360"
TEXELS, FINE = 240, 960  # of the textures drawn, and of finer ones for comparison
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
CAP_DEG = 35.0  # the open mirror reaches so far from the direction of O
REACH = np.array([(-4.0, 4.0), (-3.4, 3.4)])  # of the plan, metres: towards O, and across
STEP = 0.07
HIDDEN = (-1.6, 0.6)  # of the inverse search
INSIDE, A, B, C = range(4)
TINTS = ListedColormap(["white", "#cfe3f2", "#fbe3c0", "#c9cdd3"])


def draw(figure):
    view = camera(SCENE, 0, SIZE)
    dump = "virtual-objects/gbuffer"
    runs = [render(SCENE, f"virtual-objects:texture={n}", size=SIZE, dump=dump) for n in (TEXELS, FINE)]
    figure.cite(*runs)
    closed, fine = (textures(run, view.eye) for run in runs)
    plan = Plan(view)
    vertices = plan.lift(plan.places)
    away = np.degrees(np.arccos(np.clip(unit(closed.points - CENTRE) @ plan.along, -1, 1)))
    exact = [plan.exact_open(), plan.exact_closed()]
    found = [open_regions(closed.within(away < CAP_DEG), vertices), closed_regions(closed, vertices)]
    plot, axes = plt.subplots(1, 3, figsize=(10.5, 3.9), layout="constrained", sharey=True)
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    for axis, title, regions in zip(axes, ("an open mirror", "its closed partner"), found, strict=False):
        picture = regions.reshape(plan.shape)
        extent = {"extent": REACH.ravel(), "origin": "lower"}
        axis.imshow(picture, cmap=TINTS, vmin=INSIDE, vmax=C, **extent)
        axis.set(title=title, xlabel="towards O, metres")
    plan.draw_borders(axes)
    axes[0].set_ylabel("across, metres")
    figure.plot = plot
    shares = [agreement(*pair) for pair in zip(found, exact, strict=True)]
    shares.append(agreement(closed_regions(fine, vertices), exact[1]))
    onward, apart = draw_inverse(axes[2], plan, closed)
    figure.number("share of the plan where search and closed form agree", shares)
    short = [float(np.degrees(np.arcsin(facing(drawn).min()))) for drawn in (closed, fine)]
    figure.number("rim texels' normals from the tangent, degrees, at least", short)
    figure.finding(
        f"Search and closed form agree on {shares[0]:.1%} of the plan for the open mirror, on {shares[1]:.1%} for "
        f"the closed one. The hidden region comes out too wide, since the last texel of the silhouette is "
        f"{short[0]:.0f} degrees short of it; with textures of {FINE} texels instead of {TEXELS}, {short[1]:.0f} "
        f"degrees, and {shares[2]:.1%}. From the shortcut's texel the inverse search goes on by {onward} step; "
        f"their images are {100 * apart:.0f} cm apart."
    )


def facing(drawn) -> np.ndarray:
    """Cosines between the normals of the plan's outermost texels and the directions to the eye."""
    row = drawn.mask.shape[0] // 2
    ends = np.flatnonzero(drawn.mask[row])[[0, -1]]
    return (drawn.normals[row, ends] * unit(drawn.eye - drawn.points[row, ends])).sum(-1)


def agreement(found: np.ndarray, exact: np.ndarray) -> float:
    return float((found == exact)[exact != INSIDE].mean())


class Plan:
    """Coordinates in the plane of the observer, the sphere's centre and the picture's horizontal."""

    def __init__(self, view):
        self.eye, self.along, self.across = view.eye, unit(view.eye - CENTRE), view.right
        self.distance = float(np.linalg.norm(view.eye - CENTRE))
        sides = [np.arange(low + STEP / 2, high, STEP) for low, high in REACH]
        self.shape = tuple(len(side) for side in sides[::-1])
        self.places = np.stack(np.meshgrid(*sides), -1).reshape(-1, 2)

    def lift(self, places) -> np.ndarray:
        """Places of the plan in the world."""
        return CENTRE + np.asarray(places, float) @ np.stack([self.along, self.across])

    def __call__(self, points: np.ndarray) -> np.ndarray:
        return np.stack([(points - CENTRE) @ self.along, (points - CENTRE) @ self.across], -1)

    def off_axis(self) -> np.ndarray:
        """Tangent of the angle at O between a place and the centre."""
        return np.abs(self.places[:, 1]) / (self.distance - self.places[:, 0])

    def exact_closed(self) -> np.ndarray:
        """C is the sphere's shadow; what it holds is left out."""
        horizon = RADIUS**2 / self.distance  # where tangents from O touch
        edge = RADIUS / np.sqrt(self.distance**2 - RADIUS**2)
        shadow = (self.off_axis() < edge) & (self.places[:, 0] < horizon)
        inside = np.linalg.norm(self.places, axis=1) < RADIUS
        return np.where(inside, INSIDE, np.where(shadow, C, A))

    def exact_open(self) -> np.ndarray:
        closed = self.exact_closed()
        root = self(sphere_root(CENTRE, RADIUS, self.eye, self.lift(self.places)))
        on_cap = np.degrees(np.arctan2(np.abs(root[:, 1]), root[:, 0])) < CAP_DEG
        rim = RADIUS * np.array([np.cos(np.radians(CAP_DEG)), np.sin(np.radians(CAP_DEG))])
        behind = (self.off_axis() < rim[1] / (self.distance - rim[0])) & (closed != A)
        return np.where((closed == A) & on_cap, A, np.where(behind, C, B))

    def draw_borders(self, axes):
        turn = np.linspace(-np.pi, np.pi, 361)
        touch = np.arccos(RADIUS / self.distance)
        for axis, angle in ((axes[0], np.radians(CAP_DEG)), (axes[1], touch)):
            arc = np.linspace(-angle, angle, 100) if axis is axes[0] else turn
            axis.plot(RADIUS * np.cos(arc), RADIUS * np.sin(arc), color=INK, lw=2)
            for side in (-1, 1):
                rim = RADIUS * np.array([np.cos(angle), side * np.sin(angle)])
                onward = unit(rim - (self.distance, 0.0))
                normal = rim / RADIUS
                for away in (onward, onward - 2 * (onward @ normal) * normal):
                    axis.plot(*np.stack([rim, rim + 9 * away], 1), color=INK, lw=0.8, ls="--")
                axis.plot(*np.stack([rim, (self.distance, 0.0)], 1), color=QUIET, lw=0.8)
        for axis in axes:
            axis.plot(self.distance, 0, "o", color=INK, ms=4, clip_on=False)
            axis.annotate("O", (self.distance, 0), xytext=(-3, 6), textcoords="offset points", weight="bold")
            axis.set(aspect="equal", xlim=(REACH[0, 0], self.distance + 0.1), ylim=REACH[1])
        for axis, places in (
            (axes[0], {"A": (2.5, 1.6), "B": (0.2, 2.6), "C": (-2.5, 0.0)}),
            (axes[1], {"A": (1.5, 2.2), "C": (-2.5, 0.0)}),
        ):
            for name, place in places.items():
                axis.annotate(name, place, weight="bold", size=13, ha="center", va="center")


def open_regions(cap, vertices: np.ndarray) -> np.ndarray:
    """By searches on the open mirror: those that stop at its rim left it."""
    found = search(cap, vertices, middle(cap.mask))[-1]
    padded = np.pad(cap.mask, 1)
    inner = padded[2:, 1:-1] & padded[:-2, 1:-1] & padded[1:-1, 2:] & padded[1:-1, :-2]
    left = ~inner[found[:, 1], found[:, 0]]
    hidden = is_hidden(cap, found, vertices)
    toward = unit(cap.points - cap.eye)[cap.mask]
    axis = unit(CENTRE - cap.eye)
    shadow = unit(vertices - cap.eye) @ axis > (toward @ axis).min()
    return np.where(~left & ~hidden, A, np.where(hidden & shadow, C, B))


def closed_regions(closed, vertices: np.ndarray) -> np.ndarray:
    found = search(closed, vertices, middle(closed.mask))[-1]
    regions = np.where(is_hidden(closed, found, vertices), C, A)
    return np.where(np.linalg.norm(vertices - CENTRE, axis=-1) < RADIUS, INSIDE, regions)


def draw_inverse(axis, plan, closed) -> tuple[int, float]:
    """Returns the steps of an inverse search from the shortcut's texel, and metres between their images."""
    vertex = plan.lift([HIDDEN])
    first = search(closed, vertex, middle(closed.mask))[-1]
    onward = search(closed, vertex, first, inverse=True)
    steps = np.array([at[0] for at in search(closed, vertex, middle(closed.mask), inverse=True)])
    points, normals = closed.at(steps)
    images = mirrored(vertex, points, normals)
    shortcut = mirrored(vertex, *closed.at(first))[0]
    turn = np.linspace(-np.pi, np.pi, 361)
    axis.plot(RADIUS * np.cos(turn), RADIUS * np.sin(turn), color=INK, lw=2)
    axis.plot(*plan(points).T, ".", color=COLOURS[1], ms=3)
    axis.plot(*plan(images).T, "-", marker=".", color=COLOURS[1], ms=4, lw=0.6)
    r, image, v = plan(points[-1]), plan(images[-1]), np.array(HIDDEN)
    for ends in ((r, (plan.distance, 0.0)), (r, image)):
        axis.plot(*np.stack(ends, 1), color=QUIET, lw=1)
    axis.plot(*np.stack([v, r], 1), ":", color=QUIET, lw=1)
    n = plan(CENTRE + normals[-1])
    tangent = np.array([-n[1], n[0]])
    axis.plot(*np.stack([r - 3 * tangent, r + 3 * tangent], 1), "-.", color=COLOURS[0], lw=1)
    b = plan(CENTRE + bisector(points[-1], closed.eye, images[-1]))
    style = {"arrowstyle": "->", "lw": 1.4}
    axis.annotate("", r + 1.3 * n, r, arrowprops={**style, "color": COLOURS[0]})
    axis.annotate("", r + 1.0 * b, r, arrowprops={**style, "color": COLOURS[1]})
    for name, place, beside in (
        ("V", v, (-12, 2)),
        ("V'", image, (5, 3)),
        ("shortcut", plan(shortcut), (6, -10)),
        ("R*", r, (-2, 8)),
    ):
        axis.plot(*place, "o", color=INK, ms=4)
        axis.annotate(name, place, xytext=beside, textcoords="offset points", weight="bold")
    axis.set(title="the inverse search", xlabel="towards O, metres")
    return len(onward) - 1, float(np.linalg.norm(images[-1] - shortcut))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
