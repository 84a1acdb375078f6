"""Estalella et al. 2006, section 7 and video: flicker, as a film.

To be seen: The camera glides by the bowl of the kitchen, two and a half millimetres a frame, so that what is
mirrored moves by a fraction of a pixel. Ray traced, it glides too. By the method as published its edges tremble: each
vertex is mirrored in the plane of one texel, and jumps when the search ends on the next. The part framed in the still
is enlarged. Beside it, how much the picture changes from frame to frame there.

Claim: "Flickering is completely avoided" (section 7).
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

from mirrorfigures import film, follow, main
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.films import change, named, panels
from mirrorfigures.variants import glide

SIZE, FRAMES = "480x270", 24
CASES = {
    "published": "virtual-objects:subdivide=0.37",
    "revised": "virtual-objects@revised",
    "ray traced": "truth",
}
BOX = (150, 70, 325, 180)


def draw(figure):
    scene = glide()
    frames = f"0..{FRAMES}"
    shot = film(scene, list(CASES.values()), size=SIZE, frames=frames)
    path = follow(scene, [case for case in CASES.values() if case != "truth"], size=SIZE, frames=frames)
    figure.cite(shot, path)
    rows = panels(shot, len(CASES))
    figure.film(", ".join(CASES), [named(row, list(CASES), BOX, 2) for row in rows], rate_hz=12.0)
    crops = [[picture.crop(BOX) for picture in pictures] for pictures in zip(*rows, strict=True)]
    changes = [255 * change(pictures) for pictures in crops]
    figure.plot = draw_changes(rows[0][0], changes)
    points = dict(zip(CASES, (float(np.mean(c)) for c in changes), strict=True))
    figure.number("mean change of the displayed values, 0 to 255, by case", points)
    said = []
    for name, row in zip(CASES, path.rows, strict=False):
        steady, jitter = row["stability"], row["stability"]["jitter_px"]
        said.append(
            f"{name}, the enlarged part changes {points[name] / points['ray traced']:.1f} times as much from frame "
            f"to frame as ray traced, points tremble by {jitter['median']:.2f} px (median) and {jitter['p95']:.2f} px "
            f"(p95), and {steady['pops']} of {FRAMES - 1} steps pop"
        )
    speed = path.rows[0]["stability"]["speed_px"]
    figure.finding(f"Mirrored points move by {speed:.2f} px a frame. " + "; ".join(said).capitalize() + ".")


def draw_changes(still, changes) -> plt.Figure:
    """The first frame with the part that is enlarged, and the part's changes from frame to frame."""
    plot, (picture, chart) = plt.subplots(
        1, 2, figsize=(9.6, 3.4), layout="constrained", width_ratios=(1.3, 1)
    )
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    picture.imshow(still)
    left, top, right, bottom = BOX
    picture.add_patch(Rectangle((left, top), right - left, bottom - top, fill=False, ec="#e8590c", lw=1.3))
    picture.set(xticks=[], yticks=[])
    picture.spines[:].set_visible(False)
    for values, name, colour in zip(changes, CASES, COLOURS, strict=False):
        chart.plot(range(1, FRAMES), values, "o-", ms=3, color=colour, label=name)
    chart.set(xlabel="frame", ylabel="change from the frame\nbefore, of 255", ylim=(0, None))
    chart.grid(color=GRID, lw=0.6)
    chart.legend(fontsize=8)
    return plot


if __name__ == "__main__":
    main(__file__, __doc__, draw)
