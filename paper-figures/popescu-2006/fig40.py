"""Popescu et al. 2006, slides 40 to 47: results before a mirror of every curvature.

To be seen: A statue before a mirror knot, by depth images as published, ray traced, and as revised.
Most of what is wrong either way is the knot that the knot should mirror, for which there is no
impostor. Published, surfaces go on across silhouettes: what passes behind the statue is caught by it, and colours
trail from its outline. Revised, rays pass there.

Claim: "Results: depth image impostors"; an impostor has to provide fast construction, fast intersection with
a ray and antialiasing (slide 35).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import contest
from mirrorfigures.text import verdict

FRAME, SIZE = 0, "480x360"


def draw(figure):
    truth = render("statue-knot", "truth", frame=FRAME, size=SIZE)
    published = render("statue-knot", "depth-impostors", frame=FRAME, size=SIZE)
    revised = render("statue-knot", "depth-impostors@revised:step_deg=10", frame=FRAME, size=SIZE)
    contest(figure, truth, ("as published", published), ("revised", revised))
    figure.finding(f"Published: {verdict(published.row)} Revised: {verdict(revised.row)}")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
