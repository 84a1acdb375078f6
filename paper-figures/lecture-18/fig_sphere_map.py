"""Lecture 18, "Sphere map": the picture of a small mirror ball, taken as a map of all directions.

To be seen: Left, the map a ball of 0.2 m gives at the middle of Patow's room, seen from the front in
parallel light; six colours for the room's six walls, the front one (yellow, behind the viewer) in the
middle, the back one (blue, behind the ball) squeezed into the rim. Right, a mirror lit by that picture.

Claim: "if you are given the reflection of a scene in a small spherical mirror, then you can compute what
any mirror object looks like". How much of the scene the ball shows is asked; 360 degrees is the answer.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main, render
from mirrorfigures.evidence import object_ids
from mirrorfigures.exr import read_channels

SCENE, CASE, SIZE = "patow-room", "environment-map:projection=sphere,source=ball", "600x600"
WALLS = ("front", "left", "right", "floor", "ceiling", "back")


def draw(figure):
    run = render(SCENE, CASE, size=SIZE, dump="environment-map/ball")
    truth = render(SCENE, "truth", size=SIZE)
    figure.cite(run, truth)
    folder = run.files / "dump" / "environment-map" / "ball"
    radiance = read_channels(folder / "map_radiance.exr")
    ids = read_channels(folder / "map_ids.exr")["R"].astype(np.uint32)
    picture = images.to_srgb(np.stack([radiance[c] for c in "RGB"], axis=-1))
    side = len(ids)
    t, s = np.meshgrid(np.linspace(1, -1, side), np.linspace(-1, 1, side), indexing="ij")
    inside = s * s + t * t < 1
    plot, axes = plt.subplots(1, 3, figsize=(10.2, 3.9), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.94))
    drawn = [images.to_srgb(r.frame().colour) for r in (run, truth)]
    shown = (np.where(inside[..., None], picture, 1.0), *drawn)
    titles = (f"the ball's picture, {side} texels across", "mirror by that picture", "ray-traced truth")
    for axis, image, title in zip(axes, shown, titles, strict=True):
        axis.imshow(image, interpolation="antialiased")
        axis.set_title(title)
        axis.axis("off")
    figure.plot = plot
    # Every texel inside the disc stands for the same solid angle (see the figure "rim").
    named = {wall: i for wall, i in object_ids(run.row).items() if wall in WALLS}
    shares = {wall: float((ids[inside] == i).mean()) for wall, i in named.items()}
    figure.number("share of the directions by wall", shares)
    figure.table("What the ball shows", ["wall", "share of all directions, %"],
                 [[wall, f"{100 * share:.1f}"] for wall, share in shares.items()])
    seen = sum(share > 0 for share in shares.values())
    figure.finding(
        f"The picture shows {seen} of the room's 6 walls, the one behind the ball with "
        f"{100 * shares.get('back', 0):.0f} % of all directions; only the single direction straight behind the "
        "ball has no place of its own, as the whole rim shows it."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
