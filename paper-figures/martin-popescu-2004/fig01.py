"""Martin & Popescu 2004, Figure 1: environment mapping (top) and ray tracing (middle).

To be seen: The front columns and the cubic particle stand close to the mirror sphere. Ray tracing
draws their reflections near the objects themselves; the environment map does not. The paper's
bottom panel, reflection morphing, belongs here once that method exists.

Claim: with environment mapping "in some situations, a reflected point is drawn hundreds of pixels
away from its correct location" (abstract); it "fails to convey the proximity of the objects to the
surface of the sphere" (section 2.1).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import comparison
from mirrorfigures.text import verdict


def draw(figure):
    truth = render("columns", "truth")
    ours = render("columns", "environment-map")
    comparison(figure, truth, "environment map", ours)
    figure.finding(verdict(ours.row))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
