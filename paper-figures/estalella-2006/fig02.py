"""Estalella et al. 2006, Figure 2: the geometry of a reflection point, computed from the textures of a run.

To be seen: Left, the plane of observer O, vertex V (the top of a column) and the mirror sphere's centre.
Dots are texels of T_P that lie in it. At R, where the search ends, the bisector B is the normal N; at P, another
texel, it is not. V' is V mirrored in the plane at R, on the line from O. Right, along the dots: the angle
between N and B, which changes sign at R, and the value the search maximises, which is flat there.

Claim: "The point of reflection R is such that the bisector vector of the angle formed by the observer O, R
and V is the same as the surface normal vector N at R. This can be identified when N.B is equal to 1."
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.cameras import camera
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.plans import Plane, circle
from mirrorfigures.reflection_search import (
    bisector,
    middle,
    mirrored,
    search,
    sphere_root,
    textures,
)

SCENE, SIZE = "columns", "640x360"
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
VERTEX = np.array([-2.1585, 3.0, 2.5622])  # at column-6's top, towards the sphere
NORMAL_M = 0.9  # length of the arrows
OTHER_DEG = -38.0  # where P is on the section
NEAR_M = 0.006  # texels so near to the plane lie in it: half a texel


def draw(figure):
    run = render(SCENE, "virtual-objects", size=SIZE, dump="virtual-objects/gbuffer")
    figure.cite(run)
    drawn = textures(run, camera(SCENE, 0, SIZE).eye)
    r, n = (v[0] for v in drawn.at(search(drawn, VERTEX, middle(drawn.mask))[-1]))
    plane = Plane(CENTRE, drawn.eye, VERTEX)
    section, normals = section_of(plane, drawn)
    other = np.abs(turned(plane(section)) - OTHER_DEG).argmin()
    plot, axes = plt.subplot_mosaic(
        [["plane", "angle"], ["plane", "value"]],
        figsize=(9.6, 4.4),
        layout="constrained",
        width_ratios=(1.5, 1),
    )
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    marked = {"P": (section[other], normals[other]), "R": (r, n)}
    draw_plane(axes["plane"], plane, drawn.eye, section, marked)
    draw_angles(axes["angle"], axes["value"], plane, drawn.eye, section, normals)
    figure.plot = plot
    root = sphere_root(CENTRE, RADIUS, drawn.eye, VERTEX)
    b = bisector(r, drawn.eye, VERTEX)
    angle = np.degrees(np.arccos(min(n @ b, 1.0)))
    figure.number("angle between N and B at R, degrees", float(angle))
    figure.number("R from the closed form, metres", float(np.linalg.norm(r - root)))
    figure.finding(
        f"At the best texel N.B is {n @ b:.6f}, an angle of {angle:.2f} degrees; it lies "
        f"{1000 * np.linalg.norm(r - root):.1f} mm from the sphere's true reflection point."
    )


def section_of(plane: Plane, drawn) -> tuple[np.ndarray, np.ndarray]:
    """The texels' points in the plane and their normals, in order."""
    points, normals = drawn.points[drawn.mask], drawn.normals[drawn.mask]
    near = plane.away(points) < NEAR_M
    points, normals = points[near], normals[near]
    order = np.argsort(turned(plane(points)))
    return points[order], normals[order]


def draw_plane(axis, plane, eye, section, at):
    circle(axis, RADIUS, color=QUIET)
    axis.plot(*plane(section).T, ".", color=INK, ms=3)
    places = {"O": plane(eye), "V": plane(VERTEX), "V'": plane(mirrored(VERTEX, *at["R"]))}
    for name, (point, normal) in at.items():
        places[name] = here = plane(point)
        for end in ("O", "V"):
            axis.plot(*np.stack([here, places[end]], 1), "-" if name == "R" else "--", color=QUIET, lw=1)
        for letter, vector, colour in (
            ("N", plane.turn(normal), COLOURS[0]),
            ("B", plane.turn(bisector(point, eye, VERTEX)), COLOURS[1]),
        ):
            # N is longer, to be seen where the two are one.
            head = here + NORMAL_M * (1.3 if letter == "N" else 1.0) * vector
            axis.annotate("", head, here, arrowprops={"arrowstyle": "->", "color": colour, "lw": 1.6})
            beside = (2, 4) if letter == "N" else (-8, 6)
            text = f"{letter}$_{name}$"
            axis.annotate(text, head, xytext=beside, textcoords="offset points", color=colour)
    axis.plot(*np.stack([places["R"], places["V'"]], 1), ":", color=QUIET, lw=1)
    for name, place in places.items():
        axis.plot(*place, "o", color=INK, ms=4)
        beside = (-15, 2) if name in ("P", "R") else (5, 5)
        axis.annotate(name, place, xytext=beside, textcoords="offset points", weight="bold")
    axis.annotate("ρ", (0, -RADIUS), xytext=(0, 5), textcoords="offset points", ha="center")
    axis.set(aspect="equal", ylim=(-1.5, 3.0))
    axis.set(xlabel="from the sphere's centre towards O, metres", ylabel="towards V, metres")
    axis.set_title("the plane of O, V and the centre")


def draw_angles(angle, value, plane, eye, section, normals):
    b = bisector(section, eye, VERTEX)
    places = turned(plane(section))
    signed = turned(plane.turn(b)) - turned(plane.turn(normals))
    angle.plot(places, signed, ".", ms=3, color=COLOURS[0])
    value.plot(places, (normals * b).sum(-1), ".", ms=3, color=COLOURS[1])
    angle.set(ylabel="from N to B, degrees", title="along the section")
    value.set(ylabel="N.B", xlabel="texel, degrees from the direction of O")
    for axis, best in ((angle, 0.0), (value, 1.0)):
        axis.axhline(best, color=QUIET, lw=0.8)
        axis.grid(color=GRID, lw=0.6)


def turned(vectors: np.ndarray) -> np.ndarray:
    """Degrees of vectors in the plane, from the direction of the observer."""
    return np.degrees(np.arctan2(vectors[:, 1], vectors[:, 0]))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
