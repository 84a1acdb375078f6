"""The library runs against a stand-in for the binary, in folders of the test's own."""

import sys
from pathlib import Path

import pytest

from mirrorfigures import paths, runs

FAKE = Path(__file__).with_name("fake_mirrorbench.py")


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """The stand-in as the binary; returns the file that logs its calls, a line each."""
    binary = tmp_path / "bin" / "mirror bench"  # with a space, as paths may have
    binary.parent.mkdir()
    binary.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{FAKE}" "$@"\n')
    binary.chmod(0o755)
    log = tmp_path / "calls"
    log.touch()
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    (scenes / "columns.toml").write_text("one\n")
    monkeypatch.setenv("MIRRORBENCH_BIN", str(binary))
    monkeypatch.setenv("MIRRORBENCH_FIGURES", str(tmp_path / "out"))
    monkeypatch.setenv("FAKE_MIRRORBENCH_LOG", str(log))
    monkeypatch.setenv("FAKE_MIRRORBENCH_SIZE", "160x90")
    # Hundreds of short processes: starting threads for their small arrays costs more than it saves.
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    monkeypatch.setattr(paths, "SCENES", scenes)
    runs._ground.cache_clear()
    yield log
    runs._ground.cache_clear()
