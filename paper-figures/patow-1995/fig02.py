"""Patow 1995, Figure 2: the same map indexed as a common texture, by the surface point W.

To be seen: The map is looked up by the position on the sphere instead of the mirrored direction, as
if the surroundings lay on the sphere itself. The result does not depend on the eye.

Claim: indexing by W "will represent a sphere in touch with the object, reflecting accurately only
those objects that are very close to it" (section 1).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import comparison
from mirrorfigures.text import verdict


def draw(figure):
    truth = render("patow-room", "truth", size="600x600")
    ours = render("patow-room", "environment-map:index=surface", size="600x600")
    comparison(figure, truth, "environment map (by point W)", ours)
    figure.finding(verdict(ours.row))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
