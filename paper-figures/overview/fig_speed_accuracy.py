"""Speed against accuracy: what each method costs a frame, and how much of the mirror it gets wrong.

To be seen: One panel a scene. Right is slower, low is better; bars are 95 % intervals of the median;
the dotted line is the same frame without any reflection.
"""

from mirrorfigures import bench, main
from mirrorfigures.charts import speed_against_accuracy

MAPS = ["environment-map", "environment-map:index=surface"]
SCENES = {
    "columns": ["none", *MAPS],
    "patow-room": ["none", *MAPS],
    "kitchen": ["none", *MAPS],
    "lecture": ["none", *MAPS, "planar-mirror"],
}


def draw(figure):
    runs = {
        scene: bench(scene, cases, size="1280x720", frames="0..1", repeat=20)
        for scene, cases in SCENES.items()
    }
    figure.cite(*runs.values())
    figure.plot = speed_against_accuracy({scene: run.rows for scene, run in runs.items()})


if __name__ == "__main__":
    main(__file__, __doc__, draw)
