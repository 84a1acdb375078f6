"""Patow 1995, Figure 1: a reflective sphere with Blinn & Newell's environment map.

To be seen: The map is looked up by the mirrored direction alone, as if all it shows were infinitely
far away. The walls nearly hold; the white polygon, close to the sphere, lands in the wrong place.
The paper's picture is 300 x 300 pixels; ours is drawn at twice that.

Claim: "by taking into account just the surface's reflection direction and not its position, it
models an infinitely large environment sphere, ignoring parallax" (section 1).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import comparison
from mirrorfigures.text import verdict


def draw(figure):
    truth = render("patow-room", "truth", size="600x600")
    ours = render("patow-room", "environment-map", size="600x600")
    comparison(figure, truth, "environment map (by direction B)", ours)
    figure.finding(verdict(ours.row))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
