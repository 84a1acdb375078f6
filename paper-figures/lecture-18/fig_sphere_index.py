"""Lecture 18, "How to index into a sphere map?": from the direction r to the place (s, t), as computed.

To be seen: Left, parallel rays from the viewer (v to the right) meet the ball at s and leave along
r = 2 (n.v) n - v; the dashed one leaves straight backwards. Right, the place s of every direction by
the lecture's formula, and the directions that the texels of a map's middle row hold, as the GPU filled
them: one curve, flat at the rim, where many directions share little room.

Claim: "(s,t) = (rx, ry) / sqrt(rx² + ry² + (rz + 1)²)"; at r = (0, 0, -1) that is 0 / 0. We take the
rim's point (1, 0) there; any of the rim shows that direction.
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID
from mirrorfigures.exr import read_channels

RAYS = (-0.9, -0.6, -0.25, 0.0, 0.25, 0.6, 0.9)


def place(r: np.ndarray) -> np.ndarray:
    """The lecture's s for directions (rx, rz) in the plane of the drawing."""
    rx, rz = r
    return rx / np.sqrt(rx**2 + (rz + 1) ** 2)


def reflected(s: np.ndarray) -> np.ndarray:
    """r = 2 (n.v) n - v for v = (0, 1) and the circle's normal at s."""
    normal = np.stack([s, np.sqrt(1 - s**2)])
    return 2 * normal[1] * normal - np.array([0.0, 1.0])[:, *(None,) * np.ndim(s)]


def texels(run) -> tuple[np.ndarray, np.ndarray]:
    """s and direction (rx, rz) of the texels of the row above the map's middle, from its dump."""
    point = read_channels(run.files / "dump" / "environment-map" / "ball" / "map_point.exr")
    side = len(point["R"])
    s = (2 * np.arange(side) + 1) / side - 1
    inside = s**2 + (1 / side) ** 2 < 1
    return s[inside], np.stack([point[c][side // 2 - 1][inside] for c in "RB"]).astype(float)


def draw(figure):
    # Nothing but sky: every texel's evidence is its direction.
    case = "environment-map:projection=sphere,source=ball,size=256"
    run = render("sky", case, size="320x320", dump="environment-map/ball")
    figure.cite(run)
    plot, (plan, curve) = plt.subplots(1, 2, figsize=(8.6, 4.0), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.95))
    angle = np.linspace(0, 2 * np.pi, 361)
    plan.plot(np.cos(angle), np.sin(angle), color="#7a8490")
    for s, colour in zip((*RAYS, 1.0), (*COLOURS, COLOURS[0], "#7a8490"), strict=False):
        start = np.array([np.sqrt(1 - s**2), s])
        rx, rz = reflected(np.float64(s))
        dash = "--" if s == 1.0 else "-"
        plan.annotate("", start, (2.6, s), arrowprops={"arrowstyle": "->", "color": "#b5bcc4"})
        plan.plot(*np.stack([start, start + 1.3 * np.array([rz, rx])], axis=1), dash, color=colour)
    plan.set(aspect="equal", xlim=(-1.5, 2.7), ylim=(-1.75, 1.75), xlabel="z, towards the viewer", ylabel="s")
    plan.set_title("rays that meet the ball at s leave along r")
    turned = np.radians(np.linspace(-179.9, 179.9, 721))
    by_formula = place(np.stack([np.sin(turned), np.cos(turned)]))
    s, r = texels(run)
    held = np.degrees(np.arctan2(r[0], r[1]))
    curve.plot(held[::8], s[::8], "o", color=COLOURS[0], ms=4, alpha=0.5, label="texels of the map")
    curve.plot(np.degrees(turned), by_formula, color=COLOURS[1], lw=1, label="the lecture's formula")
    curve.set(xlabel="angle of r from the viewer, degrees", ylabel="s", xlim=(-185, 185))
    curve.set_xticks(range(-180, 181, 60))
    curve.set_title("the place of a direction")
    curve.grid(color=GRID, lw=0.6)
    curve.legend(fontsize=8, loc="upper left")
    figure.plot = plot
    worst = float(np.abs(place(r) - s).max() * len(s) / 2)
    figure.number("largest difference, texels", worst)
    figure.finding(
        f"Formula and texels agree to {worst:.2f} texels; 90 degrees to the side lie at "
        f"s = {place(np.array([1.0, 0.0])):.3f}, "
        "so the half of all directions that lie behind the ball fill the ring outside."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
