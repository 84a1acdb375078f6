"""One rendered frame: the layers of a multi-layer EXR as arrays, row 0 on top."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenEXR

NO_OBJECT = 0xFFFFFFFF
MISSING, FOUND, ENVIRONMENT = 0, 1, 2


@dataclass(frozen=True)
class Frame:
    """What one case drew, and the evidence for it. Images are height x width (x 3)."""

    colour: np.ndarray
    """Finished picture, linear Rec.709, float32."""
    depth: np.ndarray
    """Distance from the camera's plane, metres; infinite on the background."""
    reflection: np.ndarray
    """Light arriving at the reflector along the mirrored chain, linear."""
    point: np.ndarray
    """The scene point shown, metres; a unit direction where the environment is shown."""
    object: np.ndarray
    """Id of the object shown, NO_OBJECT where none is."""
    order: np.ndarray
    """Number of reflectors met."""
    status: np.ndarray
    """MISSING, FOUND or ENVIRONMENT."""
    direct_object: np.ndarray
    """Id of the object seen directly, NO_OBJECT on the background."""
    reflector: np.ndarray
    """Id of the reflector seen, NO_OBJECT elsewhere."""
    position: np.ndarray
    """The reflector's surface point, metres."""
    normal: np.ndarray
    """The reflector's unit shading normal."""

    @property
    def mirror(self) -> np.ndarray:
        """True where a reflector is seen."""
        return self.reflector != NO_OBJECT

    def shows(self, object_id: int) -> np.ndarray:
        """True where a mirror shows the object."""
        return self.mirror & (self.status == FOUND) & (self.object == object_id)


def read_channels(path: Path) -> dict[str, np.ndarray]:
    """Every channel of an EXR by its full name."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: channel.pixels for name, channel in file.channels().items()}


def _stack(channels: dict[str, np.ndarray], prefix: str, axes: str) -> np.ndarray:
    return np.stack([channels[prefix + axis] for axis in axes], axis=-1).astype(np.float32)


def read_frame(path: Path) -> Frame:
    """The layers the renderer writes with `--record full`; KeyError names one that is not there."""
    channels = read_channels(path)

    def ids(name: str) -> np.ndarray:
        return channels[name].astype(np.uint32)

    return Frame(
        colour=_stack(channels, "", "RGB"),
        depth=channels["Z"].astype(np.float32),
        reflection=_stack(channels, "reflection.", "RGB"),
        point=_stack(channels, "shown.", "XYZ"),
        object=ids("shown.object"),
        order=ids("shown.order"),
        status=ids("shown.status"),
        direct_object=ids("object.id"),
        reflector=ids("reflector.id"),
        position=_stack(channels, "position.", "XYZ"),
        normal=_stack(channels, "normal.", "XYZ"),
    )


def cube_faces(path: Path) -> np.ndarray:
    """The six faces of a dumped cube map, 6 x size x size x 3, in the order +X -X +Y -Y +Z -Z.

    `--dump` writes `dump/<pass>/<variable>.exr`, a cube as layers `face0` to `face5`.
    """
    channels = read_channels(path)
    return np.stack([_stack(channels, f"face{face}.", "RGB") for face in range(6)])
