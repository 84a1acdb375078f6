"""Patow 1995, Figure 3: the geometry of the reflection plane, computed from a pixel of the scene.

To be seen: A pixel that mirrors the white polygon. Left the plane through the map's centre, the
reflector point W and the mirrored direction B: dots are the surface points S' that the map holds
along the arc from B to W, the ray from W meets the polygon at S. Right the angle between B and
S' − W for every texel of the arc: it falls to almost nothing at the one whose point lies on the ray.

Claim: B, W and S "belong to the same plane"; the true direction P lies between B and W, and where
P' = P expression (2) "takes its theoretical minimum value" of zero (section 2).
"""

import numpy as np

from mirrorfigures import main, render
from mirrorfigures.evidence import object_ids
from mirrorfigures.reflection_plane import arc_of, depth_layers, draw_arc, middle_pixel

CENTRE = np.zeros(3)  # of patow-room's sphere


def draw(figure):
    truth = render("patow-room", "truth", size="600x600")
    ours = render("patow-room", "z-buffered-map", size="600x600", dump="z-buffered-map/capture")
    figure.cite(truth, ours)
    frame = truth.frame()
    pixel = middle_pixel(frame.shows(object_ids(ours.row)["quad"]))
    dumped = ours.files / "dump" / "z-buffered-map" / "capture" / "surface.exr"
    arc = arc_of(frame, pixel, depth_layers(dumped)[:1], CENTRE)
    figure.plot = draw_arc(arc, ["S' = α' P', first layer"])
    best = arc.best(0)
    figure.number("pixel", list(pixel))
    figure.number("best_angle_deg", float(arc.angles[0, best]))
    figure.finding(
        f"Pixel {pixel[1]}, {pixel[0]}: of {arc.places.size} texels the best is off the ray by "
        f"{arc.angles[0, best]:.2f} degrees, not by zero, as no texel's centre lies on the ray; its "
        f"point is {1000 * np.linalg.norm(arc.s - arc.points[0, best]):.0f} mm from the true S."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
