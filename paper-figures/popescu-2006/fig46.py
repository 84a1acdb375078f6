"""Popescu et al. 2006, slide 46: too few rotated depth maps.

To be seen: The mirrored statue near the sphere, from one rotated map every 20, 10, 3 and 2 degrees; above with
one row a ray, as published, below with the row chosen again where the first was hit, then finished by a look at the
image itself. With few maps rows run
past their rays by x tan(half the step), x from the ray's middle on: shapes break up along the borders between
maps. Chosen again, little of that is left. Above each, how far the points shown lie beside their rays on
average. Right, the march over the depth image itself.

Claim: "SRDM under-sampling. One rotated depth map every 20°, 10°, 3°, and 2°, respectively."
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main, render
from mirrorfigures.cameras import camera
from mirrorfigures.evidence import object_ids

SCENE, FRAME, SIZE = "statue", 700, "480x360"
STEPS = (20, 10, 3, 2)


RULES = {
    "one row a ray": "re_anchor=off",
    "row chosen again": "re_anchor=on,finish=row",
    "and finished": "re_anchor=on,finish=image",
}


def case(step, rule):
    return f"depth-impostors@revised:own=0,{RULES[rule]},size=256,step_deg={step},views=1"


def draw(figure):
    march = render(SCENE, "depth-impostors@revised:own=0,search=march,size=256,views=1", frame=FRAME, size=SIZE)
    figure.cite(march)
    statue = object_ids(march.row)["statue.default"]
    exact = march.frame()
    eye = camera(SCENE, FRAME, SIZE).eye
    left, top, right, bottom = images.box_around(exact.shows(statue))
    crop = np.s_[max(top - 6, 0) : bottom + 6, max(left - 6, 0) : right + 6]
    plot, axes = plt.subplots(len(RULES), len(STEPS) + 1, figsize=(10.4, 7.8), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.04, 1, 0.96), h_pad=0.02, w_pad=0.02)
    table, means = [], {}
    for line, rule in zip(axes, RULES, strict=True):
        for axis, step in zip(line, STEPS, strict=False):
            run = render(SCENE, case(step, rule), frame=FRAME, size=SIZE)
            figure.cite(run)
            frame = run.frame()
            show(axis, frame, crop)
            beside = beside_rays(frame, eye)[frame.shows(statue)]
            means[step, rule] = beside.mean() if len(beside) else 0.0
            both = frame.shows(statue) & exact.shows(statue)
            apart = np.linalg.norm(frame.point - exact.point, axis=-1)[both]
            numbers = [1e3 * means[step, rule], 1e3 * apart.mean() if len(apart) else 0.0]
            bad = run.row["accuracy"]["bad_share"]["1"]
            table.append([str(step), rule, *(f"{n:.1f}" for n in numbers), f"{100 * bad:.2f} %"])
            axis.set_title(f"{step}°: {numbers[0]:.1f} mm")
        show(line[-1], exact, crop)
        line[0].set_ylabel(rule)
    for axis in axes[:, -1]:
        axis.set_title("marched")
    figure.plot = plot
    header = ["degrees", "rule", "beside the ray, mm", "from the marched point, mm", "bad at 1 px"]
    figure.table("Under-sampling", header, table)
    once, again, finished = RULES

    def gain(rule):
        return ", ".join(f"{means[step, once] / max(means[step, rule], 1e-9):.1f} at {step} degrees" for step in STEPS)

    marched = 1e3 * beside_rays(exact, eye)[exact.shows(statue)].mean() if exact.shows(statue).any() else 0.0
    figure.finding(
        f"Choosing the row again brings the points shown nearer to their rays by a factor of {gain(again)}; finishing "
        f"in the image, by {gain(finished)}. Marched to, they lie {marched:.1f} mm beside them."
    )


def beside_rays(frame, eye):
    """Metres from the points shown to the mirrored rays."""
    incident = frame.position - eye
    incident /= np.linalg.norm(incident, axis=-1, keepdims=True)
    mirrored = incident - 2 * (incident * frame.normal).sum(-1, keepdims=True) * frame.normal
    return np.linalg.norm(np.cross(frame.point - frame.position, mirrored), axis=-1)


def show(axis, frame, crop):
    axis.imshow(images.to_srgb(frame.colour)[crop], interpolation="nearest")
    axis.set(xticks=[], yticks=[])
    axis.spines[:].set_visible(False)


if __name__ == "__main__":
    main(__file__, __doc__, draw)
