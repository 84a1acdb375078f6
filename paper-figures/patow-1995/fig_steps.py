"""Patow 1995, section 3: how many steps of t, and in which unit of length.

To be seen: Left, mirror pixels that go wrong against the number of steps. The steps of equation (1) are
counted in the unit that lengths have: the same room measured in centimetres or kilometres takes other
steps, and shows other pictures. Right, what the steps make of the texels of the arc: some are examined
more than once, others never. Lines drawn in the map's own texels depend on neither.

Claim: With a small step for t "many pixels of the reflection plane could be examined more than once, or
even not examined at all, depending on the step value taken. That is why the best solution is to iterate
in the environment map image precision space" (section 3); his step is 1/200 (section 5).
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, main
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.figure import QUIET

STEPS = (50, 100, 200, 500, 1000, 2000)
METRES = "t alone, metres"
SEARCHES = {
    METRES: "search=vector",
    "t alone, centimetres": "search=vector,unit_m=0.01",
    "t alone, kilometres": "search=vector,unit_m=1000",
    "t, then a line (his Fig. 7), metres": "search=hybrid",
}
COUNTERS = {"texels-again": "examined again", "texels-skipped": "never examined"}
IMAGE = "z-buffered-map:search=image,line=touched"


def draw(figure):
    cases = {
        (label, steps): f"z-buffered-map:{search},steps={steps}"
        for label, search in SEARCHES.items()
        for steps in STEPS
    }
    run = bench("patow-room", [*cases.values(), IMAGE], size="300x300", frames="0..1", repeat=1)
    figure.cite(run)
    *rows, image = run.rows
    rows = dict(zip(cases, rows, strict=True))
    plot, (errors, texels) = plt.subplots(1, 2, figsize=(9.6, 4.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    for label, colour in zip(SEARCHES, COLOURS, strict=False):
        series = [100 * bad_share(rows[label, steps]) for steps in STEPS]
        errors.plot(STEPS, series, "o-", color=colour, label=label)
    errors.axhline(100 * bad_share(image), color=QUIET, lw=1, ls=":", label="lines on all faces")
    for (counter, label), style in zip(COUNTERS.items(), ("o-", "s--"), strict=True):
        series = [each(rows[METRES, steps], counter) for steps in STEPS]
        texels.plot(STEPS, series, style, color=COLOURS[0], label=label)
    touched = each(image, "texels")
    texels.axhline(touched, color=QUIET, lw=1, ls=":", label="texels the arc touches")
    errors.set(title="error", ylabel="bad at 1 px, % of mirror pixels")
    texels.set(title="texels examined again, and never", ylabel=f"texels a mirror pixel ({METRES})")
    for axis in (errors, texels):
        axis.set(xscale="log", yscale="log", xlabel="steps from t = 0 to 1")
        axis.set_xticks(STEPS, [str(steps) for steps in STEPS])
        axis.minorticks_off()
        axis.grid(color=GRID, lw=0.6)
        axis.legend(fontsize=7.5)
    figure.plot = plot
    his = rows[METRES, 200]
    wrong = ", ".join(f"{100 * bad_share(rows[label, 200]):.1f} % ({label})" for label in SEARCHES)
    figure.finding(
        f"At his 200 steps in metres a pixel examines {each(his, 'texels-again'):.0f} texels again and "
        f"leaves out {each(his, 'texels-skipped'):.0f} of the {touched:.0f} its arc touches. Bad at 1 px: "
        f"{wrong}, and {100 * bad_share(image):.1f} % by lines on all faces."
    )


def each(row, counter):
    return row["counters"][counter] / row["reflector_pixels"]


def bad_share(row):
    return row["accuracy"]["bad_share"]["1"]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
