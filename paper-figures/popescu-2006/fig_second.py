"""Billboards in billboards, and mirrors in themselves (after slides 13 to 23 and 50).

To be seen: The table's teapot and ball as published, revised, and ray traced: the published teapot shows nothing of
its own handle, spout and lid, and what it shows of the ball is flat. Below, of the pixels where the truth meets two
mirrors, those that are bad at 1 px: the second mirror another thing, or the first one's own; by step of the revision.

Claim: "Higher order reflections: reflective billboards" (13); "flat reflection, lack of motion parallax" (34);
"self-reflections" are future work (50).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main, render
from mirrorfigures.billboards import METHOD
from mirrorfigures.charts import COLOURS, GRID

CASES = {
    "published": METHOD,
    "pictures for each mirror": f"{METHOD}@revised:relief=off,far=direction",
    "and their depths": f"{METHOD}@revised:own=0,far=direction",
    "and their own parts": f"{METHOD}@revised:far=direction",
    "revised: and the map's depths": f"{METHOD}@revised",
}
SCENES = {"four-teapots": "240x135", "table": "240x135", "pushing-it": "240x135", "hall-of-mirrors": "128x96"}
KINDS = {"other": "another mirror", "own": "the same, or its own part"}
# Of the table's picture: left, top, right, bottom, as shares.
CLOSE = (0.2, 0.25, 0.8, 0.72)


def draw(figure):
    plot = plt.figure(figsize=(9.6, 6.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    above, below = plot.subfigures(2, 1, height_ratios=(1.0, 1.45))
    pictures(figure, above.subplots(1, 3))
    axes = below.subplots(1, 2, sharey=True)
    shares = {scene: {name: seconds(figure, scene, size, case) for name, case in CASES.items()}
              for scene, size in SCENES.items()}  # fmt: skip
    table = []
    for axis, (kind, said) in zip(axes, KINDS.items(), strict=True):
        places = np.arange(len(SCENES))
        for i, (name, colour) in enumerate(zip(CASES, COLOURS, strict=False)):
            bad = [100 * shares[scene][name][kind] for scene in SCENES]
            axis.bar(places + 0.16 * (i - 2), bad, 0.16, color=colour, label=name)
            table.append([said, name, *(f"{share:.1f} %" for share in bad)])
        axis.set(title=f"second mirror: {said}", xticks=places, ylim=(0, 100))
        axis.set_xticklabels(SCENES, fontsize=8)
        axis.grid(color=GRID, lw=0.6, axis="y")
        axis.set_axisbelow(True)
    axes[0].set(ylabel="bad at 1 px, % of such pixels")
    below.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(CASES), fontsize=7.5)
    figure.plot = plot
    figure.table("Bad at 1 px where the truth meets two mirrors", ["second mirror", "case", *SCENES], table)
    first, last = table[0], table[len(CASES) - 1]
    own_first, own_last = table[len(CASES)], table[-1]
    figure.finding(
        f"Another mirror in a mirror: {span(first)} bad as published, {span(last)} revised; a mirror in itself: "
        f"{span(own_first)} and {span(own_last)}."
    )


def span(row):
    numbers = sorted(float(share.split()[0]) for share in row[2:])
    return f"{numbers[0]:.0f} to {numbers[-1]:.0f} %"


def pictures(figure, axes):
    cases = {"published": METHOD, "revised": f"{METHOD}@revised", "ray traced": "truth"}
    for axis, (name, case) in zip(axes, cases.items(), strict=True):
        run = render("table", case, size="480x270")
        figure.cite(run)
        picture = images.to_srgb(run.frame().colour)
        height, width, _ = picture.shape
        left, top, right, bottom = (round(at * side) for at, side in zip(CLOSE, (width, height) * 2, strict=True))
        axis.imshow(picture[top:bottom, left:right], interpolation="nearest")
        axis.set(title=name, xticks=[], yticks=[])
        axis.spines[:].set_visible(False)


def seconds(figure, scene, size, case):
    """Bad shares by second mirror."""
    run = render(scene, case, size=size)
    figure.cite(run)
    return {one["second"]: one["bad_share"]["1"] for one in run.row["accuracy"]["by_second"]}


if __name__ == "__main__":
    main(__file__, __doc__, draw)
