"""Popescu et al. 2006, slides 24 to 28: the border between billboard and environment map, and ray morphing.

To be seen: A mirror ball on a table whose near part is a billboard and whose far part the environment map shows
(red). Without ray morphing the pattern breaks off at the border, since the map knows only directions; with it the
map is looked up, in a margin (green), in a direction between that of the plane's point as seen from the map's
centre and the ray's own, and the pattern goes on.

Claim: "Transition from impostor to environment map (red in left image) is discontinuous" (24); with ray morphing,
"Left - continuous transition. Right - morph region (green), environment map (red)" (27).
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main, render
from mirrorfigures.billboards import METHOD, far_regions, tinted
from mirrorfigures.evidence import object_ids
from mirrorfigures.variants import changed

SIZE = "240x240"
MARGIN = 0.15
NEAR = ("table", "vase", "teapot", "ball")
FAR_CAMERA = """fov_deg = 28.0
eye = [0.0, 1.4, 3.6]
target = [0.0, 0.3, 0.0]
"""
# On the ball from above, where the table's near part ends.
CAMERA = """fov_deg = 24.0
eye = [0.9, 1.6, 1.6]
target = [0.7, 0.36, 0.1]
"""


def draw(figure):
    scene = changed("table", FAR_CAMERA, CAMERA)
    truth = render(scene, "truth", size=SIZE)
    without = render(scene, f"{METHOD}:morph=0", size=SIZE)
    morphed = render(scene, f"{METHOD}:morph={MARGIN}", size=SIZE)
    figure.cite(truth, without, morphed)
    ids = object_ids(without.row)
    near = [i for name, i in ids.items() if name.split(".")[0] in NEAR]
    cut, smooth = without.frame(), morphed.frame()
    red, green = far_regions(cut, smooth, near)
    panels = {
        "ray traced": images.to_srgb(truth.frame().colour),
        "no morphing": images.to_srgb(cut.colour),
        "environment map": tinted(cut, red | green),
        "ray morphing": images.to_srgb(smooth.colour),
        "margin, environment map": tinted(smooth, red, green),
    }
    plot, axes = plt.subplots(1, len(panels), figsize=(15, 3.4), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.94), w_pad=0.02)
    for axis, (name, picture) in zip(axes, panels.items(), strict=True):
        axis.imshow(picture, interpolation="nearest")
        axis.set(title=name, xticks=[], yticks=[])
        axis.spines[:].set_visible(False)
    figure.plot = plot
    shares = [run.row["accuracy"]["bad_share"]["1"] for run in (without, morphed)]
    figure.finding(
        f"{green.sum() / cut.mirror.sum():.1%} of the mirrors' pixels are morphed. Bad at 1 px without morphing "
        f"{shares[0]:.1%}, with it {shares[1]:.1%}."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
