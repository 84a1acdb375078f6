"""Estalella et al. 2006, Figure 9: the kitchen on a concave reflector and on a section of a torus.

To be seen: Above, as published, one reflection point a vertex; in the middle every one, a mesh for each
branch; below, the same frames ray traced. Two frames of a hollow dish, in which kettle and cup stand large near the
focus, two of a quarter of a torus. With all points a strip of wall still shows through the table top in the dish, and
along the torus bits of ceiling are missing.

Claim: "(a)-(b) show a concave reflector, and (b)-(c) show a section of a torus to illustrating that the method
works in some situations with mixed curvature reflectors."
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main
from mirrorfigures.runs import render

CASES = {
    "as published": "virtual-objects",
    "all points": "virtual-objects@revised:roots=all",
    "ray traced": "truth",
}
COLUMNS = (("kitchen-hollow", 24), ("kitchen-hollow", 96), ("kitchen-torus", 0), ("kitchen-torus", 96))
SIZE = "160x120"


def draw(figure):
    plot, axes = plt.subplots(len(CASES), len(COLUMNS), figsize=(11.2, 7.4), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95), h_pad=0.02, w_pad=0.03)
    rows = []
    for column, (scene, frame) in enumerate(COLUMNS):
        errors = []
        for axis, (label, case) in zip(axes[:, column], CASES.items(), strict=True):
            run = render(scene, case, frame=frame, size=SIZE)
            figure.cite(run)
            axis.imshow(images.to_srgb(run.frame().colour), interpolation="nearest")
            axis.set_axis_off()
            axis.set_title(f"{scene} {frame}, {label}", fontsize=8)
            if case != "truth":
                errors.append(f"{100 * run.row['accuracy']['bad_share']['1']:.1f} %")
        rows.append([f"{scene} {frame}", *errors])
    figure.table("Bad at 1 px", ["frame", "as published", "all points"], rows)
    said = (f"{name}: {one} as published, {every} with all" for name, one, every in rows)
    figure.finding("Bad at 1 px, of the mirror's pixels: " + "; ".join(said) + ".")
    figure.plot = plot


if __name__ == "__main__":
    main(__file__, __doc__, draw)
