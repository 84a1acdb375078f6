"""Martin & Popescu 2004, Figure 3: a camera and two reflectors are one generalised camera.

To be seen: Left, the plane of the eye C and two spheres' centres. Rays of the camera are lists of segments: grey
before the first mirror, blue after sphere 1, orange after sphere 2, green and violet after both. A point V projects
to where each list's nearest segment (thick) begins: once for every trace. Right, these places in the picture, those
by way of both mirrors where the ray first meets one.

Claim: "Reflectors only affect the direction of a ray, not its color, and should thus be considered as being part
of the camera not as part of the scene"; "a point can project to multiple locations in the image plane" (1.2).
"""

import matplotlib.pyplot as plt
import numpy as np

from mirrorfigures import images, main, render
from mirrorfigures.cameras import camera, description
from mirrorfigures.charts import COLOURS
from mirrorfigures.figure import INK, QUIET
from mirrorfigures.morphing import distance, generalised_rays, nearest_ray
from mirrorfigures.plans import Plane, circle

SCENE, SIZE, ORDER = "two-spheres", "640x360", 2
WAYS_DEG = np.linspace(-16, 46, 61)  # from the way to the first sphere's centre
BOX = (np.array([-3.0, 0.0, -3.0]), np.array([6.0, 3.0, 4.5]))
V = (2.0, 1.15)  # in the plane: towards C from the first sphere's centre, towards the second's
STYLE = {(): QUIET, (0,): COLOURS[0], (1,): COLOURS[1], (0, 1): COLOURS[2], (1, 0): COLOURS[3]}
"""Colours by trace."""


def draw(figure):
    truth = render(SCENE, "truth", size=SIZE)
    figure.cite(truth)
    view = camera(SCENE, 0, SIZE)
    spheres = [np.array(o["position"]) for o in description(SCENE)["objects"] if o["name"].startswith("sphere")]
    plane = Plane(spheres[0], view.eye, spheres[1])
    v = plane.origin + V[0] * plane.along + V[1] * plane.across
    ways = [np.sin(a) * plane.across - np.cos(a) * plane.along for a in np.radians(WAYS_DEG)]
    rays = generalised_rays(view.eye, ways, spheres, 1.0, BOX, ORDER)
    first = {ray.end.tobytes(): ray for ray in rays if not ray.trace}
    plot, (left, right) = plt.subplots(1, 2, figsize=(10.4, 4.8), layout="constrained", width_ratios=(1.25, 1))
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.95))
    right.imshow(images.to_srgb(truth.frame().colour), interpolation="nearest")
    right.set(xticks=[], yticks=[], title="where V projects")
    for ray in rays:
        left.plot(*plane([ray.start, ray.end]).T, color=STYLE[ray.trace], lw=0.5, alpha=0.8)
    rows = []
    for trace in [trace for trace in STYLE if trace]:
        found = nearest_ray(rays, trace, v)
        left.plot(*plane([found.start, found.end]).T, color=STYLE[trace], lw=2.2)
        met = found
        while met.start.tobytes() not in first:
            met = next(ray for ray in rays if np.array_equal(ray.end, met.start))
        across, down = view.place(met.start) * [int(n) for n in SIZE.split("x")] - 0.5
        right.plot(across, down, "o", mfc="none", mec=STYLE[trace], mew=2, ms=9)
        said = ", ".join(str(sphere + 1) for sphere in trace)
        rows.append([said, str(sum(ray.trace == trace for ray in rays)), f"{100 * distance(found, v):.1f}"])
    for number, centre in enumerate(spheres, 1):
        circle(left, 1.0, plane(centre), color=INK)
        left.annotate(f"reflector {number}", plane(centre), ha="center", va="center", fontsize=8)
    for name, point in (("V", v), ("C", view.eye)):
        left.plot(*plane(point), "o", color=INK, ms=5)
        left.annotate(name, plane(point), xytext=(6, 5), textcoords="offset points", weight="bold")
    left.set(aspect="equal", xlim=(-1.6, 4.6), ylim=(-1.6, 4.2), title="the plane of C and both centres")
    left.set(xlabel="from sphere 1 towards C, metres", ylabel="towards sphere 2, metres")
    figure.plot = plot
    figure.table("Projections of V", ["mirrors met", "rays", "nearest, cm"], rows)
    figure.finding(
        f"{len(ways)} rays of the camera are {len(rays)} segments with {len({ray.trace for ray in rays})} traces. V is "
        f"seen by {len(rows)} of them: in each sphere, and in each as the other shows it."
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
