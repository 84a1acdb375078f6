"""Speed against accuracy: what each method costs a frame, and how much of the mirror it gets wrong.

To be seen: One panel a scene. Right is slower, low is better; bars are 95 % intervals of the median;
the dotted line is the same frame without any reflection.
"""

from mirrorfigures import bench, main
from mirrorfigures.charts import speed_against_accuracy
from mirrorfigures.text import ratio

# What would be done today comes first: ratios are to it.
CASES = [
    "ray-traced",
    "environment-map",
    "environment-map:index=surface",
    "z-buffered-map@published",
    "z-buffered-map@revised",
    "distance-impostor@published",
    "distance-impostor@revised",
    "screen-space",
    "none",
]
SCENES = {
    "columns": CASES,
    "patow-room": CASES,
    "kitchen": CASES,
    "lecture": [*CASES, "planar-mirror"],
    "glass-sphere": CASES,
    "hall-of-mirrors": CASES,
}


def draw(figure):
    runs = {
        scene: bench(scene, cases, size="1280x720", frames="0..1", repeat=20)
        for scene, cases in SCENES.items()
    }
    figure.cite(*runs.values())
    header = ["scene", "case", "frame, GPU ms", "ratio to the first of the scene", "bad at 1 px"]
    rows = [cells(row) for run in runs.values() for row in run.rows]
    figure.table("What a frame costs", header, rows)
    figure.plot = speed_against_accuracy({scene: run.rows for scene, run in runs.items()})


def cells(row):
    bad = 100 * row["accuracy"]["bad_share"]["1"]
    milliseconds = f"{row['frame_gpu_ms']['median']:.2f}"
    return [row["scene"]["name"], row["case"], milliseconds, ratio(row) or "1", f"{bad:.1f} %"]


if __name__ == "__main__":
    main(__file__, __doc__, draw)
