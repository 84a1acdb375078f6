"""Estalella et al. 2006, section 5.2 and video: the frustum widened, as a film.

To be seen: The camera turns away from a mirror sphere. Where textures hold just the view, the far vertices of
long triangles, which the sphere's missing part would show, end on the last texels instead: floor and columns bend
along the right border. Textures 1.2 times as wide, with texels as fine, push that out of the view, textures
fitted to the reflector too; what else is wrong stays. The strip has frames of the film.

Claim: "This causes small, but noticeable artifacts"; "in the video we show the effect of increasing the size of
the frustum"; "this choice does not have a major impact on quality" (section 7).
"""

from mirrorfigures import film, main, render
from mirrorfigures.films import named, panels
from mirrorfigures.panels import contact_sheet

SCENE, SIZE, FRAMES = "columns-turn", "320x180", (40, 88)
# Metre-long triangles show what is to be seen; texels are as fine in every case.
CASES = {
    "widening 1": "virtual-objects:widening=1,texture=320,subdivide=1",
    "widening 1.2": "virtual-objects:widening=1.2,texture=384,subdivide=1",
    "fitted": "virtual-objects:frustum=fitted,texture=320,subdivide=1",
    "ray traced": "truth",
}
BOX = (180, 0, 320, 180)  # where the sphere leaves
JUDGED = (48, 60, 72, 84)


def draw(figure):
    shot = film(SCENE, list(CASES.values()), size=SIZE, frames="{}..{}".format(*FRAMES))
    figure.cite(shot)
    rows = panels(shot, len(CASES))
    figure.film(", ".join(CASES), [named(row, list(CASES), BOX, 2) for row in rows], rate_hz=12.0)
    sheet = [rows[frame - FRAMES[0]] for frame in JUDGED]
    figure.plot = contact_sheet(sheet, list(CASES), [f"frame {frame}" for frame in JUDGED], BOX)
    table = []
    for name, case in CASES.items():
        if case != "truth":
            runs = [render(SCENE, case, frame=frame, size=SIZE) for frame in JUDGED]
            figure.cite(*runs)
            table.append([name, *(f"{run.row['accuracy']['bad_share']['1']:.1%}" for run in runs)])
    figure.table("Bad at 1 px", ["case", *(f"frame {frame}" for frame in JUDGED)], table)
    said = "; ".join(f"{name} {', '.join(shares)}" for name, *shares in table)
    figure.finding(f"Bad at 1 px in frames {', '.join(map(str, JUDGED))}: {said}.")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
