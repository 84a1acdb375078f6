"""Popescu et al. 2006, slide 17: four teapots.

To be seen: Four mirror teapots on a piece of floor that mirror each other. Each is one quad to the others, which
carries its normals, so that its picture reflects in turn; beyond the floor's quad the environment map begins.
A teapot does not reflect its own spout and handle, as a reflector skips its own billboard.

Claim: "D = 1, R = 4, D+(R-1)+D = 5 intersections / pix; 12 second order reflections; 40fps".
"""

from mirrorfigures import main
from mirrorfigures.billboards import Slide, scene_figure


def draw(figure):
    scene_figure(figure, Slide("four-teapots", 1, 4, "5, and 12 second-order reflections"))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
