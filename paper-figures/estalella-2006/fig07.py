"""Estalella et al. 2006, Figure 7: four images of the kitchen scene.

To be seen: Above, the method; below, the same frames ray traced, on the way to the bowl.

Claim: "Four images of the kitchen scene. This scene runs at 80 fps and contains 14,979 vertices."
"""

from mirrorfigures import main
from mirrorfigures.panels import strip

SCENE, CASES = "kitchen-table1", {"published": "virtual-objects:subdivide=0.37"}
FRAMES = (0, 72, 132, 192)


def draw(figure):
    strip(figure, SCENE, CASES, FRAMES, size="640x400")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
