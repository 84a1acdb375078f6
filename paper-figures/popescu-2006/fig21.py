"""Popescu et al. 2006, slides 21 to 23: the pushing-it scene.

To be seen: Nine mirror figures push a block. The block is one quad to all of them (published), so what stands at its
side sees a face that is turned away from it.

Claim: "D = 2, R = 9, D+(R-1)+D = 11 intersections / pix; 72 second order reflections"; 11 fps on one slide, 6 on the
next.
"""

from mirrorfigures import main
from mirrorfigures.billboards import Slide, scene_figure


def draw(figure):
    scene_figure(figure, Slide("pushing-it", 2, 9, "11, and 72 second-order reflections"))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
