"""Lecture 18, "Why is that wrong? Why does it not matter?": the map's error over the distance of what it shows.

To be seen: A mirror ball of radius R and particles around it, at distance d from its surface. Left, the
angle at the mirror between the mirrored ray and the particle that the map shows there, beside its bound
asin(R / (R + d)); the largest are of the particles' near sides (dashed). Right, how far from its place on the ball the map draws a particle.

Claim: "This essentially assumes that the environment is at infinity. Why is that wrong? Why does it not
matter?" Expected here: wrong by up to asin(R / (R + d)), so not by much from ten radii on.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.evidence import displacement
from mirrorfigures.exr import FOUND, read_channels
from mirrorfigures.images import box_around
from mirrorfigures.variants import scene_file

DISTANCES = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
SIZE = "512x512"
PARTICLES = 60
# Their radius, as a share of the distance from the ball's centre.
PARTICLE = 0.03

HEAD = """about = "A mirror ball among particles"
frames = 1
[camera]
height = 2.2
eye = [0.0, 0.0, 90.0]
target = [0.0, 0.0, 0.0]
near = 1.0
[lighting]
ambient = [1.0, 1.0, 1.0]
sun = [0.0, 0.0, 0.0]
towards_sun = [0.0, 1.0, 0.0]
[environment]
colour = [0.1, 0.1, 0.1]
[materials]
mirror = { mirror = { reflectance = 1.0 } }
red = { colour = [0.8, 0.1, 0.1] }
[[objects]]
name = "ball"
shape = { sphere = { radius = 1.0, slices = 192, stacks = 96 } }
material = "mirror"
"""


def scene(distance: float) -> str:
    """Particles evenly over the sphere of radius 1 + distance, but for those before the ball or behind
    it. All look equally large from the ball's centre."""
    text = HEAD
    for i in range(PARTICLES):
        z = 1 - (2 * i + 1) / PARTICLES
        turn = i * np.pi * (3 - np.sqrt(5))
        at = np.array([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z])
        if abs(z) > 0.9:
            continue
        radius = PARTICLE * (1 + distance)
        x, y, z = (1 + distance) * at
        text += f"""[[objects]]
name = "particle-{i}"
shape = {{ sphere = {{ radius = {radius:.5f}, slices = 16, stacks = 8 }} }}
material = "red"
position = [{x:.5f}, {y:.5f}, {z:.5f}]
"""
    return scene_file("particles", text)


def draw(figure):
    angles, moved, beyond = [], [], []
    for distance in DISTANCES:
        path = scene(distance)
        truth, ours = (render(path, case, size=SIZE) for case in ("truth", "environment-map"))
        figure.cite(truth, ours)
        angle, bound = parallax(ours)
        angles.append(np.percentile(angle, [50, 100]))
        beyond.append((angle - bound).max())
        moved.append(np.percentile(displaced(truth, ours), [50, 95]))
    angles, moved = np.array(angles).T, np.array(moved).T
    plot, (angle, place) = plt.subplots(1, 2, figsize=(8.6, 3.7), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.94))
    d = np.geomspace(DISTANCES[0], DISTANCES[-1], 200)
    for share, line in ((1, "-"), (1 - PARTICLE, "--")):
        bound = np.degrees(np.arcsin(1 / (share * (1 + d))))
        angle.plot(d, bound, line, color="#7a8490", label="asin(R / (R + d))" if share == 1 else None)
    angle.plot(DISTANCES, angles[1], "o", color=COLOURS[1], label="largest measured")
    angle.plot(DISTANCES, angles[0], "s", color=COLOURS[0], label="median measured")
    angle.set(ylabel="angle to the particle shown, degrees", ylim=(0, 90))
    place.plot(DISTANCES, 100 * moved[1], "o-", color=COLOURS[1], label="95th percentile")
    place.plot(DISTANCES, 100 * moved[0], "s-", color=COLOURS[0], label="median")
    place.set(ylabel="displacement, % of the ball's radius", ylim=(0, None))
    for axis in (angle, place):
        axis.set(xscale="log", xlabel="distance d from the mirror, in its radius R")
        axis.grid(color=GRID, lw=0.6)
        axis.legend(fontsize=8)
    figure.plot = plot
    header = ["d / R", "asin(R / (R + d)), deg", "largest, deg", "median, deg", "displaced, % of R"]
    rows = [
        [f"{x}", f"{np.degrees(np.arcsin(1 / (1 + x))):.1f}", f"{a[1]:.1f}", f"{a[0]:.1f}", f"{100 * m:.1f}"]
        for x, a, m in zip(DISTANCES, angles.T, moved[0], strict=True)
    ]
    figure.table("The map's error over distance", header, rows)
    ten = DISTANCES.index(10.0)
    figure.finding(
        f"No pixel is off by more than asin(R / |S|), S being the point shown, but for {max(0, max(beyond)):.2f} degrees "
        "(half a texel spans 0.1). "
        f"Ten radii away the map is off by {angles[0][ten]:.1f} degrees in the median, which moves what it shows by "
        f"{100 * moved[0][ten]:.1f} % of the ball's radius; at a twentieth of the radius by "
        f"{angles[0][0]:.0f} degrees and {100 * moved[0][0]:.0f} %."
    )


def parallax(run) -> tuple[np.ndarray, np.ndarray]:
    """Degrees, for each pixel whose mirror shows a point S of a particle: the angle between mirrored
    ray and S, and asin(R / |S|)."""
    frame = run.frame()
    channels = read_channels(run.exr())
    shown = frame.mirror & (frame.status == FOUND)
    point = np.stack([channels[f"position.{axis}"] for axis in "XYZ"], axis=-1)[shown].astype(float)
    normal = frame.normal[shown].astype(float)
    # Parallel rays along -z.
    mirrored = 2 * normal[:, 2:] * normal - np.array([0, 0, 1])
    towards = frame.point[shown] - point
    cosine = (mirrored * towards).sum(-1) / np.linalg.norm(towards, axis=-1)
    bound = np.arcsin(np.minimum(1, 1 / np.linalg.norm(frame.point[shown], axis=-1)))
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))), np.degrees(bound)


def displaced(truth, ours) -> np.ndarray:
    """How far ours draws the particles' points from where the truth does, in the ball's radius."""
    traced, mapped = truth.frame(), ours.frame()
    left, _, right, _ = box_around(traced.mirror)
    names = enumerate(ours.row["scene"]["objects"])
    particles = [i for i, name in names if name.startswith("particle")]
    moved = [displacement(mapped, traced, i, samples=60)[0] for i in particles]
    return np.concatenate(moved) / ((right - left) / 2)


if __name__ == "__main__":
    main(__file__, __doc__, draw)
