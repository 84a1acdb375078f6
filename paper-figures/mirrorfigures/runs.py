"""Runs of the binary, kept by content: the same request on the same build and scenes runs once.

A run lives in `out/.runs/<key>/`: the rows it printed (`rows.jsonl`) and the files it wrote
(`files/`). It is made aside and renamed, so an interrupted one leaves nothing behind that counts.
"""

import functools
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from . import paths
from .exr import Frame, read_frame

SCHEMA_VERSION = 2

FILES = "{files}"
"""Stands in arguments for the folder of a run's files, which is known only when it is made."""


class RunFailed(RuntimeError):
    """The binary refused or failed; the message is its own."""


@dataclass(frozen=True)
class Run:
    """Rows and files of one call of the binary."""

    rows: list[dict]
    files: Path

    @property
    def row(self) -> dict:
        """The only row of a run that has one."""
        if len(self.rows) != 1:
            raise ValueError(f"{self.files.parent} has {len(self.rows)} rows, expected one")
        return self.rows[0]

    def frame(self, number: int | None = None) -> Frame:
        """The frame of that number; without one, the only frame."""
        return read_frame(self.exr(number))

    def exr(self, number: int | None = None) -> Path:
        """Frames are told apart by the last number in their file names."""
        found = [p for p in sorted(self.files.rglob("*.exr")) if "dump" not in p.parts]
        if number is not None:
            found = [p for p in found if _last_number(p.stem) == number]
        if len(found) != 1:
            wanted = "one EXR" if number is None else f"one EXR of frame {number}"
            raise FileNotFoundError(f"expected {wanted} below {self.files}, found {len(found)}")
        return found[0]

    def path(self, row: dict) -> list[dict]:
        """The frames of a followed path, in order."""
        return self._arrays(row)["path"]

    def pass_ms(self, row: dict, name: str) -> list[float]:
        """GPU milliseconds of a pass in every frame timed, in the order played."""
        return [frame["passes_gpu_ms"][name] for frame in self._arrays(row)["timed"]]

    def path_counters(self, row: dict) -> list[dict]:
        """The work of each frame of a followed path, in order, by counter."""
        return self._arrays(row)["path_counters"]

    def _arrays(self, row: dict) -> dict:
        """What stands beside the results, a value a frame."""
        return json.loads((self.files / f"{row['run']}.frames.json").read_text(encoding="utf-8"))


def _last_number(stem: str) -> int | None:
    numbers = re.findall(r"\d+", stem)
    return int(numbers[-1]) if numbers else None


def render(
    scene: str, case: str, *, frame: int = 0, size: str = "1280x720", dump: str | tuple[str, ...] = ()
) -> Run:
    """Draw one frame of one case with its evidence, judged against the truth unless it is the truth;
    the run has one row and one frame, and below `dump` what it was told to dump."""
    judged = 0 if re.split("[@:]", case)[0] == "truth" else 1
    arguments = ["render", "--scene", scene, "--case", case, "--frame", str(frame)]
    arguments += ["--size", size, "--record", "full", "--truth-frames", str(judged)]
    for pattern in (dump,) if isinstance(dump, str) else dump:
        arguments += ["--dump", pattern]
    return _run(arguments)


def bench(
    scene: str, cases: list[str], *, size: str, frames: str, repeat: int, fallback: str = "none"
) -> Run:
    """Time and judge cases on a scene, what they leave or doubt filled by `fallback`; one row a case.

    MIRRORBENCH_RESULTS names a results file to take the rows from instead: nothing runs then.
    """
    if file := paths.results():
        return _kept(file, scene, cases, size, frames, fallback)
    arguments = ["bench", "--scene", scene, "--size", size, "--frames", frames]
    arguments += ["--repeat", str(repeat)]
    arguments += ["--fallback", fallback] if fallback != "none" else []
    for case in cases:
        arguments += ["--case", case]
    return _run(arguments)


def follow(scene: str, cases: list[str], *, size: str, frames: str) -> Run:
    """Follow a path for cases on a scene; one row a case, whose frames `Run.path` reads."""
    arguments = ["bench", "--scene", scene, "--size", size, "--frames", frames]
    arguments += ["--repeat", "1", "--truth-frames", "0", "--path"]
    for case in cases:
        arguments += ["--case", case]
    return _run(arguments)


