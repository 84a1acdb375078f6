"""Popescu et al. 2006, slide 9: how near a mirror lets the eye come, and whether it hides an impostor's faults.

To be seen: A statue 0.9 m before a mirror of one outline and any curvature (hollow below 0, flat, convex above). Top
left, from how far the statue appears to be seen (the width on it between two pixels, over their angle) as the eye
comes up to the mirror, measured on the truth (marks) and for narrow bundles (lines). A flat or convex mirror keeps
the eye at least at the statue's own distance from it; a hollow one can do less. The others, one and the same impostor
of the statue, in its place, over the curvature: how far its points are drawn from where they belong, in pixels and as
a share of the image's width; what is not within a pixel of its place, as a share of the statue's image, what is shown
beside the statue included; and FLIP over the image. At 0 the view is the one of an eye behind the mirror that sees
the impostor directly.

Claim: "Reflector surface prevents desired viewpoint from getting too close to the impostor"; "reflection distortion
hides impostor artifacts".
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import main, render
from mirrorfigures.charts import COLOURS, GRID, MARKERS
from mirrorfigures.evidence import displacement, object_ids
from mirrorfigures.figure import INK
from mirrorfigures.variants import head, scene_file, thing

SIZE, FOV_DEG = "640x480", 30.0
ASIDE = np.radians(20.0)  # of eye and statue from the mirror's axis
GAP, EYE, APERTURE = 0.9, 1.5, 0.6
NEARING = (2.0, 1.0, 0.5, 0.25, 0.1)
# 1 / radius, per metre; the centre is behind the mirror above 0.
CURVATURES = (-0.5, -0.4, -0.25, 0.0, 0.25, 0.5, 1.0)
NEARED = {"hollow, radius 1 m": -1.0, "flat": 0.0, "convex, radius 1 m": 1.0}
# Not filtered, as the truth's one ray a pixel is not.
CASES = {
    "billboard": "billboard-impostors:filter=bilinear",
    "billboard, revised": "billboard-impostors@revised:filter=bilinear",
    "depth image": "depth-impostors:size=256,filter=bilinear",
    "depth image, revised": "depth-impostors@revised:size=256,filter=bilinear",
}
def scene(curvature, away):
    """The statue, a mirror of that curvature, the eye so far from it."""
    side, front = np.sin(ASIDE), np.cos(ASIDE)
    profile = [[round(float(r), 6), round(float(y), 6)] for r, y in arc(curvature)]
    mirror = f'revolution = {{ profile = {profile}, curve = "bezier", slices = 192, stacks = 64 }}'
    statue = 'obj = { file = "models/statue.obj", crease_deg = 89.0 }'
    return scene_file(
        "slide9",
        head(FOV_DEG, (-away * side, 0, away * front), (0, 0, 0), (0.1, 0.1))
        + thing("mirror", mirror, "mirror", (0, 0, 0), (90, 0, 0))
        + thing("statue", statue, "paint", (GAP * side, -0.3, GAP * front), (0, 215, 0), "scale = 0.35\n"),
    )


def arc(curvature):
    """A mirror's cubic profile from its axis to its rim, radius and height, its outside to the right: a circle's arc to
    within a micrometre."""
    if abs(curvature) < 1e-9:
        return [(APERTURE * (3 - i) / 3, 0.0) for i in range(4)]
    radius = 1 / curvature
    angle = np.arcsin(APERTURE / radius)
    handle = 4 / 3 * np.tan(angle / 4) * radius
    rim = radius * np.array([np.sin(angle), np.cos(angle) - 1])
    back = handle * np.array([np.cos(angle), -np.sin(angle)])
    return [tuple(rim), tuple(rim - back), (float(handle), 0.0), (0.0, 0.0)]


def draw(figure):
    plot, axes = plt.subplots(2, 2, figsize=(9.6, 7.4), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))
    near, moved, bad, flip = axes.flat
    nearest = {}
    for (name, curvature), colour, marker in zip(NEARED.items(), COLOURS, MARKERS, strict=False):
        eye = np.linspace(0, max(NEARING), 201)
        seen = [nearing(figure, curvature, away) for away in NEARING]
        near.plot(eye, by_formula(eye, curvature), color=colour, lw=1)
        near.plot(NEARING, seen, marker, color=colour, ms=5, label=name)
        nearest[name] = np.nanmin(seen)
    near.axhline(GAP, color=INK, lw=0.8, ls=":", label="statue from the mirror")
    near.set(xlabel="eye from the mirror, m", ylabel="statue seen from, m", xlim=(0, None), ylim=(0, None))
    errors = {name: [Error.of(figure, case, c) for c in CURVATURES] for name, case in CASES.items()}
    share = moved.twinx()
    for (name, found), colour, marker in zip(errors.items(), COLOURS, MARKERS, strict=False):
        style = {"color": colour, "marker": marker, "ms": 4, "label": name}
        moved.plot(CURVATURES, [e.moved for e in found], **style)
        share.plot(CURVATURES, [100 * e.share for e in found], "--", color=colour, lw=1)
        bad.plot(CURVATURES, [100 * e.bad for e in found], **style)
        flip.plot(CURVATURES, [e.flip for e in found], **style)
    moved.set(ylabel="mean displacement, pixels")
    share.set(ylabel="of the image's width, % (dashed)", ylim=(0, None))
    bad.set(ylabel="bad at 1 px, % of the statue's image")
    flip.set(ylabel="FLIP over the statue's image")
    for axis in axes.flat:
        axis.grid(color=GRID, lw=0.6)
        axis.legend(fontsize=7.5)
        if axis is not near:
            axis.set(xlabel="curvature, 1/m (0: as seen directly)", ylim=(0, None))
    figure.plot = plot
    told(figure, nearest, errors)


def told(figure, nearest, errors):
    header = ["curvature, 1/m", *(f"{name}: pixels, share, bad, FLIP" for name in CASES)]
    rows = zip(*errors.values(), strict=True)
    table = [[f"{c:g}", *map(str, found)] for c, found in zip(CURVATURES, rows, strict=True)]
    figure.table("The same impostor's error, by the mirror's curvature", header, table)
    flat, bent = CURVATURES.index(0.0), CURVATURES.index(1.0)
    said = "; ".join(f"{name} {found[flat]}, and {found[bent]}" for name, found in errors.items())
    came = ", ".join(f"{name} {least:.2f} m" for name, least in nearest.items())
    figure.finding(
        f"The nearest the statue is seen from: {came}; it stands {GAP} m from the mirror. Seen directly, and in the "
        f"convex mirror of 1 m (pixels, of the image's width, bad at 1 px, FLIP): {said}."
    )


@dataclass(frozen=True)
class Error:
    """What is wrong with the statue."""

    moved: float
    """Mean displacement of its points, pixels."""
    share: float
    """That over the width of its image."""
    bad: float
    """Pixels bad at 1 px over those of its image."""
    flip: float
    """FLIP summed over the mirror, over the pixels of its image."""

    def __str__(self):
        return f"{self.moved:.2f}, {self.share:.1%}, {self.bad:.1%}, {self.flip:.2f}"

    @classmethod
    def of(cls, figure, case, curvature):
        truth, run = (render(scene(curvature, EYE), c, size=SIZE) for c in ("truth", case))
        figure.cite(truth, run)
        statue = object_ids(run.row)["statue.default"]
        traced = truth.frame()
        moved, _ = displacement(run.frame(), traced, statue)
        image, accuracy = traced.shows(statue), run.row["accuracy"]
        # There is nothing else: what is wrong beside the statue is its doing too.
        times = traced.mirror.sum() / image.sum()
        mean = float(np.mean(moved))
        width = np.ptp(np.nonzero(image)[1])
        return cls(mean, mean / width, accuracy["bad_share"]["1"] * times, accuracy["flip"]["mean"] * times)


def nearing(figure, curvature, away):
    """From how far the statue is seen by an eye so far from the mirror, metres."""
    run = render(scene(curvature, away), "truth", size=SIZE)
    figure.cite(run)
    return seen_from(run.frame(), object_ids(run.row)["statue.default"])


def by_formula(eye, curvature):
    """Of a narrow bundle mirrored aslant, the mean of its two widths (Coddington)."""
    across = eye + GAP + 2 * curvature * eye * GAP * np.cos(ASIDE)
    along = eye + GAP + 2 * curvature * eye * GAP / np.cos(ASIDE)
    return np.sqrt(np.abs(across * along))


def seen_from(frame, statue):
    """How far away a thing would be, seen directly, if it showed as much between two pixels: the median about the
    image's middle, metres."""
    height, width = frame.mirror.shape
    middle = np.s_[height // 2 - 12 : height // 2 + 12, width // 2 - 12 : width // 2 + 12]
    shown, points, at = (layer[middle] for layer in (frame.shows(statue), frame.point, frame.position))
    whole = shown[:-1, :-1] & shown[1:, :-1] & shown[:-1, 1:]
    over, down = points[:-1, 1:] - points[:-1, :-1], points[1:, :-1] - points[:-1, :-1]
    ray = points[:-1, :-1] - at[:-1, :-1]
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    area = np.abs((np.cross(over, down) * ray).sum(-1))[whole]
    angle = 2 * np.tan(np.radians(FOV_DEG / 2)) / height
    return float(np.sqrt(np.median(area)) / angle) if whole.any() else np.nan


if __name__ == "__main__":
    main(__file__, __doc__, draw)
