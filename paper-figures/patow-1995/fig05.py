"""Patow 1995, Figure 5: the geometry of the hiding problem, computed from a pixel of Figure 6's hole.

To be seen: A pixel that ought to mirror the orange quad. Left the ray from W meets it at S, but seen
from the map's centre the white quad (the short row of first-layer points nearest to the centre) hides
S; only the second layer holds points there. Right: no texel of the first layer comes within the limit,
one of the second does.

Claim: "All of the points of Surface A hide all those behind it, as viewed from the center of
projection. We could call this the hiding problem" (section 4).
"""

import numpy as np

from mirrorfigures import main, render
from mirrorfigures.evidence import object_ids
from mirrorfigures.exr import FOUND
from mirrorfigures.reflection_plane import arc_of, depth_layers, draw_arc, middle_pixel

CENTRE = np.zeros(3)  # of patow-room's sphere


def draw(figure):
    truth = render("patow-room", "truth", size="600x600")
    one = render("patow-room", "z-buffered-map:layers=1", size="600x600")
    two = render("patow-room", "z-buffered-map", size="600x600", dump="z-buffered-map/capture")
    figure.cite(truth, one, two)
    frame = truth.frame()
    hole = frame.shows(object_ids(two.row)["hidden-quad"]) & (one.frame().status != FOUND)
    pixel = middle_pixel(hole)
    dumped = two.files / "dump" / "z-buffered-map" / "capture" / "surface.exr"
    arc = arc_of(frame, pixel, depth_layers(dumped), CENTRE)
    figure.plot = draw_arc(arc, ["first layer (surface A hides)", "second layer"])
    angles = [float(np.nanmin(row, initial=180.0)) for row in arc.angles]
    figure.number("pixel", list(pixel))
    figure.number("best_angles_deg", angles)
    figure.finding(
        f"Pixel {pixel[1]}, {pixel[0]}: the first layer's best predictor is {angles[0]:.1f} degrees off "
        f"the ray, the second's {angles[1]:.2f}."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
