"""Martin & Popescu 2004, Figure 2: the projection of reflected points, from a run.

To be seen: Left, the plane of the eye C, a vertex V of a column and the centre of the mirror R: where
V is drawn, V', lies on the line from C through the point P that reflects it, which no matrix gives. Dots are the
points at which the eight sampling locations see V; P is interpolated between them. Right, V' in the picture, and
V itself.

Claim: "one cannot easily compute the image plane projection V' of the reflected vertex. For general curved
reflectors, or for multiple reflections, there is no closed form solution to the projection equation" (1.1).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main
from mirrorfigures.cameras import camera
from mirrorfigures.charts import COLOURS
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.morphing import morphed
from mirrorfigures.plans import Plane, circle
from mirrorfigures.reflection_search import sphere_root

SCENE, SIZE, FRAME = "columns", "640x360", 12
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
COLUMN = (-0.5472, 2.2, 1.5035)


def draw(figure):
    drawn = morphed(SCENE, FRAME, SIZE)
    figure.cite(drawn.run)
    vertex = drawn.nearest(COLUMN)
    places = {"C": drawn.eye, "V": drawn.vertices[vertex], "P": drawn.reflected_at(vertex)}
    places["V'"] = drawn.images[vertex]
    plot, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.9), layout="constrained", width_ratios=(1, 1.2))
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    draw_plane(left, places, drawn.points[:, vertex])
    draw_picture(right, drawn, places)
    figure.plot = plot
    root = sphere_root(CENTRE, RADIUS, drawn.eye, places["V"])
    apart_m = float(np.linalg.norm(places["P"] - root))
    figure.number("P from the closed form of a sphere, metres", apart_m)
    figure.finding(f"P lies {1000 * apart_m:.1f} mm from the point that a sphere's closed form gives.")


def draw_plane(axis, places, seen):
    plane = Plane(CENTRE, places["C"], places["V"])
    circle(axis, RADIUS, color=QUIET)
    axis.plot(*plane(seen).T, ".", color=COLOURS[1], ms=5)
    at = {name: plane(point) for name, point in places.items()}
    for ends, line in ((("C", "P"), "-"), (("P", "V"), "-"), (("P", "V'"), ":")):
        axis.plot(*np.stack([at[end] for end in ends], 1), line, color=COLOURS[0], lw=1.2)
    for name, place in at.items():
        axis.plot(*place, "o", color=INK, ms=4)
        axis.annotate(name, place, xytext=(5, 5), textcoords="offset points", weight="bold")
    axis.annotate("R", (0, -0.6), ha="center", weight="bold")
    axis.set(aspect="equal", xlabel="from the mirror's centre towards C, metres", ylabel="towards V, metres")
    axis.set_title("the plane of C, V and the centre")


def draw_picture(axis, drawn, places):
    width, height = (int(n) for n in SIZE.split("x"))
    view = camera(SCENE, FRAME, SIZE)
    axis.imshow(images.to_srgb(drawn.run.frame().colour), interpolation="nearest")
    for name in ("V", "V'"):
        across, down = view.place(places[name]) * (width, height) - 0.5
        axis.plot(across, down, "o", mfc="none", mec=COLOURS[3], mew=1.8, ms=9)
        axis.annotate(name, (across, down), xytext=(8, 4), textcoords="offset points", color="white",
                      weight="bold", bbox={"fc": INK, "ec": "none", "pad": 1.5, "alpha": 0.7})  # fmt: skip
    axis.set(xticks=[], yticks=[], title="V and its reflection in the picture")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
