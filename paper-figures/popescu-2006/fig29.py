"""Popescu et al. 2006, slides 29 to 32: attenuation with distance, Fresnel, both, materials and animation.

To be seen: The table scene with what the mirrors make of their reflections: plain; attenuated with distance, so that
near things stand out and the far ones and the sky fade; with Fresnel's law, so that mirrors on paint show at
grazing angles; both; and two moments of a teapot that wobbles. Truth above, billboards below.

Claim: The slides give no formulas: "Attenuation w/ distance", "Fresnel", "Combined effects", "Animation and
materials".
"""

import matplotlib.pyplot as plt

from mirrorfigures import images, main, render
from mirrorfigures.billboards import METHOD
from mirrorfigures.variants import changed

SIZE = "320x180"
SILVER = "silver = { mirror = { reflectance = 0.94 } }"
FADE = "fade = { distance = 0.8, floor = 0.25 }"
PAINT = "colour = [0.05, 0.12, 0.3]"
TEAPOT = 'material = "silver"\n'
WAVES = "wobble = { amplitude = 0.02, wavelength = 0.4, period_s = 1.0 }\n"
# What replaces what in the scene, and the frame.
PANELS = {
    "plain": (None, 0),
    "attenuation": ((SILVER, f"silver = {{ mirror = {{ reflectance = 0.94, {FADE} }} }}"), 0),
    "Fresnel": ((SILVER, f"silver = {{ {PAINT}, mirror = {{ reflectance = 0.2, fresnel = true }} }}"), 0),
    "both": (
        (SILVER, f"silver = {{ {PAINT}, mirror = {{ reflectance = 0.2, fresnel = true, {FADE} }} }}"),
        0,
    ),
    "wobbling": ((TEAPOT, TEAPOT + WAVES), 3),
    "later": ((TEAPOT, TEAPOT + WAVES), 12),
}


def draw(figure):
    plot, axes = plt.subplots(2, len(PANELS), figsize=(15, 3.1), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.93), h_pad=0.02, w_pad=0.02)
    table = []
    for column, (name, (change, frame)) in zip(axes.T, PANELS.items(), strict=True):
        scene = changed("table", *change) if change else "table"
        truth = render(scene, "truth", frame=frame, size=SIZE)
        ours = render(scene, METHOD, frame=frame, size=SIZE)
        figure.cite(truth, ours)
        for axis, run in zip(column, (truth, ours), strict=True):
            axis.imshow(images.to_srgb(run.frame().colour)[35:135, 20:270], interpolation="nearest")
            axis.set(xticks=[], yticks=[])
            axis.spines[:].set_visible(False)
        column[0].set_title(name)
        accuracy = ours.row["accuracy"]
        table.append([name, f"{accuracy['flip']['mean']:.3f}", f"{accuracy['psnr']:.1f}"])
    axes[0, 0].set_ylabel("ray traced")
    axes[1, 0].set_ylabel("billboards")
    figure.plot = plot
    figure.table("Colour against the truth, over the mirrors", ["effect", "FLIP, mean", "PSNR, dB"], table)
    figure.finding(
        "Every effect is the composite's, one for all methods: the error is that of the billboards. FLIP "
        + ", ".join(f"{name} {flip}" for name, flip, _ in table)
        + "."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
