"""The camera of a scene's frame, read off its file: where it stands, and where it sees a point."""

import tomllib
from dataclasses import dataclass, replace

import numpy as np

from . import paths


@dataclass(frozen=True)
class Camera:
    """A perspective camera; vectors are unit, halves are of the image at distance 1."""

    eye: np.ndarray
    forward: np.ndarray
    right: np.ndarray
    up: np.ndarray
    half_width: float
    half_height: float

    def widened(self, factor: float) -> "Camera":
        """Its image `factor` times as wide and as high."""
        return replace(
            self, half_width=factor * self.half_width, half_height=factor * self.half_height
        )

    def place(self, points: np.ndarray) -> np.ndarray:
        """Where points (... x 3, before the eye) lie on the image: across and down, 0 to 1."""
        towards = np.asarray(points) - self.eye
        distance = towards @ self.forward
        across = (towards @ self.right) / (distance * self.half_width)
        up = (towards @ self.up) / (distance * self.half_height)
        return np.stack([0.5 + 0.5 * across, 0.5 - 0.5 * up], axis=-1)


def description(scene: str) -> dict:
    """A scene's file: by its name, or by its path."""
    file = paths.SCENES / f"{scene.removesuffix('.toml')}.toml"
    return tomllib.loads(file.read_text(encoding="utf-8"))


def camera(scene: str, frame: int, size: str) -> Camera:
    """The perspective camera of a frame of a scene."""
    said = description(scene)
    view = said["camera"]
    time_s = frame / said.get("rate_hz", 24.0)
    eye, target = (_at(view, key, time_s) for key in ("eye", "target"))
    if orbit := view.get("orbit"):
        eye = target + _about_y(_orbited(orbit, time_s)) @ (eye - target)
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    width, height = (int(n) for n in size.split("x"))
    half_height = float(np.tan(np.radians(view["fov_deg"]) / 2))
    up = np.cross(right, forward)
    return Camera(eye, forward, right, up, half_height * width / height, half_height)


def _orbited(orbit: dict, time_s: float) -> float:
    """Radians a camera has gone round its target, counter-clockwise seen from above."""
    turn = 2 * np.pi * time_s / orbit["period_s"]
    if (sweep := orbit.get("sweep_deg")) is not None:
        turn = np.radians(sweep) * np.sin(turn)
    return float(np.radians(orbit.get("start_deg", 0.0)) + turn)


def _about_y(angle: float) -> np.ndarray:
    sin, cos = np.sin(angle), np.cos(angle)
    return np.array([(cos, 0, sin), (0, 1, 0), (-sin, 0, cos)])


def _at(view: dict, name: str, time_s: float) -> np.ndarray:
    """Eye or target at a time: blended linearly between keys."""
    if "keys" not in view:
        return np.array(view[name], float)
    times = [key["time_s"] for key in view["keys"]]
    values = np.array([key[name] for key in view["keys"]], float)
    return np.array([np.interp(time_s, times, column) for column in values.T])
