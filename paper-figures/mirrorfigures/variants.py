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


def head(fov_deg: float, eye: tuple, target: tuple, checks: tuple) -> str:
    """How a made scene begins: its camera, a light, a sky of one colour, the materials `mirror` and `paint`, which is checked."""
    return f"""about = "made for a figure"
[camera]
fov_deg = {fov_deg}
eye = {_vector(eye)}
target = {_vector(target)}
[lighting]
ambient = [0.4, 0.4, 0.4]
sun = [0.6, 0.6, 0.6]
towards_sun = [0.4, 0.8, 0.5]
[environment]
colour = [0.5, 0.6, 0.75]
[materials]
mirror = {{ mirror = {{ reflectance = 0.95 }} }}
paint = {{ checker = {{ even = [0.8, 0.2, 0.15], odd = [0.8, 0.6, 0.2], size = {_vector(checks)} }} }}
"""


def thing(name: str, shape: str, material: str, at: tuple, turned: tuple = (0, 0, 0), more: str = "") -> str:
    """An object of a made scene; `turned` in degrees, `more` further lines of it."""
    return (
        f'[[objects]]\nname = "{name}"\nshape = {{ {shape} }}\nmaterial = "{material}"\n'
        f"position = {_vector(at)}\nrotation_deg = {_vector(turned)}\n{more}"
    )


def _vector(values: tuple) -> str:
    return "[" + ", ".join(f"{float(value):.6f}" for value in values) + "]"


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
