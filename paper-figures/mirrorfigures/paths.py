"""Where things are. MIRRORBENCH_SCENES, MIRRORBENCH_BIN and MIRRORBENCH_FIGURES override."""

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
