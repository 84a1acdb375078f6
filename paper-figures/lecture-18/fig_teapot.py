"""Lecture 18, "Blinn and Newell 1976": a glossy teapot that mirrors a room's windows.

To be seen: The teapot has diffuse shading and a mirror's share, looked up in a polar map of the room as
theirs was, 2048 texels around. Body and spout show the two windows; the truth beside it also has what
a map leaves out: the teapot's own spout and lid in its body.

Claim: "Notice reflections of windows in the teapot. This teapot has diffuse shading + mirror components."
"""

from mirrorfigures import main, render
from mirrorfigures.panels import comparison
from mirrorfigures.text import verdict

SIZE = "800x600"


def draw(figure):
    truth = render("window-teapot", "truth", size=SIZE)
    ours = render("window-teapot", "environment-map:projection=latlong", size=SIZE)
    comparison(figure, truth, "polar environment map", ours)
    figure.finding(verdict(ours.row))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
