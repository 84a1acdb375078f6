"""What a scene's triangles cost a search of a captured map, and a ray tracer.

To be seen: The time of the reflecting pass against the number of triangles: `z-buffered-map@revised`
searches a map and should not depend on them, `ray-traced` follows a tree. Beside it what taking the map costs,
once wherever nothing moves. The table has after how many frames the map has paid for itself, where it ever does. The
scene is `clutter-60` with its balls cut more and more finely, so that all show the same picture.
"""

import matplotlib.pyplot as plt

from mirrorfigures import bench, main, paths
from mirrorfigures.charts import COLOURS, GRID, MARKERS

SIZE = "512x512"
SLICES = [4, 10, 24, 72, 230]
SEARCHED = "z-buffered-map@revised:size=512,layers=2"
TRACED = "ray-traced"


def scene(slices):
    """The scene file with balls of so many slices, beside the runs."""
    text = (paths.ROOT / "scenes" / "clutter-60.toml").read_text(encoding="utf-8")
    text = text.replace("slices = 24, stacks = 12", f"slices = {slices}, stacks = {max(slices // 2, 2)}")
    text = text.replace("radius = 1.0, edge = 0.05", "radius = 1.0, edge = 0.2")
    folder = paths.out() / ".scenes"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"clutter-60-slices-{slices}.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def draw(figure):
    table, triangles, reflect, capture = [], [], {SEARCHED: [], TRACED: []}, []
    for slices in SLICES:
        run = bench(scene(slices), [SEARCHED, TRACED], size=SIZE, frames="0..1", repeat=15)
        figure.cite(run)
        rows = {row["case"]: row for row in run.rows}
        triangles.append(run.rows[0]["scene"]["triangles"])
        for case, times in reflect.items():
            name = f"{rows[case]['method']}/reflect"
            times.append(min(run.pass_ms(rows[case], name)))
        capture.append(rows[SEARCHED]["prepare"]["gpu_ms"])
        gain = reflect[TRACED][-1] - reflect[SEARCHED][-1]
        frames = f"{capture[-1] / gain:.0f}" if gain > 0 else "never"
        table.append([
            f"{triangles[-1]:,}", f"{reflect[SEARCHED][-1]:.1f}", f"{reflect[TRACED][-1]:.1f}",
            f"{capture[-1]:.0f}", frames,
        ])  # fmt: skip
    plot, axis = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    lines = {**reflect, "taking the map (first call)": capture}
    for (label, times), colour, marker in zip(lines.items(), COLOURS, MARKERS, strict=False):
        axis.plot(triangles, times, color=colour, marker=marker, ms=5, label=label)
    axis.set(xscale="log", yscale="log", xlabel="triangles (log)", ylabel="GPU ms (log)")
    axis.set_title(f"reflecting pass and capture, {SIZE}")
    axis.grid(True, which="both", color=GRID, lw=0.6)
    axis.legend(fontsize=8)
    figure.plot = plot
    header = ["triangles", "searched, ms", "traced, ms", "capture, ms", "break-even, frames"]
    figure.table("Shortest reflecting pass, the capture, and when it has paid for itself", header, table)
    spread = max(reflect[SEARCHED]) / min(reflect[SEARCHED])
    figure.number("searched_spread", spread)
    grown = triangles[-1] / triangles[0]
    figure.finding(
        f"From {triangles[0]:,} to {triangles[-1]:,} triangles, {grown:.0f} times as many, the search's longest "
        f"pass takes {spread:.2f} times its shortest; the tracer's grows "
        f"{reflect[TRACED][-1] / reflect[TRACED][0]:.1f} times."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
