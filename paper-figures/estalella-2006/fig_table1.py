"""Estalella et al. 2006, Table 1: how long the searches are.

To be seen: Neighbourhoods looked at by a search on the way to its texel, on the three paths, with
searches that start where the frame before ended, and from the centre. The paper's caption of its first
row allows two readings: the largest of the frames' means, and the mean of the frames' maxima.

Claim: "Max frame average is the average maximum number of iterations for the search at each frame.
Total average is the search length average for the entire sequence": 14.9, 71.2, 7.5 and 4.7, 4.2, 3.3.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import follow, main, render
from mirrorfigures.charts import COLOURS

# Scene, longest edge in metres, frames, and the paper's two rows.
PATHS = {
    "Kitchen": ("kitchen-table1", 0.37, 193, 14.9, 4.7),
    "UFO": ("ufo", 3.7, 241, 71.2, 4.2),
    "Ant": ("ants", 0.14, 241, 7.5, 3.3),
}
# The paper states no size; its card is of the time of 640 pixels a line.
TEXTURE = 640
# Search lengths depend on the textures alone, so the view may be small.
SIZE = "160x90"
STARTS = ("from the frame before", "from the centre")
HEADER = [
    "path", "searches start", "largest frame mean", "mean of frame maxima", "total average",
    "paper: max frame average", "paper: total average",
]  # fmt: skip


def draw(figure):
    plot, axes = plt.subplots(1, 3, figsize=(9.6, 3.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))
    rows, said = [], []
    for axis, (path, (scene, edge, frames, paper_max, paper_mean)) in zip(axes, PATHS.items(), strict=True):
        case = f"virtual-objects:texture={TEXTURE},subdivide={edge}"
        run = follow(scene, [case], size=SIZE, frames=f"0..{frames}")
        # A search from the centre knows nothing of the frame before, so some frames will do.
        sampled = np.linspace(0, frames - 1, 9).astype(int).tolist()
        cold = [render(scene, case, frame=frame, size=SIZE) for frame in sampled]
        figure.cite(run, *cold)
        series(axis, range(frames), run.path_counters(run.row), STARTS[0], COLOURS[0], "-")
        series(axis, sampled, [r.row["counters"] for r in cold], STARTS[1], COLOURS[1], "o")
        axis.axhline(paper_mean, color="#66707c", lw=0.8, ls=":", label="paper, total average")
        axis.set(title=path, xlabel="frame", yscale="log")
        axis.grid(color="#e7eaee", lw=0.6)
        for start, counters in zip(STARTS, (run.path_counters(run.row), [r.row["counters"] for r in cold])):
            means, most = lengths(counters)[1:]
            cells = [f"{v:.1f}" for v in (means.max(), most.mean(), means.mean())]
            rows.append([path, start, *cells, str(paper_max), str(paper_mean)])
            said += [f"{path} {', '.join(cells)}"] if start == STARTS[0] else []
    axes[0].set_ylabel("neighbourhoods a search, mean of a frame")
    axes[0].legend(fontsize=7)
    figure.plot = plot
    figure.table("Search lengths", HEADER, rows)
    figure.finding(
        "Starting from the frame before, its first frame included (largest frame mean, mean of frame maxima, "
        f"total average): {'; '.join(said)}. A neighbourhood that only confirms the start counts as one."
    )


def series(axis, frames, counters, label, colour, style):
    kept, means, _ = lengths(counters)
    axis.plot(np.array(frames)[kept], means, style, color=colour, label=label, ms=4)


def lengths(counters):
    """Places of the frames that search at all, and the mean and greatest length of their searches."""
    kept = [i for i, c in enumerate(counters) if c["searches"]]
    means = np.array([counters[i]["steps"] / counters[i]["searches"] for i in kept])
    return kept, means, np.array([counters[i]["max-steps"] for i in kept])


if __name__ == "__main__":
    main(__file__, __doc__, draw)
