"""Martin & Popescu 2004, Figure 7: offsetting reflected points for the depth buffer, from a run.

To be seen: In the plane of eye C, mirror centre and a vertex: two vertices V1 and V2 that the mirror shows in
nearly one place, P. As they are, their reflections would have one depth; pushed along the ray from C by their own
distances from P they have two, and the nearer one hides the other.

Claim: "Push this point along the ray from the desired view to itself (Figure 7). The distance that the point must
be pushed is equal to the distance between itself and the actual scene vertex. This will ensure correct
depth-buffering"; "this offsetting does not change its projection onto the desired view" (6).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main
from mirrorfigures.cameras import camera
from mirrorfigures.charts import COLOURS
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.morphing import morphed
from mirrorfigures.plans import Plane, circle

SCENE, SIZE, FRAME = "columns", "640x360", 12
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
INNER_M = (1.4, 1.8)  # from the mirror's axis: the inner ring of columns, which V1 is one of
APART_M = 1.2  # V2's reflection is farther off than V1's by this at least


def draw(figure):
    drawn = morphed(SCENE, FRAME, SIZE)
    figure.cite(drawn.run)
    width, height = (int(n) for n in SIZE.split("x"))
    pixels = camera(SCENE, FRAME, SIZE).place(drawn.images) * (width, height)
    first, second = hiding(drawn, pixels)
    p = drawn.reflected_at(first)
    places = {"C": drawn.eye, "P": p}
    for number, vertex in enumerate((first, second), 1):
        places[f"V{number}"], places[f"V{number}'"] = drawn.vertices[vertex], drawn.images[vertex]
    plane = Plane(CENTRE, drawn.eye, drawn.vertices[first])
    plot, axis = plt.subplots(figsize=(7.6, 4.6), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    circle(axis, RADIUS, color=QUIET)
    at = {name: plane(point) for name, point in places.items()}
    for number, colour in ((1, COLOURS[0]), (2, COLOURS[1])):
        v = f"V{number}"
        axis.plot(*np.stack([at["C"], at["P"], at[v]], 1), "-", color=colour, lw=1.2)
        axis.plot(*np.stack([at["P"], at[f"{v}'"]], 1), ":", color=colour, lw=1.6)
    for name, place in at.items():
        axis.plot(*place, "o", color=INK, ms=4)
        axis.annotate(name, place, xytext=(5, 5), textcoords="offset points", weight="bold")
    axis.set(aspect="equal", xlabel="from the mirror's centre towards C, metres", ylabel="towards V1, metres")
    figure.plot = plot
    apart_px = float(np.linalg.norm(pixels[first] - pixels[second]))
    depths = [float(np.linalg.norm(drawn.images[v] - drawn.eye)) for v in (first, second)]
    figure.number("V1 and V2 in the picture, pixels apart", apart_px)
    figure.number("depths of V1' and V2' from C, metres", depths)
    figure.finding(
        f"V1 and V2 are drawn {apart_px:.1f} px apart, at depths of {depths[0]:.2f} and {depths[1]:.2f} m."
    )


def hiding(drawn, pixels):
    """A vertex of the inner columns, and another drawn nearest to it of those drawn much farther off."""
    away = np.linalg.norm(drawn.images - drawn.eye, axis=1)
    axis_m = np.hypot(*drawn.vertices[:, [0, 2]].T)
    inner = np.nonzero(drawn.valid & (axis_m > INNER_M[0]) & (axis_m < INNER_M[1]) & (drawn.vertices[:, 1] > 0.5))[0]
    best = (np.inf, 0, 0)
    for first in inner[::7]:
        farther = drawn.valid & (away > away[first] + APART_M)
        apart = np.where(farther, np.linalg.norm(pixels - pixels[first], axis=1), np.inf)
        best = min(best, (apart.min(), first, int(apart.argmin())))
    return best[1:]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
