"""Popescu et al. 2006, slides 4 to 9: the problem, and the scene that stands in for the scene.

To be seen: From above, at the height of the eye and of a mirror ball's centre, so that all rays lie in the plane. Top
left, a pixel's four steps: eye ray to the mirror (1), mirrored ray (2), the point it meets (3), and what lies between
the rays beside it, here some pixels apart, to be averaged (4). A rasteriser gives 1 and 2; 3 and 4 are the problem.
The others, the same row of pixels with a stand-in for the scene: rays end where each method says that they do. The
environment map takes rays for ones from its centre; the billboard shows what its picture has where the ray meets a
quad through the box; the depth image is met where the box is.

Claim: "Compute: intersection with reflector, reflected ray, intersection with reflected scene, antialiasing" (4), of
which the first two are "OpenGL" and the others "???" (5); "reflected scene replaced with approximation that provides
fast intersection with ray, antialiasing" (6); environment mapping is a "drastic approximation, incorrect results
close to the reflector" (8).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS
from mirrorfigures.evidence import object_ids
from mirrorfigures.exr import ENVIRONMENT
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.plans import circle
from mirrorfigures.variants import head, scene_file, thing

SIZE = "481x361"
# Of the eye, the ball, and the box's middle: x and z; all at one height.
EYE, RADIUS, HEIGHT = np.array([0.4, 4.0]), 0.8, 0.8
BOX, SIDE, TURN_DEG = np.array([1.7, 1.1]), 0.7, 20.0
CASES = {
    "environment map (7)": "environment-map",
    "billboard": "billboard-impostors",
    "depth image": "depth-impostors:size=256",
}
# A ray drawn for every so many pixels.
EVERY = 6


def draw(figure):
    scene = scene_file("standins", text())
    truth = render(scene, "truth", size=SIZE)
    runs = {name: render(scene, case, size=SIZE) for name, case in CASES.items()}
    figure.cite(truth, *runs.values())
    box = object_ids(next(iter(runs.values())).row)["box"]
    traced = Row(truth, box)
    pixels = np.flatnonzero(traced.shows)[EVERY // 2 :: EVERY]
    plot, axes = plt.subplots(2, 2, figsize=(8.4, 8.0), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95))
    steps(axes[0, 0], traced, pixels)
    table = []
    for axis, (name, run) in zip(axes.flat[1:], runs.items(), strict=True):
        row = Row(run, box)
        rays(axis, row, traced, pixels)
        axis.set_title(name, fontsize=10)
        table.append([name, *row.errors(traced)])
    for axis in axes.flat:
        circle(axis, RADIUS, color=INK)
        axis.add_patch(plt.Polygon(outline(), fill=False, color=INK, lw=0.8))
        axis.set(aspect="equal", xlim=(-0.95, 2.6), ylim=(2.1, -0.95), xticks=[], yticks=[])
    figure.plot = plot
    header = ["stand-in", "shows the box", "as the truth does", "median distance from the truth's point"]
    figure.table("Pixels of the row", header, table)
    figure.finding(
        "Median distance of the point shown from the one that belongs there: "
        + ", ".join(f"{name.split(' (')[0]} {said[-1]}" for name, *said in table)
        + "."
    )


def outline():
    """The box's corners."""
    corners = SIDE / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    turn = np.radians(TURN_DEG)
    sin, cos = np.sin(turn), np.cos(turn)
    return BOX + corners @ np.array([(cos, -sin), (sin, cos)])


def text():
    """A mirror ball and a box, the eye level with both."""
    ball = f"sphere = {{ radius = {RADIUS}, slices = 192, stacks = 96 }}"
    box = f"box = {{ size = [{SIDE}, 1.0, {SIDE}] }}"
    return (
        head(32.0, (EYE[0], HEIGHT, EYE[1]), (EYE[0], HEIGHT, 0), (0.15, 0.15))
        + thing("ball", ball, "mirror", (0, HEIGHT, 0))
        + thing("box", box, "paint", (BOX[0], HEIGHT, BOX[1]), (0, TURN_DEG, 0))
    )


class Row:
    """The middle row of a run's frame: points as x and z."""

    def __init__(self, run, box):
        frame = run.frame()
        middle = frame.mirror.shape[0] // 2
        self.shows = frame.shows(box)[middle]
        self.at = frame.position[middle][:, [0, 2]]
        self.points = frame.point[middle][:, [0, 2]]
        self.away = frame.status[middle] == ENVIRONMENT

    def ends(self, pixel):
        """From the mirror to the point shown, or some way towards the environment."""
        start = self.at[pixel]
        return np.stack([start, start + 3 * self.points[pixel] if self.away[pixel] else self.points[pixel]])

    def errors(self, traced):
        both = self.shows & traced.shows
        apart = np.linalg.norm(self.points - traced.points, axis=-1)[both]
        return f"{self.shows.sum()}", f"{both.sum()} of {traced.shows.sum()}", f"{100 * np.median(apart):.1f} cm"


def steps(axis, traced, pixels):
    """One pixel's four steps, and its neighbours' rays."""
    middle = pixels[len(pixels) // 2]
    wedge = [traced.ends(middle - EVERY), traced.ends(middle + EVERY)]
    corners = np.concatenate([wedge[0], wedge[1][::-1]])
    axis.fill(*corners.T, color=COLOURS[2], alpha=0.25, lw=0)
    for at in (middle - EVERY, middle, middle + EVERY):
        path = np.concatenate([[EYE], traced.ends(at)])
        axis.plot(*path.T, color=COLOURS[0] if at == middle else QUIET, lw=1.4 if at == middle else 0.7)
    start, end = traced.ends(middle)
    along = start + 0.16 * (EYE - start)
    for text, point, shift in (
        ("1", start, (-11, -3)),
        ("2", (start + end) / 2, (-2, 9)),
        ("3", end, (5, 2)),
        ("4", (3 * wedge[1][1] + wedge[0][0]) / 4, (-24, -4)),
    ):
        axis.annotate(text, point, xytext=shift, textcoords="offset points", weight="bold")
    axis.annotate("to the eye", along, xytext=(8, 0), textcoords="offset points", color=QUIET, fontsize=8)
    axis.set_title("four steps of a pixel (4, 5)", fontsize=10)


def rays(axis, row, traced, pixels):
    """Where the row's rays end by a method, and where they should."""
    for pixel in pixels:
        axis.plot(*row.ends(pixel).T, color=COLOURS[0] if row.shows[pixel] else QUIET, lw=0.9)
    axis.plot(*traced.points[pixels].T, "o", mfc="none", color=COLOURS[2], ms=5, label="the truth's points")
    found = pixels[row.shows[pixels]]
    axis.plot(*row.points[found].T, ".", color=COLOURS[1], ms=5, label="points shown")
    axis.legend(fontsize=7.5, loc="lower left")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
