"""Popescu et al. 2006, slides 12 and 40 to 47: results of depth image impostors.

To be seen: A statue near a bumpy mirror sphere, by depth images as published, ray traced, and as revised.
Published, surfaces go on across silhouettes: what passes behind the statue is caught by it, and colours
trail from its outline. Revised, rays pass there.

Claim: "Results: depth image impostors"; an impostor has to provide fast construction, fast intersection with
a ray and antialiasing (slide 35).
"""

from mirrorfigures import main
from mirrorfigures.panels import revision

CASES = "depth-impostors", "depth-impostors@revised"


def draw(figure):
    revision(figure, "statue", *CASES, frame=640, size="480x360")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
