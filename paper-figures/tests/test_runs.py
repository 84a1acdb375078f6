"""Runs are made once per content, and a failed one leaves nothing."""

import json

import pytest

from mirrorfigures import bench, follow, paths, render, runs


def calls(log):
    return [line for line in log.read_text().splitlines() if not line.startswith("list")]


def test_the_same_request_runs_once(fake):
    first = render("columns", "truth")
    again = render("columns", "truth")
    assert first.row == again.row
    assert len(calls(fake)) == 1
    render("columns", "environment-map")
    render("columns", "truth", size="64x64")
    assert len(calls(fake)) == 3


def test_a_changed_scene_runs_again(fake):
    render("columns", "truth")
    (paths.SCENES / "columns.toml").write_text("two\n")
    runs._ground.cache_clear()
    render("columns", "truth")
    assert len(calls(fake)) == 2


def test_a_changed_binary_runs_again(fake):
    render("columns", "truth")
    with open(paths.binary(), "a", encoding="utf-8") as file:
        file.write("# another build\n")
    runs._ground.cache_clear()
    render("columns", "truth")
    assert len(calls(fake)) == 2


def test_a_failure_names_the_exit_code_and_leaves_nothing(fake):
    with pytest.raises(runs.RunFailed, match="exit 2: no scene 'no-such-scene'; there are"):
        render("no-such-scene", "truth")
    assert list((paths.out() / ".runs").iterdir()) == []


def test_bench_gives_a_row_a_case(fake):
    run = bench("columns", ["none", "environment-map"], size="64x64", frames="0..1", repeat=5)
    assert [row["case"] for row in run.rows] == ["none", "environment-map"]
    with pytest.raises(ValueError, match="2 rows"):
        run.row


def test_a_path_is_read_from_the_arrays_beside_the_results(fake):
    run = follow("columns", ["none", "environment-map"], size="64x64", frames="3..8")
    for row in run.rows:
        frames = run.path(row)
        assert [frame["frame"] for frame in frames] == [3, 4, 5, 6, 7]
        assert frames[1]["jitter_px"] == row["stability"]["jitter_px"]
        assert frames[0]["jitter_px"] is None


def test_rows_of_another_schema_are_refused(fake):
    folder = render("columns", "truth").files.parent
    row = json.loads((folder / "rows.jsonl").read_text())
    (folder / "rows.jsonl").write_text(json.dumps(row | {"schema_version": 1}) + "\n")
    with pytest.raises(runs.RunFailed, match="schema 1"):
        render("columns", "truth")


def test_frames_are_told_apart_by_number(fake, tmp_path):
    files = render("columns", "truth").files
    (files / "frame-0000.exr").rename(files / "columns-0012.exr")
    run = runs.Run([], files)
    assert run.exr(12) == run.exr()
    with pytest.raises(FileNotFoundError, match="one EXR of frame 3"):
        run.exr(3)
