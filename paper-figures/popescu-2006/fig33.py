"""Popescu et al. 2006, slide 33: comparison with environment mapping.

To be seen: The environment map shows the other teapots and the floor as if they were far away; billboards put them
where they are, and reflect in each other.

Claim: "Comparison to env. mapping: Environment mapping / Our method".
"""

from mirrorfigures import main, render
from mirrorfigures.billboards import METHOD, SIZE
from mirrorfigures.panels import contest

SCENE = "four-teapots"


def draw(figure):
    truth = render(SCENE, "truth", size=SIZE)
    left = render(SCENE, "environment-map", size=SIZE)
    right = render(SCENE, METHOD, size=SIZE)
    contest(figure, truth, ("environment mapping", left), ("billboard impostors", right))
    shares = [run.row["accuracy"]["bad_share"]["1"] for run in (left, right)]
    figure.finding(f"Bad at 1 px: environment mapping {shares[0]:.1%}, billboards {shares[1]:.1%}.")


if __name__ == "__main__":
    main(__file__, __doc__, draw)
