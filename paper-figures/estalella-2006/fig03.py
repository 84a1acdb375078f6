"""Estalella et al. 2006, Figure 3: the crosshair pattern, walked by a search on the textures of a run; and
an open and closed reflector pair.

To be seen: Left, the texels that show a mirror sphere, coloured by the angle between N and B for one
vertex, the top of a column. The search begins in the middle; small crosses mark the neighbours it looks
at, the white one the reflection point in closed form. Right, half a cylinder, turned so far that it shows its inside
too, as it is drawn, and its closed partner as it is searched, both in the colours of their normals.

Claim: "The crosshair pattern used to sample the textures for the reflection point search"; "an example of
an open/closed reflector pair". Searches use the closed one, the stencil the open one (section 5.1).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main, render
from mirrorfigures.cameras import camera
from mirrorfigures.figure import INK
from mirrorfigures.reflection_search import (
    CROSSHAIR,
    bisector,
    middle,
    mirrored,
    search,
    sphere_root,
    textures,
)

SCENE, SIZE, TEXELS, WIDENING = "columns", "640x360", 112, 1.2
CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
VERTEX = np.array([-2.1585, 3.0, 2.5622])  # at column-6's top, towards the sphere
OPEN, TURNED = "open-sheet", 60


def draw(figure):
    dump = "virtual-objects/gbuffer"
    run = render(SCENE, f"virtual-objects:texture={TEXELS}", size=SIZE, dump=dump)
    # Unwidened, so that texels and pixels are one.
    pair = render(OPEN, "virtual-objects:widening=1", frame=TURNED, size=SIZE, dump=dump)
    figure.cite(run, pair)
    view = camera(SCENE, 0, SIZE)
    drawn = textures(run, view.eye)
    steps = np.array([texels[0] for texels in search(drawn, VERTEX, middle(drawn.mask))])
    root = view.widened(WIDENING).place(sphere_root(CENTRE, RADIUS, view.eye, VERTEX)) * drawn.size - 0.5
    plot, axes = plt.subplot_mosaic(
        [["walk", "open"], ["walk", "closed"]], figsize=(9.6, 4.9), layout="constrained", width_ratios=(1.2, 1)
    )
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    draw_walk(plot, axes["walk"], drawn, steps, root)
    draw_pair(axes, pair)
    figure.plot = plot
    off = float(np.abs(steps[-1] - root).max())
    moved = image_error(run, view, *(v[0] for v in drawn.at(steps[-1:])))
    figure.number("texels visited", steps.tolist())
    figure.number("closed form, texels", root.tolist())
    figure.finding(
        f"{len(steps)} neighbourhoods, the last to confirm; the texel found is {off:.2f} from the closed form on the "
        f"worse axis. The picture of the run shows the vertex {moved:.1f} pixels from where this walk puts it."
    )


def draw_walk(plot, axis, drawn, steps, root):
    n, p = drawn.normals, drawn.points
    cosine = (n * bisector(p, drawn.eye, VERTEX)).sum(-1)
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    shown = axis.imshow(np.where(drawn.mask, angle, np.nan), cmap="viridis_r", interpolation="nearest")
    bar = plot.colorbar(shown, ax=axis, location="bottom", shrink=0.7, pad=0.02)
    bar.set_label("angle between N and B, degrees")
    left, top, right, bottom = images.box_around(drawn.mask)
    axis.set(xlim=(left - 1.5, right + 0.5), ylim=(bottom + 0.5, top - 1.5), xticks=[], yticks=[])
    axis.spines[:].set_visible(False)
    looked = (steps[:, None] + CROSSHAIR).reshape(-1, 2)
    axis.plot(*looked.T, "+", color=INK, ms=5, mew=0.8)
    axis.plot(*steps.T, "-o", color="#D55E00", ms=4, lw=1.2)
    axis.plot(*root, "x", color="white", ms=7, mew=1.6)
    for text, place, beside in (("start", steps[0], (6, -14)), ("R", steps[-1], (-14, 8))):
        axis.annotate(text, place, xytext=beside, textcoords="offset points", weight="bold", color=INK)
    axis.set_title(f"one search, textures {TEXELS} texels wide")


def draw_pair(axes, pair):
    frame = pair.frame()
    closed = textures(pair, camera(OPEN, TURNED, SIZE).eye)
    left, top, right, bottom = images.box_around(closed.mask)
    crop = np.s_[top - 8 : bottom + 8, left - 16 : right + 16]
    for name, mask, normals, title in (
        ("open", frame.mirror, frame.normal, "open: drawn into the stencil"),
        ("closed", closed.mask, closed.normals, "closed: searched"),
    ):
        axes[name].imshow(np.where(mask[..., None], 0.5 + 0.5 * normals, 1.0)[crop], interpolation="nearest")
        axes[name].set(xticks=[], yticks=[], title=title)
        axes[name].spines[:].set_visible(False)


def image_error(run, view, p, n) -> float:
    """Pixels between the image of the vertex by this point and normal, and where the run's picture shows it."""
    frame = run.frame()
    height, width = frame.mirror.shape
    expected = view.place(mirrored(VERTEX, p, n)) * (width, height) - 0.5
    away = np.where(frame.mirror, np.linalg.norm(frame.point - VERTEX, axis=-1), np.inf)
    y, x = np.unravel_index(away.argmin(), away.shape)
    return float(np.hypot(*(expected - (x, y))))


if __name__ == "__main__":
    main(__file__, __doc__, draw)
