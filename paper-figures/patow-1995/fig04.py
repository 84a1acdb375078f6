"""Patow 1995, Figure 4: the pseudocode of the model, beside the shader that carries it out.

To be seen: Each line of the paper and where it stands in our shader; lines that only open a branch
have no code of their own. Lines 6 to 11 run once a texel, all layers at a time; lines 12 to 14 at the
end, a layer after the other.
"""

from mirrorfigures import main, render
from mirrorfigures.pseudocode import table

# Line for line as the paper has it; [.] is normalisation, its norm sign.
PAPER = [
    "With normal N and incident vector I, find reflected vector, B.",
    "if (B . [W]) = +-1",
    "then",
    "  Compute reflection in the direction of B.",
    "else",
    "  For each pixel in (Reflection Plane ∩ Reflection Map) do",
    "    Find P' from pixel position.",
    "    Get alpha' from the reflection map (and then calculate S').",
    "    if pixel currently indexed has a smaller angle than previous ones",
    "    then",
    "      keep new pixel.",
    "  if angle of best approximator > tolerable_limit",
    "  then",
    "    Reflect infinity (background, B).",
]


def draw(figure):
    figure.cite(render("patow-room", "z-buffered-map", size="600x600"))
    table(figure, "z_buffered_map", 4, PAPER)


if __name__ == "__main__":
    main(__file__, __doc__, draw)
