"""Martin & Popescu 2004, Figure 6: the reflection mesh.

To be seen: The morphed triangles of columns, cube and floor as a wireframe, seen from the eye, over the mirror
that the stencil keeps them in, and the picture they give. Triangles with a vertex that one of the eight sampling
locations does not see are left out: holes, and the ragged rim. What is hidden is not removed here, the other
side of the columns too.

Claim: "Figure 6 shows the reflection mesh obtained by rendering the triangles connecting the morphed vertices".
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

from mirrorfigures import images, main
from mirrorfigures.cameras import camera
from mirrorfigures.figure import INK
from mirrorfigures.morphing import morphed

SCENE, SIZE, FRAME = "columns", "1280x720", 12


def draw(figure):
    drawn = morphed(SCENE, FRAME, SIZE)
    figure.cite(drawn.run)
    frame = drawn.run.frame()
    view = camera(SCENE, FRAME, SIZE)
    width, height = (int(n) for n in SIZE.split("x"))
    whole = drawn.valid[drawn.triangles].all(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = view.place(drawn.images) * (width, height) - 0.5
    shapes = pixels[drawn.triangles[whole]]
    left, top, right, bottom = images.box_around(frame.mirror)
    plot, axes = plt.subplots(1, 2, figsize=(9.6, 5.0), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    axes[0].imshow(np.where(frame.mirror[..., None], 0.93, 1.0) * np.ones(3), interpolation="nearest")
    axes[0].add_collection(PolyCollection(shapes, facecolors="none", edgecolors=INK, linewidths=0.12))
    axes[0].set_title("reflection mesh")
    axes[1].imshow(images.to_srgb(frame.colour), interpolation="nearest")
    axes[1].set_title("picture")
    for axis in axes:
        axis.set(xticks=[], yticks=[], xlim=(left - 8, right + 8), ylim=(bottom + 8, top - 8))
    figure.plot = plot
    figure.number("triangles, and those with three valid vertices", [len(whole), int(whole.sum())])
    figure.finding(f"Of {len(whole):,} triangles {whole.sum():,} have three valid vertices and are drawn.")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
