"""Patow 1995, section 6: what a reflective pixel costs beside an environment map's.

To be seen: Left, the time of the reflecting pass over that of three environment maps: Blinn & Newell's
polar lookup, which is his baseline, a fetch from a cube map, and a filtered one. Bars are 95 %
intervals; the band is what he measured, the dashed line what he hoped for. Right, the work behind it.

Claim: "About 10 - 15 (that is, the last one is ten to fifty times slower than the first one)"; the
hybrid "is three times faster than the search completely done in vector space", so a search completely
in image space "should be about 5" (section 6).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import bench, main
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.figure import QUIET

BASELINES = {
    "polar lookup": "environment-map:projection=latlong",
    "cube fetch": "environment-map:filter=nearest",
    "filtered cube fetch": "environment-map:filter=mip",
}
SEARCHES = {
    "t alone": "z-buffered-map:search=vector",
    "t, then a line\n(his Fig. 7)": "z-buffered-map",
    "lines on all faces": "z-buffered-map:search=image",
    "all texels touched": "z-buffered-map:search=image,line=touched",
}
MEASURED, HOPED, HYBRID_GAIN = (10, 50), 5, 3


def draw(figure):
    cases = [*BASELINES.values(), *SEARCHES.values()]
    run = bench("patow-room", cases, size="600x600", frames="0..1", repeat=30)
    figure.cite(run)
    rows = dict(zip([*BASELINES, *SEARCHES], run.rows, strict=True))
    times = {label: reflecting(run, row) for label, row in rows.items()}
    ratios = {(s, b): ratio(times[s], times[b]) for s in SEARCHES for b in BASELINES}
    plot, (costs, work) = plt.subplots(1, 2, figsize=(9.6, 4.3), layout="constrained", sharey=True)
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    places = np.arange(len(SEARCHES))[::-1]
    costs.axvspan(*MEASURED, color=QUIET, alpha=0.15, lw=0, label="he measured")
    costs.axvline(HOPED, color=QUIET, lw=1, ls="--", label="he hoped for")
    for i, (baseline, colour, marker) in enumerate(zip(BASELINES, COLOURS, MARKERS, strict=False)):
        middle, low, high = np.array([ratios[s, baseline] for s in SEARCHES]).T
        costs.errorbar(
            middle, places + 0.2 * (1 - i), xerr=[middle - low, high - middle],
            fmt=marker, color=colour, ms=6, capsize=3, label=f"over a {baseline}",
        )  # fmt: skip
    costs.set(xscale="log", xlabel="reflecting pass over the environment map's (log)", xlim=(1, 100))
    costs.set_yticks(places, SEARCHES)
    costs.set_title("cost of a reflective pixel")
    counted = ("texels", "texels-again")
    examined, again = (np.array([each(rows[s], counter) for s in SEARCHES]) for counter in counted)
    work.barh(places, examined - again, 0.5, color=COLOURS[0], label="texels examined")
    work.barh(places, again, 0.5, left=examined - again, color=COLOURS[4], label="of them again")
    work.set(xlabel="a mirror pixel", xlim=(0, 1.05 * examined.max()))
    work.set_title("work")
    for axis, columns in ((costs, 3), (work, 2)):
        axis.set_axisbelow(True)
        axis.grid(axis="x", color=GRID, lw=0.6)
        axis.legend(fontsize=7.5, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=columns)
    figure.plot = plot
    conclude(figure, ratios, rows, times)


def conclude(figure, ratios, rows, times):
    header = ["search", *(f"over a {baseline}" for baseline in BASELINES), "texels", "map reads"]
    figure.table("Cost of a reflective pixel", header, [
        [
            " ".join(s.split()),
            *(said(ratios[s, baseline]) for baseline in BASELINES),
            f"{each(rows[s], 'texels'):.0f}",
            f"{each(rows[s], 'map-reads'):.0f}",
        ]
        for s in SEARCHES
    ])  # fmt: skip
    vector, hybrid, image, _ = SEARCHES
    gain = ratio(times[vector], times[hybrid])
    fewer = each(rows[vector], "texels") / each(rows[hybrid], "texels")
    figure.number("vector_over_hybrid", {"time": gain, "texels": fewer})
    over_polar = {s: said(ratios[s, "polar lookup"]) for s in SEARCHES}
    figure.finding(
        f"Over a polar lookup the hybrid takes {over_polar[hybrid]} times as long (he measured "
        f"{MEASURED[0]} to {MEASURED[1]}), the search in image space {over_polar[image]} (he hoped for "
        f"{HOPED}). Search by t alone takes {said(gain)} times as long as the hybrid and examines "
        f"{fewer:.2f} times as many texels (he measured {HYBRID_GAIN} times the time)."
    )


def reflecting(run, row):
    """Milliseconds of the pass that answers the mirror's pixels, a value a frame."""
    return np.array(run.pass_ms(row, f"{row['method']}/reflect"))


def ratio(case, baseline):
    """Median of the ratios of frames played in the same round, and its 95 % bootstrap interval."""
    frames = min(len(case), len(baseline))  # throttled ones were dropped
    ratios = np.log(case[:frames] / baseline[:frames])
    random = np.random.default_rng(1)
    medians = np.median(random.choice(ratios, (2000, len(ratios))), axis=1)
    return [float(x) for x in np.exp([np.median(ratios), *np.percentile(medians, [2.5, 97.5])])]


def each(row, counter):
    return row["counters"][counter] / row["reflector_pixels"]


def said(ratio):
    middle, low, high = ratio
    return f"{middle:.1f} ({low:.1f}–{high:.1f})"


if __name__ == "__main__":
    main(__file__, __doc__, draw)
