"""Scenes made for one figure: a text, kept by its content below the folder of results."""

import hashlib
import shutil
from pathlib import Path

from . import paths


def scene_file(name: str, text: str) -> str:
    """The path of a scene file with this text; its name begins with `name`."""
    digest = hashlib.sha256(text.encode()).hexdigest()[:12]
    path = paths.out() / ".scenes" / f"{name}-{digest}.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return str(path)


def changed(scene: str, old: str, new: str) -> str:
    """The path of a shipped scene with one passage of its text replaced, which must be there once."""
    text = (paths.SCENES / f"{scene}.toml").read_text(encoding="utf-8")
    if text.count(old) != 1:
        raise ValueError(f"{scene}.toml has {old!r} {text.count(old)} times, expected once")
    return scene_file(scene, text.replace(old, new))


def alike(scene: str, old: str, new: str) -> str:
    """As `changed`, but under the shipped scene's name: its frames may be held against one another."""
    path = Path(changed(scene, old, new)).with_suffix("") / f"{scene}.toml"
    path.parent.mkdir(exist_ok=True)
    shutil.copyfile(path.parent.with_suffix(".toml"), path)
    return str(path)


def glide() -> str:
    """The path of a scene in which the kitchen's camera glides by the bowl, two and a half millimetres a
    frame: from the place of frame 144 of `kitchen-table1`, across its line to the bowl."""
    return changed("kitchen-table1", _APPROACH, _GLIDE)


_APPROACH = """keys = [
    { time_s = 0.0, eye = [1.8, 1.6, 1.5], target = [0.0, 0.9, 0.0] },
    { time_s = 8.0, eye = [0.436, 1.151, 0.363], target = [0.0, 0.9, 0.0] },
]"""
_GLIDE = """keys = [
    { time_s = 0.0, eye = [0.777, 1.263, 0.647], target = [0.0, 0.9, 0.0] },
    { time_s = 2.0, eye = [0.7002, 1.263, 0.7394], target = [0.0, 0.9, 0.0] },
]"""
