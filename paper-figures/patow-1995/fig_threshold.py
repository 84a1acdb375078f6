"""Patow 1995, section 3: the tolerable limit, "to prevent wrong reflections".

To be seen: Mirror pixels that show the background where a surface ought to be, and such that show
another object, against the limit. A low limit rejects what the map's coarseness puts beside the ray;
a finer map allows a lower one. A high limit adds ghosts beside edges, but few: most pixels of another
object are not let in by the limit at all. Their rays meet two surfaces, one behind the other, and of two
good angles the better wins. Neither a lower limit nor a finer map helps against that.

Claim: The limit "was set to approximately one degree" (section 5).
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, main
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.figure import QUIET

LIMITS = (0.05, 0.1, 0.2, 0.5, 1, 2, 3, 5, 10)
SIZES = (300, 1024)
KINDS = {"missing": "missing: holes", "wrong_object": "of another object"}


def draw(figure):
    cases = {
        (size, limit): f"z-buffered-map:search=image,line=touched,size={size},threshold_deg={limit}"
        for size in SIZES
        for limit in LIMITS
    }
    run = bench("patow-room", list(cases.values()), size="300x300", frames="0..1", repeat=1)
    figure.cite(run)
    shares = {key: row["accuracy"] for key, row in zip(cases, run.rows, strict=True)}
    plot, axis = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    for (kind, label), colour in zip(KINDS.items(), COLOURS, strict=False):
        for size, style in zip(SIZES, ("o-", "s--"), strict=True):
            series = [100 * shares[size, limit][kind] for limit in LIMITS]
            axis.plot(LIMITS, series, style, color=colour, label=f"{label}, faces of {size}")
    axis.axvline(1, color=QUIET, lw=1, ls=":")
    axis.annotate("his limit", (1, 30), xytext=(4, 0), textcoords="offset points", color=QUIET)
    axis.set(xscale="log", xlabel="tolerable limit, degrees", ylabel="% of mirror pixels")
    axis.set_yscale("symlog", linthresh=0.1)
    axis.set_xticks(LIMITS, [f"{limit:g}" for limit in LIMITS])
    axis.minorticks_off()
    axis.set_ylim(0, 100)
    axis.grid(color=GRID, lw=0.6)
    axis.legend(fontsize=7.5)
    figure.plot = plot
    limits = (0.1, 1, 10)
    missing, other = (", ".join(percent(shares[300, limit], kind) for limit in limits) for kind in KINDS)
    figure.finding(
        f"With faces of 300, at 0.1, 1 and 10 degrees {missing} are missing and {other} of another object."
    )


def percent(shares, kind):
    return f"{100 * shares[kind]:.2f} %"


if __name__ == "__main__":
    main(__file__, __doc__, draw)
