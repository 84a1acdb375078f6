"""Scenes made for one figure: a text, kept by its content below the folder of results."""

import hashlib

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
