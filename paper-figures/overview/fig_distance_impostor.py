"""Distance impostors: how fine the search must be.

To be seen: The share of bad mirror pixels against the steps marched from the reflector to infinity,
a line a number of secant steps inside the step that crossed; dotted, the published search, which
starts at the texel in the mirrored direction, marches nowhere and corrects by secants alone. Left
the columns, in the middle the lecture's flat mirror, right the poles of two centimetres' radius: of
the pixels they belong in, the share that shows something else. Expected: planes need one secant;
what is thinner than a step leaks, so the poles need short ones.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.evidence import object_ids
from mirrorfigures.exr import FOUND
from mirrorfigures.figure import QUIET

SIZE = "320x180"
MARCH = [1, 4, 16, 64, 256]
REFINE = [0, 1, 3]
PUBLISHED = "distance-impostor@published"
# `march` and `refine` of @revised that its name leaves out.
DEFAULTS = {"march": 64, "refine": 3}


def case(march, refine):
    given = {"march": march, "refine": refine}
    pairs = ",".join(f"{key}={value}" for key, value in given.items() if value != DEFAULTS[key])
    return "distance-impostor@revised" + (f":{pairs}" if pairs else "")


def bad(run, _):
    return run.row["accuracy"]["bad_share"]["1"]


def leaked(run, truth):
    """Share of the poles' pixels that show something else."""
    poles = [i for name, i in object_ids(run.row).items() if name.startswith("pole")]
    traced, ours = truth.frame(), run.frame()
    theirs = traced.mirror & (traced.status == FOUND) & np.isin(traced.object, poles)
    lost = theirs & ((ours.status != FOUND) | (ours.object != traced.object))
    return lost.sum() / max(theirs.sum(), 1)


# What is drawn of each scene.
PANELS = {
    "columns": ("bad at 1 px, % of mirror pixels", bad),
    "lecture": ("bad at 1 px, % of mirror pixels", bad),
    "stress-pole": ("leaks, % of the poles' pixels", leaked),
}


def draw(figure):
    plot, axes = plt.subplots(1, len(PANELS), figsize=(9.6, 3.6), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    table = []
    for axis, (scene, (what, value)) in zip(axes, PANELS.items(), strict=True):
        cases = [PUBLISHED, *(case(m, r) for r in REFINE for m in MARCH)]
        runs = [render(scene, name, size=SIZE) for name in cases]
        truth = render(scene, "truth", size=SIZE)
        figure.cite(truth, *runs)
        share = {run.row["case"]: 100 * value(run, truth) for run in runs}
        for refine, colour, marker in zip(REFINE, COLOURS, MARKERS, strict=False):
            line = [share[case(march, refine)] for march in MARCH]
            label = f"{refine} secant step{'s' if refine != 1 else ''}"
            axis.plot(MARCH, line, color=colour, marker=marker, ms=4, label=label)
        axis.axhline(share[PUBLISHED], color=QUIET, lw=1, ls=":", label="published")
        axis.set(title=f"{scene}, {SIZE}", xscale="log", xlabel="steps marched (log)", ylim=(0, None))
        axis.set_xticks(MARCH, [str(m) for m in MARCH], minor=False)
        axis.set_xticks([], minor=True)
        axis.set_ylabel(what)
        axis.grid(color=GRID, lw=0.6)
        table += [
            [scene, name, f"{fetches(run.row):.0f}", f"{share[name]:.2f} %"]
            for name, run in zip(cases, runs, strict=True)
        ]
    axes[0].legend(fontsize=8)
    figure.plot = plot
    header = ["scene", "case", "texels fetched a pixel", "bad at 1 px; of the poles leaked"]
    figure.table("What the search costs and leaves wrong", header, table)


def fetches(row):
    return row["counters"]["fetches"] / row["reflector_pixels"]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
