"""Patow 1995, Figure 8: the scene with the new model.

To be seen: The map keeps two surfaces behind each texel; the holes of Figure 6 are filled but for a
sliver three surfaces deep, and the orange quad shows beside the white one. The speckle at the left of
the polygon and on the box is the search's own: there the ray meets the near thing and, behind it, a
wall, the first layer holds both, and the better angle wins, whichever it is.

Claim: "The reflections are identical to those computed with the ray tracing program. All differences
between both images are only due to the polygonal approximation made for the sphere" (section 6).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import comparison
from mirrorfigures.text import verdict


def draw(figure):
    truth = render("patow-room", "truth", size="600x600")
    ours = render("patow-room", "z-buffered-map", size="600x600")
    comparison(figure, truth, "z-buffered map, two layers", ours)
    missing = 100 * ours.row["accuracy"]["missing"]
    figure.finding(
        f"{verdict(ours.row)} {missing:.2f} % are missing. Both pictures are of one tessellation, so "
        f"the differences are due to the algorithm, against the claim."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
