"""Pseudocode of a paper beside the shader lines that carry it out.

A shader says `// Fig. 4, line 7: Find P' from pixel position.` where it does so; the table is read off
those comments, so it cannot point at a line that is not there.
"""

import re
from pathlib import Path

import matplotlib.pyplot as plt

from . import paths
from .figure import Figure

SHADERS = paths.ROOT / "shaders"


def places(folder: str, figure: int) -> dict[int, list[tuple[str, int, str]]]:
    """For each line of a paper's figure: file, line number and text of the code after its comment."""
    found = {}
    tag = re.compile(rf"^\s*// Fig\. {figure}, line (\d+):")
    for path in sorted((SHADERS / folder).glob("*.wgsl")):
        lines = path.read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines, start=1):
            if match := tag.match(line):
                at, code = _code_after(lines, number)
                found.setdefault(int(match[1]), []).append((path.name, at, code))
    return found


def _code_after(lines: list[str], start: int) -> tuple[int, str]:
    """Number and text of the first line of code below a comment."""
    for number, line in enumerate(lines[start:], start=start + 1):
        if code := line.strip():
            if not code.startswith(("//", "#")):
                return number, code
    raise ValueError("a comment with no code below it")


def table(figure: Figure, folder: str, number: int, pseudocode: list[str]) -> None:
    """Draw the table; a line of the paper that only opens a branch has no code of its own."""
    known = places(folder, number)
    rows = []
    for line, text in enumerate(pseudocode, start=1):
        for file, at, code in known.get(line, [("", 0, "")]):
            rows.append([f"{line}", text, f"{file}:{at}" if file else "", code])
    header = ["line", "paper", f"shaders/{folder}/", "code"]
    figure.table(f"Figure {number}, line by line", header, rows)
    figure.number("lines", {line: len(at) for line, at in known.items()})
    plot, axis = plt.subplots(figsize=(11.5, 0.25 * len(rows) + 0.7), layout="constrained")
    plot.get_layout_engine().set(rect=(0, 0.05, 1, 0.94))
    axis.axis("off")
    drawn = axis.table(
        rows,
        colLabels=header,
        colWidths=[0.03, 0.43, 0.12, 0.42],
        loc="center",
        cellLoc="left",
        colLoc="left",
        edges="horizontal",
    )
    drawn.auto_set_font_size(False)
    for (row, column), cell in drawn.get_celld().items():
        cell.set(edgecolor="#dfe3e8")
        mono = row > 0 and column in (1, 3)
        cell.set_text_props(fontsize=6.5, family="monospace" if mono else "sans-serif")
    drawn.scale(1, 1.2)
    figure.plot = plot
