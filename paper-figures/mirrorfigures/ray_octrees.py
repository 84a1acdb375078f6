"""Ray octrees as a run of `reflection-morphing` has them on the device (Martin & Popescu 2004, section 4.2)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .runs import Run

_PASS = "reflection-morphing/look-up-still"
_ARRAYS = ("cells", "starts", "lists", "segments")
BUFFERS = tuple(f"{_PASS}:{name}" for name in _ARRAYS)
"""What a run must dump; of its eight octrees the last one asked is kept."""

_RAY_WORDS = 8


@dataclass(frozen=True)
class Octree:
    """How large one is."""

    bytes: int
    rays: int
    lists: np.ndarray
    """Rays in each leaf."""

    @property
    def entries(self) -> int:
        """Rays in all leaves; one that crosses ten counts ten times."""
        return int(self.lists.sum())

    @property
    def mean(self) -> float:
        """Rays a leaf, of those that hold any."""
        return float(self.lists[self.lists > 0].mean())

    @property
    def largest(self) -> int:
        return int(self.lists.max())


def dumped(run: Run) -> Octree:
    """That of a run told to dump `BUFFERS`."""
    folder = Path(run.files) / "dump" / _PASS
    arrays = {name: np.load(folder / f"{name}.npy") for name in _ARRAYS}
    lists = np.diff(arrays["starts"].astype(np.int64))
    return Octree(sum(a.nbytes for a in arrays.values()), arrays["segments"].size // _RAY_WORDS, lists)
