"""Estalella et al. 2006, Figure 8: three frames of the UFO scene.

To be seen: Above, the method; below, the same frames ray traced, as the disc comes down over the square.

Claim: "(Left) Three frames of the UFO scene (12 fps; 81,997 vertices). (Far right) Ray-traced image for
comparison."
"""

from mirrorfigures import main
from mirrorfigures.panels import strip

SCENE, CASES = "ufo", {"published": "virtual-objects:subdivide=3.7"}
FRAMES = (80, 160, 240)


def draw(figure):
    strip(figure, SCENE, CASES, FRAMES, size="480x300")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
