"""Columns: how far the environment map draws them from their place.

To be seen: Left, the displacement of the columns' points against their gap to the mirror sphere, as
the camera nears; right, the same against the camera's distance, for the inner and the outer ring.
Lines are medians, the band reaches from the 5th to the 95th percentile.

Claim: "in some situations, a reflected point is drawn hundreds of pixels away from its correct
location" (Martin & Popescu 2004, abstract). Expected here: 20 to 40 px from 4 m, over 100 from 1.6.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS
from mirrorfigures.evidence import displacement, distance_to_mirror, object_ids

SCENE = "columns-dolly"
FRAMES = range(0, 193, 32)
# The mirror sphere of the scene.
CENTRE, RADIUS_M = np.array([0.0, 1.0, 0.0]), 1.0
# The inner ring's columns stand 0.45 m from the sphere, the outer ring's 2.35 m.
RING_LIMIT_M = 1.4
GAP_BINS_M = np.linspace(0.4, 3.4, 16)


def draw(figure):
    samples = [sample(figure, frame) for frame in FRAMES]
    plot, (by_gap, by_distance) = plt.subplots(1, 2, figsize=(8.4, 3.7), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    for (camera_m, moved, gap, _), colour in zip(spread(samples), COLOURS, strict=False):
        centres, bands = binned(gap, moved)
        by_gap.plot(centres, bands[1], color=colour, label=f"camera {camera_m:.1f} m from the centre")
        by_gap.fill_between(centres, bands[0], bands[2], color=colour, alpha=0.15, lw=0)
    by_gap.set(xlabel="gap from sphere to column point, m", ylabel="displacement, px")
    for inner, label, colour in ((True, "inner ring", COLOURS[1]), (False, "outer ring", COLOURS[0])):
        camera = [s[0] for s in samples]
        bands = np.array([percentiles(s[1][(s[3] < RING_LIMIT_M) == inner]) for s in samples]).T
        by_distance.plot(camera, bands[1], "o-", color=colour, label=label)
        by_distance.fill_between(camera, bands[0], bands[2], color=colour, alpha=0.15, lw=0)
    by_distance.set(xlabel="camera to sphere centre, m", ylabel="displacement, px")
    for axis in (by_gap, by_distance):
        axis.set_ylim(bottom=0)
        axis.grid(color="#e7eaee", lw=0.6)
        axis.legend(fontsize=8)
    figure.plot = plot
    report(figure, samples)


def sample(figure, frame):
    """Camera distance, and for all column pixels: displacement, gap, gap of the column's foot, where
    the nearest of its points lies."""
    truth, ours = (render(SCENE, case, frame=frame) for case in ("truth", "environment-map"))
    figure.cite(truth, ours)
    traced, mapped = truth.frame(), ours.frame()
    moved, gaps, feet = [], [], []
    for name, object_id in object_ids(ours.row).items():
        if name.startswith("column"):
            px, points = displacement(mapped, traced, object_id)
            if len(px):
                gap = np.linalg.norm(points - CENTRE, axis=1) - RADIUS_M
                moved.append(px)
                gaps.append(gap)
                feet.append(np.full(len(px), gap.min()))
    camera_m = distance_to_mirror(traced) + RADIUS_M
    return camera_m, np.concatenate(moved), np.concatenate(gaps), np.concatenate(feet)


def spread(samples):
    """First, middle and last."""
    return [samples[0], samples[len(samples) // 2], samples[-1]]


def percentiles(values):
    return np.percentile(values, [5, 50, 95]) if len(values) else [np.nan] * 3


def binned(gap, moved):
    centres = (GAP_BINS_M[1:] + GAP_BINS_M[:-1]) / 2
    which = np.digitize(gap, GAP_BINS_M) - 1
    return centres, np.array([percentiles(moved[which == i]) for i in range(len(centres))]).T


def report(figure, samples):
    rows = []
    for camera_m, moved, _, feet in samples:
        inner, outer = moved[feet < RING_LIMIT_M], moved[feet >= RING_LIMIT_M]
        bands = [v for part in (inner, outer) for v in percentiles(part)[1:]]
        cells = ["not seen" if np.isnan(v) else f"{v:.0f}" for v in bands]
        rows.append([f"{camera_m:.2f}", *cells])
    header = ["camera, m", "inner median, px", "inner p95, px", "outer median, px", "outer p95, px"]
    figure.table("Displacement of the columns in the environment map", header, rows)
    (far, far_px), (near, near_px) = (
        (s[0], s[1][s[3] < RING_LIMIT_M]) for s in (samples[0], samples[-1])
    )
    figure.finding(
        f"The inner ring's columns are {np.median(far_px):.0f} px from their place in the median seen "
        f"from {far:.1f} m, and {np.median(near_px):.0f} px seen from {near:.1f} m (1280 x 720)."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
