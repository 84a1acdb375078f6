"""A mirror that wobbles: maps captured anew each frame, beside the truth.

To be seen: Four moments of a sphere over which waves of 0.1 m run, deep enough to make hollows. A
row a method, the truth first. Columns near the mirror bend as they should where depths are searched,
and stand off where directions alone are looked up. The tables say what it costs to follow the surface.
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, images, main, render

SCENE = "columns-wobble"
MOMENTS = (0, 12, 24, 36)
TRUTH = "truth"
CASES = ["environment-map", "z-buffered-map@revised"]


def draw(figure):
    rows = [TRUTH, *CASES]
    plot, axes = plt.subplots(len(rows), len(MOMENTS), figsize=(11, 7), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.03, 1, 0.96), h_pad=0.02, w_pad=0.02)
    table = []
    for column, frame in zip(axes.T, MOMENTS, strict=True):
        bad = [str(frame)]
        for axis, case in zip(column, rows, strict=True):
            run = render(SCENE, case, frame=frame, size="400x300")
            figure.cite(run)
            axis.imshow(images.to_srgb(run.frame().colour), interpolation="nearest")
            axis.set(xticks=[], yticks=[])
            axis.spines[:].set_visible(False)
            if case != TRUTH:
                bad.append(f"{100 * run.row['accuracy']['bad_share']['1']:.1f} %")
        column[0].set_title(f"frame {frame}")
        table.append(bad)
    for axis, case in zip(axes[:, 0], rows, strict=True):
        axis.set_ylabel(case)
    figure.plot = plot
    figure.table("Bad at 1 px", ["frame", *CASES], table)
    figure.finding(
        "; ".join(
            f"{case}: bad at 1 px {', '.join(row[i] for row in table)}"
            for i, case in enumerate(CASES, start=1)
        )
        + f" in the frames {', '.join(row[0] for row in table)}."
    )
    costs(figure)


def costs(figure):
    """What keeping up with the surface takes in every frame."""
    run = bench(SCENE, ["ray-traced", *CASES], size="400x300", frames="0..12", repeat=1)
    figure.cite(run)
    table = []
    for row in run.rows:
        passes = {entry["name"]: entry for entry in row["passes"]}
        displace, copy = passes["scene/deform"]["cpu_ms"], passes["scene/vertices"]["gpu_ms"]["median"]
        prepare = row["prepare"]
        own = f"{prepare['gpu_ms']:.1f} and {prepare['cpu_ms']:.1f}"
        frame = f"{row['frame_gpu_ms']['median']:.1f}"
        table.append([row["case"], f"{displace:.2f}", f"{copy:.2f}", own, frame])
    header = ["case", "waves, CPU", "copy, GPU", "prepare, GPU and CPU", "frame without it, GPU"]
    figure.table("Milliseconds a frame", header, table)


if __name__ == "__main__":
    main(__file__, __doc__, draw)
