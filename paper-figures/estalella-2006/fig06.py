"""Estalella et al. 2006, Figure 6: the ants, whose eight eyes are reflectors.

To be seen: Above, the method; below, the same frames ray traced. From afar the eyes are a few pixels and cost as much
as from near.

Claim: "In the left image the reflected images are very small, but we are computing a full reflection of
the scene." 30,153 vertices, 12 fps.
"""

from mirrorfigures import main
from mirrorfigures.panels import strip

SCENE, CASE = "ants", "virtual-objects:subdivide=0.14"
FRAMES = (0, 240)


def draw(figure):
    strip(figure, SCENE, CASE, FRAMES, size="640x400")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
