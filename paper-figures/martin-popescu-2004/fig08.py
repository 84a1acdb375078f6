"""Martin & Popescu 2004, Figure 8: a hybrid reflector, the teapot's body morphed, its parts environment mapped.

To be seen: The columns stand close to the body. In the body they are drawn near their places where it is
morphed, and far off where it is environment mapped; in spout, handle and lid it is hard to tell. With one bounce
the other parts are black in the morphed body, the foot, too; the map has none of them in it.

Claim: "If a reflector is composed of several parts, good results can be obtained from rendering the larger
pieces with reflection morphing and the smaller pieces with environment mapping" (section 7). "The body of the
teapot was rendered with reflection morphing while the spout, handle and lid were rendered with environment
mapping" (caption).
"""

from mirrorfigures import main, render
from mirrorfigures.panels import contest
from mirrorfigures.text import verdict

SCENE, SIZE = "hybrid-teapot", "960x720"
BODY = "teapot.body"
HYBRID = "*.body={};*=environment-map"
CASES = {
    "environment map": "environment-map",
    "hybrid": HYBRID.format("reflection-morphing"),
    "reflection morphing": "reflection-morphing",
    "hybrid, virtual objects revised": HYBRID.format("virtual-objects@revised"),
}


def draw(figure):
    truth = render(SCENE, "truth", size=SIZE)
    runs = {name: render(SCENE, case, size=SIZE) for name, case in CASES.items()}
    figure.cite(*runs.values())
    contest(figure, truth, *((name, runs[name]) for name in ("environment map", "hybrid")))
    parts = [part["reflector"] for part in runs["hybrid"].row["accuracy"]["by_reflector"]]
    rows = [[name, looked_up(run.row), *by_part(run.row, parts)] for name, run in runs.items()]
    header = ["case", "vertices looked up", *(part.removeprefix("teapot.") for part in parts)]
    figure.table("Bad at 1 px (missing), by part", header, rows)
    share = {part["reflector"]: part["share"] for part in runs["hybrid"].row["accuracy"]["by_reflector"]}
    figure.finding(
        f"The body is {share[BODY]:.0%} of the mirror's pixels. Hybrid: {verdict(runs['hybrid'].row)} "
        f"Environment map: {verdict(runs['environment map'].row)}"
    )


def by_part(row, parts):
    """Bad and missing shares of each part's pixels."""
    of = {part["reflector"]: part for part in row["accuracy"]["by_reflector"]}
    return [f"{of[part]['bad_share']['1']:.1%} ({of[part]['missing']:.1%})" for part in parts]


def looked_up(row):
    """Vertices projected, whatever the method calls it."""
    counted = (n for name, n in row["counters"].items() if name.endswith(("look-ups", "searches")))
    return f"{sum(counted):,.0f}"


if __name__ == "__main__":
    main(__file__, __doc__, draw)
