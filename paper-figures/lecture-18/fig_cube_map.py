"""Lecture 18, "Cube map": the six faces of the captured environment, unfolded to a cross.

To be seen: Six images of 90 degrees, taken from the map's centre in the lecture's quiz scene and
unfolded as seen from inside. Neighbouring faces of the cross join without a seam.

Claim: "Construct 6 images, each with 90 deg field of view angle."
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main, render
from mirrorfigures.exr import cube_faces

# Where the faces +X -X +Y -Y +Z -Z go in the cross: (row, column).
CROSS = ((1, 2), (1, 0), (0, 1), (2, 1), (1, 1), (1, 3))
NAMES = ("+x", "−x", "+y", "−y", "+z", "−z")


def draw(figure):
    run = render("lecture", "environment-map", size="1280x640", dump="environment-map/capture")
    figure.cite(run)
    dumped = run.files / "dump" / "environment-map" / "capture" / "radiance.exr"
    faces = images.to_srgb(cube_faces(dumped))
    size = faces.shape[1]
    cross = np.ones((3 * size, 4 * size, 3))
    plot, axis = plt.subplots(figsize=(6.4, 4.95), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.945))
    for face, (row, column), name in zip(faces, CROSS, NAMES, strict=True):
        cross[row * size : (row + 1) * size, column * size : (column + 1) * size] = face
        axis.text((column + 0.03) * size, (row + 0.09) * size, name, color="white", fontsize=9,
                  bbox={"facecolor": "#1d2530", "edgecolor": "none", "pad": 2, "alpha": 0.7})
    axis.imshow(cross, interpolation="antialiased")
    axis.axis("off")
    figure.plot = plot
    figure.finding(f"Captured on the GPU with {size} x {size} texels a face.")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
