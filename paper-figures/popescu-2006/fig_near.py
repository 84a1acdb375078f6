"""Impostors at a mirror and beyond it: things that intersect, and extreme magnification (our scenes).

To be seen: A mirror ball sunk into the floor and pierced by a rod and a box, an egg in a block, a ring round a post;
and a painted statue of 9 cm that a hollow dish shows ever larger on its way to the focus, ray traced above. Below,
bad pixels at 1 px of both scenes, the second over the statue's way: billboards and depth images, published and revised.

Claim: "No support for objects very close to the reflector" (34); "reflection distortion hides impostor artifacts" (9).
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS

CASES = {
    "billboards": "billboard-impostors",
    "billboards, revised": "billboard-impostors@revised",
    "depth images": "depth-impostors:size=256",
    "depth images, revised": "depth-impostors@revised:size=256,step_deg=10",
}
# The statue's middle from the dish, metres, by frame.
WAY = {0: 0.15, 48: 0.43, 72: 0.57, 84: 0.64, 92: 0.69, 96: 0.71}
DISH, SUNK = "160x120", "320x180"
SHOWN = (48, 84, 96)


def draw(figure):
    plot = plt.figure(figsize=(9.6, 5.6), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    above, below = plot.subfigures(2, 1, height_ratios=(1.0, 1.3))
    pictures(figure, above.subplots(1, 1 + len(SHOWN), width_ratios=[16 / 12] + [1] * len(SHOWN)))
    sunk, dish = below.subplots(1, 2, width_ratios=(1.0, 1.6))
    rows = []
    for i, ((name, case), colour, marker) in enumerate(zip(CASES.items(), COLOURS, MARKERS, strict=False)):
        once = bad(figure, "half-sunk", case, 0, SUNK)
        sunk.barh(-i, once, color=colour)
        along = [bad(figure, "dish-close", case, frame, DISH) for frame in WAY]
        dish.plot(list(WAY.values()), along, color=colour, marker=marker, ms=4, label=name)
        rows.append([name, f"{once:.1f} %", *(f"{share:.2f} %" for share in along)])
    sunk.set(title="half-sunk", xlabel="bad at 1 px, % of mirror pixels")
    sunk.set_yticks([-i for i in range(len(CASES))], list(CASES), fontsize=8)
    dish.set(title="dish-close", xlabel="statue from the dish, m", ylabel="bad at 1 px, %", ylim=(0, None))
    dish.legend(fontsize=7.5)
    for axis in (sunk, dish):
        axis.grid(color=GRID, lw=0.6)
        axis.set_axisbelow(True)
    figure.plot = plot
    header = ["case", "half-sunk", *(f"{at:g} m" for at in WAY.values())]
    figure.table("Bad at 1 px", header, rows)
    said = "; ".join(f"{row[0]} {row[1]} and {row[-1]}" for row in rows)
    figure.finding(f"Bad at 1 px where things intersect, and where the dish magnifies most: {said}.")


def pictures(figure, axes):
    views = [("half-sunk", 0, SUNK)] + [("dish-close", frame, "240x180") for frame in SHOWN]
    for axis, (scene, frame, size) in zip(axes, views, strict=True):
        run = render(scene, "truth", frame=frame, size=size)
        figure.cite(run)
        axis.imshow(images.to_srgb(run.frame().colour), interpolation="nearest")
        axis.set(title=scene if scene == "half-sunk" else f"{WAY[frame]:g} m", xticks=[], yticks=[])
        axis.spines[:].set_visible(False)


def bad(figure, scene, case, frame, size):
    run = render(scene, case, frame=frame, size=size)
    figure.cite(run)
    return 100 * run.row["accuracy"]["bad_share"]["1"]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
