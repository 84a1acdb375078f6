#!/usr/bin/env python3
"""Writes the models of the scenes `statue` and `statue-knot`: models/{statue,bumpy-sphere,knot}.obj.

    python3 tools/statue.py

Run again it writes the same files. The models are the project's own work, under its licence.
"""

import math
from itertools import product

from scenes import SCENES, cross, unit

# Nine blobs: centre and radius, metres. Feet, hips, chest, arms, hands, head.
BLOBS = [
    ((-0.15, 0.12, 0.02), 0.15), ((0.15, 0.12, 0.02), 0.15), ((0.0, 0.42, 0.0), 0.26),
    ((0.0, 0.78, 0.02), 0.23), ((-0.30, 0.86, 0.06), 0.12), ((0.30, 0.84, 0.10), 0.12),
    ((0.42, 1.04, 0.20), 0.12), ((-0.42, 0.66, 0.18), 0.12), ((0.0, 1.16, 0.04), 0.17),
]
# Edge of the cells the surface is sought in.
CELL = 0.045
# How sharply a blob ends at its radius.
SHARP = 2.5


def field(p):
    """Above 0 inside the statue, which stands on the ground."""
    total = 0.0
    for centre, radius in BLOBS:
        square = sum((a - b) ** 2 for a, b in zip(p, centre)) / radius**2
        total += math.exp(SHARP * (1.0 - square))
    return total - 1.0


def statue():
    """Naive surface nets: a vertex in each cell the surface passes, a face across each edge it passes."""
    low, size = (-0.72, -0.18, -0.45), (32, 38, 22)
    at = lambda i: tuple(l + CELL * n for l, n in zip(low, i))
    value = {i: field(at(i)) for i in product(*(range(n + 1) for n in size))}
    corners = list(product((0, 1), repeat=3))
    edges = [(a, b) for a in corners for b in corners if a < b and sum(x != y for x, y in zip(a, b)) == 1]
    add = lambda i, j: tuple(a + b for a, b in zip(i, j))
    vertices, points = {}, []
    for cell in product(*map(range, size)):
        crossings = []
        for a, b in edges:
            va, vb = value[add(cell, a)], value[add(cell, b)]
            if (va > 0) != (vb > 0):
                share = va / (va - vb)
                pa, pb = at(add(cell, a)), at(add(cell, b))
                crossings.append([x + share * (y - x) for x, y in zip(pa, pb)])
        if crossings:
            vertices[cell] = len(points)
            points.append(on_surface([sum(c) / len(crossings) for c in zip(*crossings)]))
    faces = []
    for i in value:
        for axis in range(3):
            step = tuple(int(k == axis) for k in range(3))
            if add(i, step) not in value or (value[i] > 0) == (value[add(i, step)] > 0):
                continue
            u, v = (tuple(-int(k == (axis + n) % 3) for k in range(3)) for n in (1, 2))
            ring = [add(i, o) for o in ((0, 0, 0), u, add(u, v), v)]
            face = [vertices[cell] for cell in ring]
            faces.append(face if value[i] > 0 else face[::-1])
    return points, faces


def on_surface(p):
    """A point moved along the field's slope to where it is 0."""
    for _ in range(4):
        slope = [(field([c + 1e-4 * (k == axis) for k, c in enumerate(p)]) - field(p)) / 1e-4 for axis in range(3)]
        square = sum(s * s for s in slope)
        p = [c - field(p) * s / square for c, s in zip(p, slope)]
    return p


def bumpy_sphere():
    """Radius 1, in and out by 0.04 sin 6 theta sin 6 phi."""
    stacks, slices = 40, 80
    points = [(0, -1, 0)]
    for i in range(1, stacks):
        theta = math.pi * i / stacks
        for j in range(slices):
            phi = 2 * math.pi * j / slices
            # The bumps fade at the poles, where slices meet.
            r = 1 + 0.04 * math.sin(6 * theta) * math.sin(6 * phi) * math.sin(theta)
            points.append((r * math.sin(theta) * math.cos(phi), -r * math.cos(theta), -r * math.sin(theta) * math.sin(phi)))
    points.append((0, 1, 0))
    faces = []
    for j in range(slices):
        k = (j + 1) % slices
        faces.append([0, 1 + k, 1 + j])
        for i in range(stacks - 2):
            a, b = 1 + i * slices, 1 + (i + 1) * slices
            faces.append([a + j, a + k, b + k, b + j])
        last = 1 + (stacks - 2) * slices
        faces.append([last + j, last + k, len(points) - 1])
    return points, faces


def knot():
    """A trefoil of a tube 0.25 thick, upright, 1.3 m from its middle to its farthest."""
    steps, slices, scale, radius = 144, 20, 0.42, 0.2
    curve = lambda t: tuple(scale * c for c in (
        math.sin(t) + 2 * math.sin(2 * t), math.cos(t) - 2 * math.cos(2 * t), -math.sin(3 * t)))
    points, faces = [], []
    for i in range(steps):
        t = 2 * math.pi * i / steps
        along = unit([a - b for a, b in zip(curve(t + 1e-3), curve(t - 1e-3))])
        side = unit(cross(along, (0, 0, 1)))
        up = cross(side, along)
        for j in range(slices):
            c, s = (f(2 * math.pi * j / slices) * radius for f in (math.cos, math.sin))
            points.append(tuple(p + c * a + s * b for p, a, b in zip(curve(t), side, up)))
            k, a, b = (j + 1) % slices, i * slices, (i + 1) % steps * slices
            faces.append([a + j, b + j, b + k, a + k])
    return points, faces


def write(name, shape, paint=None):
    points, faces = shape
    lines = ["# Made by tools/statue.py."]
    lines += ["v " + " ".join(f"{c:.4f}" for c in point) for point in points]
    if paint:
        lines += ["vt " + " ".join(f"{c:.4f}" for c in paint(point)) for point in points]
    corner = (lambda i: f"{i + 1}/{i + 1}") if paint else (lambda i: f"{i + 1}")
    lines += ["f " + " ".join(map(corner, face)) for face in faces]
    (SCENES / "models" / f"{name}.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    # Painted from the front, a little askew.
    write("statue", statue(), paint=lambda p: (p[0] + 0.45 * p[2], p[1] + 0.3 * p[2]))
    write("bumpy-sphere", bumpy_sphere())
    write("knot", knot())
