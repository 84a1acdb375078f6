"""Where things are. MIRRORBENCH_SCENES, MIRRORBENCH_BIN, MIRRORBENCH_FIGURES and MIRRORBENCH_RESULTS
override."""

import os
from pathlib import Path

FIGURES = Path(__file__).resolve().parents[1]
ROOT = FIGURES.parent
SCENES = Path(os.environ.get("MIRRORBENCH_SCENES", ROOT / "scenes"))
VENDOR = FIGURES / "vendor"


def binary() -> Path:
    """The release build, where tools/setup leaves it."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return Path(os.environ.get("MIRRORBENCH_BIN", target / "release" / "mirrorbench"))


def out() -> Path:
    """The folder the figures are written to."""
    return Path(os.environ.get("MIRRORBENCH_FIGURES", FIGURES / "out"))


def results() -> Path | None:
    """A results file to draw benchmarks from instead of running them."""
    named = os.environ.get("MIRRORBENCH_RESULTS")
    return Path(named) if named else None
