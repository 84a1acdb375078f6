"""Which figures and papers there are: read off the folders, never listed by hand.

A paper is a folder beside this library with a README.md; a figure is a script in it called
`fig<name>.py`, known as `<paper>/<name>` with `fig01.py` as `1` and `fig_cube_map.py` as `cube-map`.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from . import paths


class UnknownFigure(ValueError):
    """No such figure; the message lists what is valid."""


@dataclass(frozen=True)
class Script:
    """One figure's script."""

    paper: str
    name: str
    path: Path

    @property
    def id(self) -> str:
        return f"{self.paper}/{self.name}"


@dataclass(frozen=True)
class Entry:
    """One line of a paper's inventory: a figure or table of the paper, drawn or not."""

    figure: str
    shows: str
    state: str
    how: str

    @property
    def done(self) -> bool:
        return self.state == "done"


def figure_of(script: Path) -> Script:
    """Paper and name of the figure a script draws."""
    name = script.stem.removeprefix("fig").strip("_").replace("_", "-")
    return Script(script.parent.name, name.lstrip("0") or name, script)


def scripts(folder: Path = paths.FIGURES) -> list[Script]:
    """Every figure, by paper, numbers in order and before words."""

    def order(script: Script) -> tuple:
        number = int(re.match(r"\d*", script.name).group() or 0)
        return (script.paper, number == 0, number, script.name)

    return sorted((figure_of(path) for path in folder.glob("*/fig[0-9_]*.py")), key=order)


def find(wanted: list[str], known: list[Script]) -> list[Script]:
    """The figures named `PAPER/FIGURE` or `PAPER`; a paper may be cut short where that is clear."""
    chosen = []
    for text in wanted:
        paper, _, name = text.partition("/")
        papers = {s.paper for s in known if s.paper == paper}
        papers = papers or {s.paper for s in known if s.paper.startswith(paper)}
        found = [s for s in known if s.paper in papers and name in ("", s.name)]
        if not paper or len(papers) != 1 or not found:
            valid = ", ".join(s.id for s in known)
            raise UnknownFigure(f"no figure {text!r}; there are {valid}")
        chosen += [s for s in found if s not in chosen]
    return chosen


def papers(folder: Path = paths.FIGURES) -> list[str]:
    """Every folder with an inventory, whether or not a figure of it is drawn yet."""
    return sorted(p.parent.name for p in folder.glob("*/README.md") if inventory(p.parent))


def title(folder: Path) -> str:
    """A paper's title: the first heading of its README."""
    first = (folder / "README.md").read_text(encoding="utf-8").split("\n", 1)[0]
    return first.removeprefix("#").strip()


def inventory(folder: Path) -> list[Entry]:
    """The table `| Figure | Shows | State | How |` of a paper's README."""
    rows = []
    for line in (folder / "README.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(cells) == 4 and cells[2] in ("done", "partly", "not yet", "not planned"):
            rows.append(Entry(*cells))
    return rows
