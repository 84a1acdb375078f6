"""What the figures of the billboard slides share: the scenes' counts beside the slides'."""

from dataclasses import dataclass

import numpy as np

from . import images, render
from .exr import NO_OBJECT, Frame
from .figure import Figure
from .panels import comparison
from .runs import Run

METHOD = "billboard-impostors"
SIZE = "320x180"


@dataclass(frozen=True)
class Slide:
    """A scene of the slides: diffuse and reflective billboards, and what the slide says of it."""

    scene: str
    diffuse: int
    reflective: int
    said: str

    @property
    def by_formula(self) -> str:
        """D + (R - 1) + D, R (R - 1)."""
        d, r = self.diffuse, self.reflective
        return f"{2 * d + r - 1} and {r * (r - 1)}"


def scene_figure(figure: Figure, slide: Slide) -> None:
    """The truth beside the published method, and the counts."""
    truth = render(slide.scene, "truth", size=SIZE)
    ours = render(slide.scene, METHOD, size=SIZE)
    comparison(figure, truth, "billboard impostors", ours)
    revised = render(slide.scene, f"{METHOD}@revised", size=SIZE)
    figure.cite(revised)
    header = ["case", "intersections a pixel, most", "mean", "pixels of order 2 and up", "bad at 1 px"]
    header += ["of order 1", "of order 2"]
    figure.table("Counted", header, [counts(run) for run in (ours, revised)])
    most = ours.row["counters"]["most_intersections"]
    figure.finding(
        f"At most {most:.0f} intersections a pixel are counted, where the slide says {slide.said}; its formulas give "
        f"{slide.by_formula} (D = {slide.diffuse}, R = {slide.reflective})."
    )


def counts(run: Run) -> list[str]:
    """A row of what the shader counted, and of what is bad."""
    row = run.row
    counted, pixels = row["counters"], row["reflector_pixels"]
    orders = {order["order"]: order["bad_share"]["1"] for order in row["accuracy"]["by_order"]}
    return [
        row["case"],
        f"{counted['most_intersections']:.0f}",
        f"{counted['intersections'] / pixels:.2f}",
        f"{counted['second_order'] / pixels:.1%}",
        f"{row['accuracy']['bad_share']['1']:.1%}",
        *(f"{orders[order]:.1%}" if order in orders else "" for order in (1, 2)),
    ]


def far_regions(cut: Frame, morphed: Frame, near: list[int]) -> tuple[np.ndarray, np.ndarray]:
    """Where mirrors show the environment map in the ray's own direction, and where morphed: slide 27's red and
    green. `near` are the ids of what has billboards."""
    moved = cut.mirror & (np.abs(cut.point - morphed.point).max(axis=-1) > 1e-4)
    beyond = cut.mirror & ((cut.object == NO_OBJECT) | ~np.isin(cut.object, near))
    return beyond & ~moved, moved


def tinted(frame: Frame, red: np.ndarray, green: np.ndarray | None = None) -> np.ndarray:
    """The picture with regions coloured over."""
    picture = images.to_srgb(frame.colour)
    for mask, colour in ((red, (0.9, 0.1, 0.1)), (green, (0.1, 0.8, 0.2))):
        if mask is not None:
            picture = np.where(mask[..., None], 0.35 * picture + 0.65 * np.array(colour), picture)
    return picture
