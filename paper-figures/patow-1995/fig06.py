"""Patow 1995, Figure 6: the hiding problem, a black hole beside the white polygon's reflection.

To be seen: The map keeps one surface behind each texel. Beside the white polygon's reflection the
mirror ought to show the orange quad and the wall behind it, which the polygon hides from the map's
centre; no texel holds them, so the background shows: black. The box leaves a hole of the same kind.

Claim: "The algorithm fails in its search, returning the background color (the small black hole at the
left of the reflection of the white polygon in Figure 6)" (section 4).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import comparison
from mirrorfigures.text import verdict


def draw(figure):
    truth = render("patow-room", "truth", size="600x600")
    ours = render("patow-room", "z-buffered-map:layers=1", size="600x600")
    comparison(figure, truth, "z-buffered map, one layer", ours)
    missing = 100 * ours.row["accuracy"]["missing"]
    figure.finding(f"{verdict(ours.row)} {missing:.2f} % show the background for a surface.")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
