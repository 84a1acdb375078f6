"""Patow 1995, Figure 9: the ray-traced reference.

To be seen: The scene as recursive ray tracing shows it, traced by POV-Ray in the paper and by our
own tracer here. Figures 1, 2, 6 and 8 are judged against it.

Claim: the new model's images "are identical to those computed with the ray tracing program. All
differences [...] are only due to the polygonal approximation made for the sphere" (section 6).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import single


def draw(figure):
    single(figure, render("patow-room", "truth", size="600x600"), "ray-traced truth")
    figure.finding("This is the reference; the claim is about Figure 8, which says how far it holds.")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
