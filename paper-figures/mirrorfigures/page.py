"""index.html: every figure drawn, the numbers behind it, and what of each paper is still to do."""

import json
import os
from pathlib import Path

import jinja2

from . import paths, registry, text
from .figure import SOFTWARE_MARK
from .runs import SCHEMA_VERSION


def write(out: Path, failed: dict[str, str]) -> Path:
    """Make the page from the figures' JSON files below `out`; `failed` has what went wrong now."""
    out.mkdir(parents=True, exist_ok=True)
    figures = _figures(out)
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    devices = {json.dumps(d, sort_keys=True): d for f in figures for d in f["devices"]}
    html = environment.get_template("index.html.jinja").render(
        papers=_papers(figures, failed),
        commits=sorted({commit for f in figures for commit in f["commit"]}),
        devices=list(devices.values()),
        software_mark=SOFTWARE_MARK,
        is_software=any(f["is_software"] for f in figures),
        failed=failed,
        rows=_timed_rows(figures),
        ratio=text.ratio,
        slider_css=(paths.VENDOR / "img-comparison-slider.css").read_text(encoding="utf-8"),
        slider_js=(paths.VENDOR / "img-comparison-slider.min.js").read_text(encoding="utf-8"),
    )
    aside = out / ".index.html.making"
    aside.write_text(html, encoding="utf-8")
    os.replace(aside, out / "index.html")
    return out / "index.html"


def _figures(out: Path) -> list[dict]:
    """The figures on disk whose scripts still exist, in the registry's order; those drawn from rows
    of another version are left out until they are drawn again."""
    found = []
    for script in registry.scripts():
        path = out / script.paper / f"{script.name}.json"
        if path.is_file():
            record = json.loads(path.read_text(encoding="utf-8"))
            if all(row["schema_version"] == SCHEMA_VERSION for row in record["rows"]):
                found.append(record)
    return found


def _papers(figures: list[dict], failed: dict[str, str]) -> list[dict]:
    """Our own charts first, then the papers, those with figures before those without."""
    drawn = {f["paper"] for f in figures}
    listed = sorted(registry.papers(), key=lambda paper: paper not in drawn)
    own = sorted(drawn - set(listed))
    return [
        {
            "id": paper,
            "title": registry.title(paths.FIGURES / paper),
            "figures": [f for f in figures if f["paper"] == paper],
            "failed": {i: text for i, text in failed.items() if i.startswith(paper + "/")},
            "inventory": registry.inventory(paths.FIGURES / paper),
        }
        for paper in own + listed
    ]


def _timed_rows(figures: list[dict]) -> list[dict]:
    """Every row with frame times, once."""
    rows = {
        json.dumps(row, sort_keys=True): row
        for figure in figures
        for row in figure["rows"]
        if row["frame_gpu_ms"]
    }
    return list(rows.values())
