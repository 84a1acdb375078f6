"""Patow 1995, Figure 7: the pseudocode of the traversal, beside the shader that carries it out.

To be seen: Steps of t from B until the face of W is reached, and from there a line in the face's own
texels. Each line of the paper and where it stands in our shader.
"""

from mirrorfigures import main, render
from mirrorfigures.pseudocode import table

# Line for line as the paper has it.
PAPER = [
    "Actual <- B  { that is, t <- 0 }",
    "While faces of the reflection map indexed by Actual and W are not the same do",
    "  Get pixel indexed by Actual.",
    "  For each entry in the current pixel depth list do",
    "    Inspect depth and keep value if better than the respective previous one.",
    "  Increment t and use Equation (1) to get new Actual.",
    "{both vectors index the same face, so }",
    "Do the DDA traversal in that plane, between the pixels indexed by Actual and W.",
]


def draw(figure):
    figure.cite(render("patow-room", "z-buffered-map", size="600x600"))
    table(figure, "z_buffered_map", 7, PAPER)


if __name__ == "__main__":
    main(__file__, __doc__, draw)
