"""Martin & Popescu 2004, Figure 1: environment mapping, ray tracing and reflection morphing.

To be seen: The front columns and the cubic particle stand close to the mirror sphere. Ray tracing
draws their reflections near the objects themselves, and so does reflection morphing; the environment map
does not. Reflection morphing's edges are ragged: each vertex is drawn by the ray nearest to it, and rays
lie two pixels apart. Triangles with a vertex that no ray passes by are missing.

Claim: with environment mapping "in some situations, a reflected point is drawn hundreds of pixels
away from its correct location" (abstract); it "fails to convey the proximity of the objects to the
surface of the sphere" (section 2.1), where "ray tracing (middle) and reflection morphing (bottom)
correctly draw the reflections close to the real objects".
"""

from mirrorfigures import main, render
from mirrorfigures.panels import contest
from mirrorfigures.text import verdict


def draw(figure):
    truth = render("columns", "truth")
    mapped = render("columns", "environment-map")
    morphed = render("columns", "reflection-morphing")
    contest(figure, truth, ("environment map", mapped), ("reflection morphing", morphed))
    figure.finding(
        f"Environment map: {verdict(mapped.row)} Reflection morphing, with section 8's 256 x 256 rays a "
        f"face: {verdict(morphed.row)}"
    )


if __name__ == "__main__":
    main(__file__, __doc__, draw)
