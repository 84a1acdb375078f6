"""Names, and the papers' inventories against the scripts there are."""

import hashlib
import re
from pathlib import Path

import pytest

from mirrorfigures import paths, registry

SCRIPTS = registry.scripts()
IDS = [script.id for script in SCRIPTS]
PAPERS = ["estalella-2006", "lecture-18", "martin-popescu-2004", "patow-1995", "popescu-2006"]


def found(text):
    return [script.id for script in registry.find([text], SCRIPTS)]


def test_names():
    assert registry.figure_of(Path("patow-1995/fig01.py")).id == "patow-1995/1"
    assert registry.figure_of(Path("lecture-18/fig_cube_map.py")).id == "lecture-18/cube-map"
    assert registry.figure_of(Path("x/fig10.py")).name == "10"


def test_a_paper_may_be_cut_short():
    assert found("patow/1") == found("patow-1995/1") == ["patow-1995/1"]
    assert found("lecture") == [
        "lecture-18/cube-map",
        "lecture-18/infinity",
        "lecture-18/quiz",
        "lecture-18/refraction",
        "lecture-18/rim",
        "lecture-18/solutions",
        "lecture-18/sphere-index",
        "lecture-18/sphere-map",
        "lecture-18/teapot",
    ]


@pytest.mark.parametrize("wrong", ["", "/1", "patow/77", "p/1x", "nobody", "l"])
def test_what_is_unknown_or_unclear_lists_what_is_valid(wrong):
    known = [*SCRIPTS, registry.Script("lone-2000", "1", Path())]
    with pytest.raises(registry.UnknownFigure, match=re.escape(IDS[0])):
        registry.find([wrong], known)


def test_numbers_come_in_order_and_before_words(tmp_path):
    for name in ("fig_b.py", "fig10.py", "fig02.py", "figure.py", "helper.py"):
        (tmp_path / "paper").mkdir(exist_ok=True)
        (tmp_path / "paper" / name).touch()
    assert [s.name for s in registry.scripts(tmp_path)] == ["2", "10", "b"]


def test_every_paper_has_an_inventory():
    assert registry.papers() == PAPERS
    for paper in PAPERS:
        assert ":" in registry.title(paths.FIGURES / paper)


@pytest.mark.parametrize("paper", PAPERS)
def test_what_an_inventory_calls_done_can_be_drawn_and_the_reverse(paper):
    entries = registry.inventory(paths.FIGURES / paper)
    drawable = set()
    for entry in entries:
        commands = re.findall(r"`tools/figures ([^`]+)`", entry.how)
        drawable |= {script_id for command in commands for script_id in found(command)}
        assert bool(commands) == (entry.state in ("done", "partly")), entry
    own = {script_id for script_id in drawable if script_id.startswith(paper + "/")}
    assert own == {script.id for script in SCRIPTS if script.paper == paper}


def test_vendored_files_are_as_published():
    table = (paths.VENDOR / "README.md").read_text(encoding="utf-8")
    sums = dict(re.findall(r"^\| `([^`]+)` .*`([0-9a-f]{64})` \|$", table, re.MULTILINE))
    files = {p.name for p in paths.VENDOR.iterdir()} - {"README.md"}
    assert files == set(sums)
    for name, expected in sums.items():
        assert hashlib.sha256((paths.VENDOR / name).read_bytes()).hexdigest() == expected
