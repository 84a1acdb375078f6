"""One figure on its way to disk: the picture, the numbers behind it, and what is said about it.

A script's docstring is the only place where a figure is described: its first line is the title, a
paragraph that begins with `To be seen:` what to look for, and one with `Claim:` what the paper says.
"""

import inspect
import json
import os
import re
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from . import images, paths, registry
from .runs import Run, RunFailed

SOFTWARE_MARK = "software rasteriser: times are not GPU speeds"
INK, QUIET, WARN = "#1d2530", "#66707c", "#b3261e"

plt.rcParams.update(
    {
        "font.size": 9,
        "axes.titlesize": 9.5,
        "axes.titleweight": "bold",
        "axes.edgecolor": "#9aa3ad",
        "axes.labelcolor": INK,
        "text.color": INK,
        "axes.grid": False,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "figure.facecolor": "white",
        "savefig.dpi": 160,
    }
)


class Figure:
    """Collects the parts of one figure; `save` writes them all or none."""

    def __init__(self, script: Path, doc: str):
        known = registry.figure_of(script)
        self.paper, self.name = known.paper, known.name
        self.title, self.see, self.claim = describe(doc)
        self.plot: plt.Figure | None = None
        self._rows: list[dict] = []
        self._finding = ""
        self._numbers: dict = {}
        self._tables: list[dict] = []
        self._comparisons: list[dict] = []
        self._pictures: dict[str, np.ndarray] = {}
        self._film: dict | None = None
        self._film_pictures: tuple[list[Image.Image], float] | None = None

    def cite(self, *runs: Run) -> None:
        """The runs the figure rests on; their rows are stored with it."""
        self._rows += [row for run in runs for row in run.rows]

    def number(self, name: str, value) -> None:
        """A number shown in the figure that no row holds."""
        self._numbers[name] = value

    def finding(self, text: str) -> None:
        """What ours shows, said beside the paper's claim."""
        self._finding = text

    def table(self, title: str, header: list[str], rows: list[list[str]]) -> None:
        self._tables.append({"title": title, "header": header, "rows": rows})

    def compare(self, label: str, truth: np.ndarray, ours: np.ndarray, error: np.ndarray) -> None:
        """Three pictures of one size (display values) for the page's slider and heat map."""
        stem = re.sub(r"[^a-z0-9]+", "-", f"{self.name}-{label}".lower()).strip("-")
        files = {kind: f"{stem}-{kind}.png" for kind in ("truth", "ours", "error")}
        for kind, picture in (("truth", truth), ("ours", ours), ("error", error)):
            self._pictures[files[kind]] = picture
        self._comparisons.append({"label": label, **files})

    def film(self, label: str, pictures: list[Image.Image], rate_hz: float) -> None:
        """Pictures of one size for the page to play, so many a second."""
        self._film = {"label": label, "file": f"{self.name}-film.png"}
        self._film_pictures = (pictures, rate_hz)

    @property
    def devices(self) -> list[dict]:
        """The devices of the rows, each once, but the truth's, which is traced on the processor."""
        found = []
        for row in self._rows:
            if row["method"] != "truth" and row["device"] not in found:
                found.append(row["device"])
        return found

    @property
    def is_software(self) -> bool:
        return any(device["is_software"] for device in self.devices)

    def save(self) -> Path:
        """Write PNG, PDF, the page's pictures and, last, the JSON. Returns the PNG's path."""
        if self.plot is None:
            raise ValueError(f"{self.paper}/{self.name} drew nothing")
        self._sign()
        folder = paths.out() / self.paper
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".making-", dir=folder) as aside:
            aside = Path(aside)
            # No dates inside, so that equal input gives equal files.
            self.plot.savefig(aside / f"{self.name}.png", metadata={"Software": None})
            self.plot.savefig(aside / f"{self.name}.pdf", metadata={"CreationDate": None})
            plt.close(self.plot)
            for file, picture in self._pictures.items():
                images.to_image(picture).save(aside / file)
            if self._film and self._film_pictures:
                pictures, rate_hz = self._film_pictures
                images.write_film(pictures, aside / self._film["file"], rate_hz)
            written = sorted(p.name for p in aside.iterdir())
            record = json.dumps(self._record(), indent=1, ensure_ascii=False)
            (aside / f"{self.name}.json").write_text(record + "\n", encoding="utf-8")
            for file in [*written, f"{self.name}.json"]:
                os.replace(aside / file, folder / file)
        return folder / f"{self.name}.png"

    def _record(self) -> dict:
        return {
            "schema_version": 1,
            "paper": self.paper,
            "figure": self.name,
            "title": self.title,
            "see": self.see,
            "claim": self.claim,
            "finding": self._finding,
            "commit": sorted({row["commit"] for row in self._rows}),
            "devices": self.devices,
            "is_software": self.is_software,
            "numbers": self._numbers,
            "tables": self._tables,
            "comparisons": self._comparisons,
            "film": self._film,
            "rows": self._rows,
        }

    def _sign(self) -> None:
        """Device, driver and commit below the picture."""
        parts = [f"{d['name']}, {d['driver']}" for d in self.devices]
        parts += [f"commit {commit[:12]}" for commit in sorted({r["commit"] for r in self._rows})]
        at = {"y": 0.004, "fontsize": 6.5, "va": "bottom"}
        self.plot.text(0.008, s=" · ".join(parts), ha="left", color=QUIET, **at)
        if self.is_software:
            self.plot.text(0.992, s=SOFTWARE_MARK, ha="right", color=WARN, **at)


def describe(doc: str) -> tuple[str, str, str]:
    """Title, what is to be seen, and the paper's claim, from a script's docstring."""
    title, *paragraphs = [" ".join(p.split()) for p in inspect.cleandoc(doc).split("\n\n")]
    said = {"To be seen": "", "Claim": ""}
    for paragraph in paragraphs:
        kind, colon, text = paragraph.partition(": ")
        if not colon or kind not in said:
            raise ValueError(f"a paragraph of {title!r} begins with neither of {', '.join(said)}")
        said[kind] = text
    return title.rstrip("."), said["To be seen"], said["Claim"]


def main(script: str, doc: str, draw: Callable[[Figure], None]) -> None:
    """Draw one figure and leave: exit 0, or 1 with one line that says why not."""
    figure = Figure(Path(script).resolve(), doc)
    try:
        draw(figure)
        print(figure.save())
    except (RunFailed, OSError) as error:
        sys.exit(f"{figure.paper}/{figure.name}: {error}")
