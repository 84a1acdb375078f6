"""Popescu et al. 2006, slides 18 to 20: the table scene.

To be seen: A mirror teapot and a mirror ball on a table with a diffuse vase: two diffuse billboards, the near part
of the table and the vase, and two reflective ones.

Claim: "D = 2, R = 2, D+(R-1)+D = 5 intersections / pix; 2 second order reflections; 33 fps".
"""

from mirrorfigures import main
from mirrorfigures.billboards import Slide, scene_figure


def draw(figure):
    scene_figure(figure, Slide("table", 2, 2, "5, and 2 second-order reflections"))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
