"""Estalella et al. 2006, Figure 6: the ants, whose eight eyes are reflectors.

To be seen: Above, the method as published: near by, a leg and the ant's own body, torn at the border of what the eye
hides, cover half the eye, and from afar the eyes are lost in them. In the middle, the method revised; below, the
same frames ray traced. From afar the eyes are a few pixels and cost as much as from near.

Claim: "In the left image the reflected images are very small, but we are computing a full reflection of
the scene." 30,153 vertices, 12 fps.
"""

from mirrorfigures import main
from mirrorfigures.panels import strip

SCENE, FRAMES = "ants", (0, 240)
CASES = {"published": "virtual-objects:subdivide=0.14", "revised": "virtual-objects@revised"}


def draw(figure):
    strip(figure, SCENE, CASES, FRAMES, size="640x400")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
