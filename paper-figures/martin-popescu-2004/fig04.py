"""Martin & Popescu 2004, Figure 4: what an environment map gets wrong, from a run.

To be seen: From above. At pixel P the ray r_a leaves the mirror and meets the scene (the truth). The environment
map looks up the ray r_c of the same direction from the mirror's centre, and shows what that meets. P1 and P2 lie on
r_a, so that from C one hides the other; seen from the centre they never do.

Claim: "environment mapping sets pixel P to the color of ray r_c, while the correct color is given by ray r_a"; P1
and P2 "should occlude each other as seen from C, which they will never do, in any environment-mapping rendered
reflection" (2.1).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.cameras import camera
from mirrorfigures.charts import COLOURS
from mirrorfigures.evidence import object_ids
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.plans import circle

SCENE, SIZE = "columns", "640x360"
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
COLUMN = "column-4"
BEYOND_M = 1.6  # of P2 behind P1, on the ray


def draw(figure):
    truth, mapped = (render(SCENE, case, size=SIZE) for case in ("truth", "environment-map"))
    figure.cite(truth, mapped)
    eye = camera(SCENE, 0, SIZE).eye
    traced, ours = truth.frame(), mapped.frame()
    pixel = chosen(traced, object_ids(mapped.row)[COLUMN])
    p, s, wrong = (np.array(layer[pixel], float) for layer in (traced.position, traced.point, ours.point))
    ray = (s - p) / np.linalg.norm(s - p)
    behind = s + BEYOND_M * ray
    plot, axis = plt.subplots(figsize=(6.4, 5.6), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    circle(axis, RADIUS, color=QUIET)
    for name, line, colour in (
        ("r$_a$", (p, behind), COLOURS[0]),
        ("r$_c$", (CENTRE, CENTRE + 5.2 * ray), COLOURS[1]),
        ("", (eye, p), QUIET),
        ("", (CENTRE, s), COLOURS[2]),
        ("", (CENTRE, behind), COLOURS[2]),
    ):
        ends = np.stack(line)
        axis.plot(ends[:, 0], ends[:, 2], "--" if colour == COLOURS[2] else "-", color=colour, lw=1.3)
        axis.annotate(name, ends[1, [0, 2]], xytext=(4, 4), textcoords="offset points", color=colour)
    for name, point in (("C", eye), ("P", p), ("P1", s), ("P2", behind), ("shown by the map", wrong)):
        axis.plot(point[0], point[2], "o", color=INK, ms=4)
        axis.annotate(name, point[[0, 2]], xytext=(6, 7 if name.startswith("shown") else -10), textcoords="offset points", weight="bold")
    axis.set(aspect="equal", xlim=(-1.5, 5.2), ylim=(4.3, -1.6), xlabel="x, metres", ylabel="z, metres")
    axis.set_title("from above")
    figure.plot = plot
    apart = angle(s - CENTRE, behind - CENTRE)
    figure.number("angle between P1 and P2 from the mirror's centre, degrees", apart)
    figure.number("angle between r_a's point and what the map shows, from P, degrees", angle(s - p, wrong - p))
    figure.finding(
        f"The map shows a point {np.linalg.norm(wrong - s):.1f} m from the one that belongs there. Two points that hide "
        f"each other in the mirror are {apart:.0f} degrees apart in the map."
    )


def chosen(traced, column: int) -> tuple[int, int]:
    """The middle of the column's reflection in the row nearest to the height of the mirror's centre, so that
    the plan is nearly the plane of the ray."""
    shows = traced.shows(column)
    off = np.where(shows, np.abs(traced.position[..., 1] - CENTRE[1]), np.inf)
    row = int(off.min(axis=1).argmin())
    return row, int(np.median(np.nonzero(shows[row])[0]))


def angle(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.degrees(np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b))))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