def film(scene: str, cases: list[str], *, size: str, frames: str) -> Run:
    """Film frames of the first case with the others beside it, into the run's file `film.png`."""
    arguments = ["render", "--scene", scene, "--size", size, "--frames", frames, "--case", cases[0]]
    arguments += ["--film", f"{FILES}/film.png"]
    for case in cases[1:]:
        arguments += ["--beside", case]
    return _run(arguments)


def compare(truth: Run, other: Run) -> dict:
    """The accuracy of a run's only frame held against another's: of scenes of one name, seen alike."""
    arguments = ["diff", str(truth.exr()), str(other.exr()), "--json"]
    done = subprocess.run([str(paths.binary()), *arguments], capture_output=True, check=False)
    if done.returncode != 0:
        raise RunFailed(_complaint(arguments, done))
    return json.loads(done.stdout)["accuracy"]


def _kept(file: Path, scene: str, cases: list[str], size: str, frames: str, fallback: str) -> Run:
    """The file's last row of each case."""
    begin, end = (int(n) for n in frames.split(".."))
    wanted = (scene, [int(n) for n in size.split("x")], list(range(begin, end)), fallback)
    rows = {}
    for row in _rows(file):
        about = (row["scene"]["name"], row["size"], row["frames"], row["fallback"])
        if row["frame_gpu_ms"] and about == wanted:
            rows[row["case"]] = row
    if missing := [case for case in cases if case not in rows]:
        raise RunFailed(f"{file} has no times of {scene} at {size}, frames {frames}: {', '.join(missing)}")
    return Run([rows[case] for case in cases], file.parent)


def _rows(file: Path) -> list[dict]:
    rows = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    for row in rows:
        if row["schema_version"] != SCHEMA_VERSION:
            raise RunFailed(f"row of schema {row['schema_version']}, these figures read {SCHEMA_VERSION}")
    return rows


def _run(arguments: list[str]) -> Run:
    folder = paths.out() / ".runs" / _key(arguments)
    if not folder.is_dir():
        _make(arguments, folder)
    return Run(_rows(folder / "rows.jsonl"), folder / "files")


def _make(arguments: list[str], folder: Path) -> None:
    folder.parent.mkdir(parents=True, exist_ok=True)
    aside = Path(tempfile.mkdtemp(prefix="making-", dir=folder.parent))
    try:
        placed = [argument.replace(FILES, str(aside / "files")) for argument in arguments]
        command = [str(paths.binary()), *placed, "--json", "--out", str(aside / "files")]
        print("  mirrorbench " + " ".join(arguments), file=sys.stderr, flush=True)
        (aside / "files").mkdir()
        done = subprocess.run(command, capture_output=True, cwd=paths.ROOT, check=False)
        if done.returncode != 0:
            raise RunFailed(_complaint(arguments, done))
        (aside / "rows.jsonl").write_bytes(done.stdout)
        try:
            os.rename(aside, folder)
        except OSError:
            if not folder.is_dir():  # not simply made by somebody else meanwhile
                raise
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _complaint(arguments: list[str], done: subprocess.CompletedProcess) -> str:
    """What was asked, and the last line the binary said about it."""
    said = done.stderr.decode(errors="replace").strip().splitlines()
    return f"mirrorbench {' '.join(arguments)}: exit {done.returncode}: {said[-1] if said else ''}"


def _key(arguments: list[str]) -> str:
    digest = hashlib.sha256(_ground())
    digest.update("\0".join(arguments).encode())
    return digest.hexdigest()[:24]


@functools.cache
def _ground() -> bytes:
    """Hash of what every run stands on: the binary, the scenes and assets, the devices offered."""
    digest = hashlib.sha256(paths.binary().read_bytes())
    for path in sorted(p for p in paths.SCENES.rglob("*") if p.is_file()):
        digest.update(str(path.relative_to(paths.SCENES)).encode() + b"\0" + path.read_bytes())
    arguments = ["list", "devices", "--json"]
    devices = subprocess.run([str(paths.binary()), *arguments], capture_output=True, check=False)
    if devices.returncode != 0:
        raise RunFailed(_complaint(arguments, devices))
    digest.update(devices.stdout)
    return digest.digest()
