"""All figures and the page, end to end, in processes of their own as a user starts them."""

import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from html.parser import HTMLParser

import pytest
from PIL import Image

from mirrorfigures import paths, registry

SCRIPTS = registry.scripts()


def mirrorfigures(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "mirrorfigures", *arguments],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ,
    )


def renders(log):
    return sum(line.startswith("render ") for line in log.read_text().splitlines())


class Links(HTMLParser):
    """Every src and href of a page, and the text inside elements."""

    def __init__(self, html):
        super().__init__()
        self.links, self.text = [], ""
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.links += [value for name, value in attrs if name in ("src", "href")]

    def handle_data(self, data):
        self.text += data


def test_every_figure_is_drawn_and_the_page_shows_it(fake):
    ids = [script.id for script in SCRIPTS]
    # Two at a time, as most of the time goes into starting processes; the last call writes the page of all.
    with ThreadPoolExecutor() as pool:
        halves = [pool.submit(mirrorfigures, *ids[half::2]) for half in (0, 1)]
    for done in (*(half.result() for half in halves), mirrorfigures(ids[0])):
        assert done.returncode == 0, done.stderr
    out = paths.out()
    page = Links((out / "index.html").read_text(encoding="utf-8"))
    for script in SCRIPTS:
        record = json.loads((out / script.paper / f"{script.name}.json").read_text())
        assert record["title"] in page.text
        assert record["commit"] == ["0123456789abcdef"]
        assert record["rows"], script.id
        assert (out / script.paper / f"{script.name}.pdf").stat().st_size > 1000
        with Image.open(out / script.paper / f"{script.name}.png") as picture:
            assert min(picture.size) > 300
    assert "software rasteriser: times are not GPU speeds" in page.text
    assert "toy device" in page.text
    for link in page.links:
        assert not re.match(r"[a-z]+:|/", link), f"{link} is not relative"
        assert link.startswith("#") or (out / link).is_file(), link
    leftovers = [p for p in out.rglob("*") if "making" in p.name]
    assert leftovers == []


def test_a_second_run_renders_nothing(fake):
    assert mirrorfigures("patow/1").returncode == 0
    assert renders(fake) == 2
    assert mirrorfigures("patow/1").returncode == 0
    assert renders(fake) == 2


def test_a_failed_figure_fails_the_command_but_not_the_page(fake, monkeypatch, tmp_path):
    assert mirrorfigures("patow/9").returncode == 0
    broken = tmp_path / "broken"
    broken.write_text('#!/bin/sh\n[ "$1" = list ] && exit 0\necho "no device" >&2\nexit 3\n')
    broken.chmod(0o755)
    monkeypatch.setenv("MIRRORBENCH_BIN", str(broken))
    done = mirrorfigures("patow/1", "patow/2")
    assert done.returncode == 1
    assert "2 of 2 failed: patow-1995/1, patow-1995/2" in done.stderr
    assert "exit 3" in done.stderr
    page = Links((paths.out() / "index.html").read_text(encoding="utf-8"))
    assert "patow-1995/1 failed" in page.text
    assert "the ray-traced reference" in page.text, "the earlier figure is still there"
    assert not (paths.out() / "patow-1995" / "1.png").exists()


def test_charts_are_drawn_again_from_a_results_file_alone(fake, monkeypatch, tmp_path):
    monkeypatch.delenv("FAKE_MIRRORBENCH_SIZE")
    assert mirrorfigures("overview/speed-accuracy").returncode == 0
    first = paths.out() / "overview"
    rows = [path.read_text() for path in sorted((paths.out() / ".runs").glob("*/rows.jsonl"))]
    (tmp_path / "results.jsonl").write_text("".join(rows))
    monkeypatch.setenv("MIRRORBENCH_RESULTS", str(tmp_path / "results.jsonl"))
    monkeypatch.setenv("MIRRORBENCH_BIN", str(tmp_path / "there is none"))
    monkeypatch.setenv("MIRRORBENCH_FIGURES", str(tmp_path / "again"))
    done = mirrorfigures("overview/speed-accuracy")
    assert done.returncode == 0, done.stderr
    again = paths.out() / "overview"
    for suffix in ("png", "pdf", "json"):
        name = f"speed-accuracy.{suffix}"
        assert (again / name).read_bytes() == (first / name).read_bytes(), name
    assert "1.70 (1.60–1.80), slower" in Links((paths.out() / "index.html").read_text()).text
    (tmp_path / "results.jsonl").write_text("".join(rows[1:]))
    done = mirrorfigures("overview/speed-accuracy")
    assert done.returncode == 1
    assert "has no times of" in done.stderr


@pytest.mark.parametrize(("arguments", "code"), [(["--list"], 0), (["nobody/1"], 2)])
def test_arguments(fake, arguments, code):
    done = mirrorfigures(*arguments)
    assert done.returncode == code
    assert "patow-1995/1" in (done.stdout if code == 0 else done.stderr)
