"""Embree as a referee: traces rays against triangles for the program that started this one.

Speaks over stdin and stdout, all numbers little-endian, arrays row-major and without padding:

    request  `M` u32 n, f32[n][3][3]              triangles of the scene; replaces the ones before
    reply    u32 n                                once Embree's tree is built
    request  `R` u32 n, f32[n][3], f32[n][3]      origins and directions of rays
    reply    u64 nanoseconds, i32[n], f32[n]      of Embree's call alone; triangle (-1 for none) and
                                                  distance in lengths of the direction

Rays start at distance 0. They are traced on one thread, one after the other, in Embree's robust mode
where `--robust` is given. Ends with the input.
"""

import sys
import time
from struct import pack, unpack

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

NO_HIT = 1e37  # what embreex leaves as the distance of a ray without a hit


def read(shape, dtype="<f4"):
    """The next array of the input."""
    array = np.empty(shape, dtype)
    view = memoryview(array).cast("B") if array.size else memoryview(b"")
    if sys.stdin.buffer.readinto(view) != len(view):
        raise EOFError("the input ends within an array")
    return array


def trace(scene, origins, directions):
    start = time.perf_counter_ns()
    hits = scene.run(origins, directions, output=1)
    return time.perf_counter_ns() - start, hits["primID"], hits["tfar"]


def main():
    robust = sys.argv[1:] == ["--robust"]
    scene = None
    while request := sys.stdin.buffer.read(1):
        (count,) = unpack("<I", sys.stdin.buffer.read(4))
        if request == b"M":
            scene = EmbreeScene(robust=robust)
            TriangleMesh(scene, read((count, 3, 3)))
            # The first ray builds the tree.
            trace(scene, np.zeros((1, 3), "f4"), np.ones((1, 3), "f4"))
            reply = [pack("<I", count)]
        else:
            nanoseconds, triangles, distances = trace(scene, read((count, 3)), read((count, 3)))
            distances[triangles < 0] = np.inf
            reply = [pack("<Q", nanoseconds), triangles.astype("<i4"), distances.astype("<f4")]
        for part in reply:
            sys.stdout.buffer.write(part)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
