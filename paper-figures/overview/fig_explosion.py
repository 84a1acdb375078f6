"""Explosion maps: exact on their spheres, and how fast that is lost off them.

To be seen: Half of the pixels of a mirror sphere that show a shell about it are drawn less than so far from
where they belong. To the right the shell's radius over that of the sphere, or of the near one of two; the far
one is four times as large. One sphere errs the more the farther the shell is from it; two are exact on both, and
between them err less if they are blended by inverse distance; walks from triangle to triangle need no sphere.

Claim: A look-up by direction is exact for vertices on the sphere; nearer and farther ones need a near map
and a far one (Ofek & Rappoport 1998, as Blythe's course notes of 1999 tell it).
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, main, paths
from mirrorfigures.charts import COLOURS, GRID, MARKERS

SIZE = "240x180"
# Radius of the near sphere, in radii of the mirror: it holds the eye, and so do the shells.
NEAR = 4
FAR = 4 * NEAR
# Radii of the shells, in those of the near sphere.
SHELLS = [0.6, 0.75, 0.9, 1.0, 1.2, 1.5, 2.0, 3.0, 4.0, 8.0, 16.0]
CASES = {
    f"explosion-map@published:radius={NEAR},spheres=1,subdivide=0": "one sphere",
    f"explosion-map@published:blend=linear,far={FAR},radius={NEAR},subdivide=0": "two, blended by distance",
    f"explosion-map@published:far={FAR},radius={NEAR},subdivide=0": "two, blended by its inverse",
    f"explosion-map@revised:radius={NEAR},subdivide=0": "revised: walks",
}

SCENE = """
about = "A mirror sphere and an eye in a shell of {radius} m"

[camera]
fov_deg = 60.0
eye = [0.3, 0.4, 2.1]
target = [0.0, 0.0, 0.0]

[environment]
colour = [0.6, 0.7, 0.8]

[materials]
mirror = {{ mirror = {{ reflectance = 1.0 }} }}
grey = {{ colour = [0.5, 0.5, 0.5] }}

[[objects]]
name = "mirror"
shape = {{ sphere = {{ radius = 1.0, slices = 192, stacks = 96 }} }}
material = "mirror"

[[objects]]
name = "shell"
shape = {{ sphere = {{ radius = {radius}, slices = 192, stacks = 96 }} }}
material = "grey"
"""


def scene(radius):
    """The scene file of a shell, beside the runs."""
    folder = paths.out() / ".scenes"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"shell-{radius:g}.toml"
    path.write_text(SCENE.format(radius=float(radius)), encoding="utf-8")
    return str(path)


def draw(figure):
    errors = {label: [] for label in CASES.values()}
    for ratio in SHELLS:
        run = bench(scene(NEAR * ratio), list(CASES), size=SIZE, frames="0..1", repeat=1)
        figure.cite(run)
        for row, label in zip(run.rows, CASES.values(), strict=True):
            errors[label].append(row["accuracy"]["displacement_px"]["median"])
    plot, axis = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    for (label, line), colour, marker in zip(errors.items(), COLOURS, MARKERS, strict=False):
        axis.plot(SHELLS, line, color=colour, marker=marker, ms=4, label=label)
    ticks = [0.6, 1, 2, 4, 8, 16]
    axis.set(xscale="log", yscale="log", xlabel="distance of the shell / radius of the near sphere (log)")
    axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axis.set_xticks([], minor=True)
    axis.set_ylabel("median displacement, px (log)")
    axis.set_title(f"mirror sphere across a view of {SIZE}")
    axis.grid(color=GRID, lw=0.6)
    axis.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1, 0.1))
    figure.plot = plot
    table = [
        [f"{ratio:g}", *(f"{errors[label][i]:.3f}" for label in errors)] for i, ratio in enumerate(SHELLS)
    ]
    figure.table("Median displacement, px", ["distance / radius", *errors], table)
    revised = errors["revised: walks"]
    one = errors["one sphere"]
    figure.finding(
        f"One sphere: {one[SHELLS.index(1.0)]:.3f} px on it, {one[SHELLS.index(2.0)]:.1f} px at twice its "
        f"radius, {one[-1]:.1f} px at {SHELLS[-1]:g} times. Walks: at most {max(revised):.3f} px."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
