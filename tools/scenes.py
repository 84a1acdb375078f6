#!/usr/bin/env python3
"""Writes the scenes of Estalella et al. 2006 that are too long to write by hand, with the models they
need: `ufo.toml`, `ants.toml`, `models/{ant,truck,building-*}.{obj,mtl}`.

    python3 tools/scenes.py

Run again it writes the same files. The models are the project's own work, under its licence.
"""

import math
import random
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent / "scenes"
MADE = "# Made by tools/scenes.py.\n"


class Model:
    """An OBJ file in the making: faces by material."""

    def __init__(self):
        self.points, self.faces = [], {}

    def add(self, material, points, faces):
        base = len(self.points) + 1
        self.points += points
        self.faces.setdefault(material, []).extend([[base + i for i in face] for face in faces])

    def box(self, material, low, high):
        points = [tuple((low, high)[i >> k & 1][k] for k in range(3)) for i in range(8)]
        faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
        self.add(material, points, faces)

    def ellipsoid(self, material, centre, radii, slices, stacks):
        rows = [math.pi * (i + 1) / stacks - math.pi / 2 for i in range(stacks - 1)]
        turns = [2 * math.pi * j / slices for j in range(slices)]
        units = [(math.cos(r) * math.cos(t), math.sin(r), -math.cos(r) * math.sin(t)) for r in rows for t in turns]
        units += [(0, -1, 0), (0, 1, 0)]
        points = [tuple(c + u * r for c, u, r in zip(centre, unit, radii)) for unit in units]
        bottom, top = len(units) - 2, len(units) - 1
        faces = []
        for j in range(slices):
            k = (j + 1) % slices
            faces.append([bottom, k, j])
            for i in range(stacks - 2):
                a = i * slices
                faces.append([a + j, a + k, a + slices + k, a + slices + j])
            last = (stacks - 2) * slices
            faces.append([last + j, last + k, top])
        self.add(material, points, faces)

    def tube(self, material, path, radius, slices):
        """A round bar bent along a path, its ends open."""
        points = []
        for i, at in enumerate(path):
            ahead = path[min(i + 1, len(path) - 1)]
            behind = path[max(i - 1, 0)]
            along = unit([a - b for a, b in zip(ahead, behind)])
            side = unit(cross(along, (0.3, 1.0, 0.1)))
            up = cross(side, along)
            for j in range(slices):
                c, s = (f(2 * math.pi * j / slices) * radius for f in (math.cos, math.sin))
                points.append(tuple(p + c * a + s * b for p, a, b in zip(at, side, up)))
        faces = []
        for i in range(len(path) - 1):
            for j in range(slices):
                k = (j + 1) % slices
                a, b = i * slices, (i + 1) * slices
                faces.append([a + j, b + j, b + k, a + k])
        self.add(material, points, faces)

    def cylinder(self, material, centre, radius, width, slices):
        """A wheel: its axis is z."""
        for side in (-1, 1):
            z = centre[2] + side * width / 2
            ring = [
                (centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t), z)
                for t in (2 * math.pi * j / slices for j in range(slices))
            ]
            fan = [[slices, j, (j + 1) % slices][:: side] for j in range(slices)]
            self.add(material, [*ring, (centre[0], centre[1], z)], fan)
        base = len(self.points) + 1 - 2 * (slices + 1)
        faces = []
        for j in range(slices):
            k = (j + 1) % slices
            faces.append([base + j, base + k, base + slices + 1 + k, base + slices + 1 + j])
        self.faces[material].extend(faces)

    def write(self, name, colours):
        lines = [f"# Made by tools/scenes.py.\nmtllib {name}.mtl"]
        lines += ["v " + " ".join(f"{c:.4f}" for c in point) for point in self.points]
        for material, faces in self.faces.items():
            lines.append(f"usemtl {material}")
            lines += ["f " + " ".join(str(i) for i in face) for face in faces]
        (SCENES / "models" / f"{name}.obj").write_text("\n".join(lines) + "\n")
        said = [f"newmtl {m}\nKd " + " ".join(map(str, colours[m])) for m in self.faces]
        (SCENES / "models" / f"{name}.mtl").write_text("\n".join(said) + "\n")


def unit(v):
    length = math.sqrt(sum(c * c for c in v))
    return tuple(c / length for c in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def placed(name, shape, material=None, position=(0, 0, 0), turn=0.0, keys=None):
    lines = ["", "[[objects]]", f'name = "{name}"', f"shape = {shape}"]
    if material:
        lines.append(f'material = "{material}"')
    if keys:
        lines.append("keys = [")
        for time, at, angle in keys:
            lines.append(f"    {{ time_s = {time:g}, position = {floats(at)}, rotation_deg = {floats((0, angle, 0))} }},")
        lines.append("]")
    else:
        lines.append(f"position = {floats(position)}")
        if turn:
            lines.append(f"rotation_deg = {floats((0, turn, 0))}")
    return lines


def floats(values):
    return "[" + ", ".join(str(round(float(v), 4) + 0.0) for v in values) + "]"


# The square of figure 8.


def building(width, height, depth, across, floors, side):
    """Walls, and a window pane a little before them at each place of a grid on all four sides."""
    model = Model()
    model.box("wall", (-width / 2, 0, -depth / 2), (width / 2, height, depth / 2))
    out = 0.06
    for half, span, count, axis in ((depth / 2, width, across, 0), (width / 2, depth, side, 2)):
        for sign in (-1, 1):
            for i in range(count):
                for j in range(floors):
                    u = span * ((i + 0.5) / count - 0.5)
                    v = height * (j + 0.6) / (floors + 0.4)
                    w, h = 0.32 * span / count, 0.3 * height / floors
                    corners = [(u - w, v - h), (u + w, v - h), (u + w, v + h), (u - w, v + h)]
                    far = sign * (half + out)
                    points = [(a, b, far) if axis == 0 else (far, b, a) for a, b in corners]
                    flip = (sign < 0) == (axis == 0)
                    model.add("window", points, [[3, 2, 1, 0] if flip else [0, 1, 2, 3]])
    return model


def truck():
    model = Model()
    model.box("cargo", (-3.2, 0.9, -1.2), (1.2, 3.4, 1.2))
    model.box("cab", (1.4, 0.7, -1.15), (3.0, 2.6, 1.15))
    model.box("glass", (2.96, 1.7, -1.0), (3.04, 2.4, 1.0))
    model.box("frame", (-3.2, 0.6, -0.9), (3.0, 0.9, 0.9))
    for x in (-2.4, -1.2, 2.2):
        for z in (-1.0, 1.0):
            model.cylinder("tyre", (x, 0.5, z), 0.5, 0.35, 32)
    return model


BUILDINGS = {
    "building-a": (9.0, 12.0, 8.0, 9, 6, 8),
    "building-b": (8.0, 18.0, 8.0, 8, 9, 7),
    "building-c": (7.0, 24.0, 7.0, 6, 11, 6),
    "building-d": (10.0, 30.0, 9.0, 7, 12, 6),
}


def ufo():
    for name, plan in BUILDINGS.items():
        building(*plan).write(name, {"wall": (0.6, 0.55, 0.48), "window": (0.2, 0.3, 0.42)})
    truck().write(
        "truck",
        {"cargo": (0.75, 0.75, 0.7), "cab": (0.7, 0.15, 0.1), "glass": (0.15, 0.2, 0.25),
         "frame": (0.12, 0.12, 0.13), "tyre": (0.06, 0.06, 0.06)},
    )
    lines = [MADE + UFO_HEAD]
    choice = random.Random(2006)
    ring = [(x, z) for x in (-36, -25.5, -15.3, -5.1, 5.1, 15.3, 25.5, 36) for z in (-37, 37)]
    ring += [(x, z) for z in (-25.5, -15.3, -5.1, 5.1, 15.3, 25.5) for x in (-37, 37)]
    ring += [(x, -49) for x in (-30, -18, -6, 6, 18, 30)] + [(x, z) for x in (-49, 49) for z in (-20, 0, 20)]
    for i, (x, z) in enumerate(ring):
        name = list(BUILDINGS)[choice.randrange(4)]
        wall = choice.choice(["plaster", "brick", "stone", "ochre"])
        shape = f'{{ obj = {{ file = "models/{name}.obj", materials = {{ wall = "{wall}", window = "pane" }} }} }}'
        lines += placed(f"building-{i + 1}", shape, position=(x, 0, z))
    for i in range(6):
        lane, along = (-9.0, 1) if i % 2 == 0 else (3.0, -1)
        # 20 m apart in a lane; 6 m a second.
        begin = along * (-50.0 + 20.0 * (i // 2))
        keys = [(0.0, (begin, 0, lane), 0.0 if along > 0 else 180.0),
                (10.0, (begin + along * 60.0, 0, lane), 0.0 if along > 0 else 180.0)]
        lines += placed(f"truck-{i + 1}", '{ obj = { file = "models/truck.obj" } }', keys=keys)
    for i in range(12):
        x, z = (-22.0 + 8.8 * (i % 6), (-18.0, 18.0)[i // 6])
        shape = '{ obj = { file = "models/classic-lamppost.obj" } }'
        lines += placed(f"lamp-{i + 1}", shape, position=(x, 0, z))
    for i in range(6):
        shape = '{ obj = { file = "models/bench.obj" } }'
        lines += placed(f"bench-{i + 1}", shape, position=(-20.0 + 8.0 * i, 0, 20.0))
    craft = [(t, (0, 30.0 - 2.6 * t, 0), 20.0 * t) for t in range(0, 11, 2)]
    disc = "{ ellipsoid = { radii = [4.0, 1.1, 4.0], slices = 80, stacks = 48 } }"
    lines += placed("ufo", disc, "mirror", keys=craft)
    (SCENES / "ufo.toml").write_text("\n".join(lines) + "\n")


UFO_HEAD = """# After Estalella et al. 2006, figure 8: a city square of 40 buildings with trucks, and one big mirror: 63,915
# vertices (theirs: 63,884), which `virtual-objects:subdivide=3.7` makes 82,309 (theirs: 81,977).
about = "A mirror disc comes down over a city square while trucks drive by"
frames = 241
rate_hz = 24.0

[camera]
fov_deg = 45.0
near = 0.1
far = 300.0
keys = [
    { time_s = 0.0, eye = [0.0, 1.8, 26.0], target = [0.0, 27.0, 0.0] },
    { time_s = 10.0, eye = [0.0, 1.8, 14.0], target = [0.0, 3.7, 0.0] },
]

[lighting]
ambient = [0.36, 0.38, 0.42]
sun = [0.8, 0.75, 0.66]
towards_sun = [0.5, 0.8, 0.45]

[environment]
gradient = { zenith = [0.2, 0.4, 0.8], horizon = [0.82, 0.87, 0.92], nadir = [0.3, 0.28, 0.25] }

[materials]
mirror = { mirror = { reflectance = 0.92 } }
paving = { checker = { even = [0.62, 0.6, 0.56], odd = [0.48, 0.47, 0.45], size = [2.0, 2.0] } }
road = { colour = [0.22, 0.22, 0.23] }
plaster = { colour = [0.78, 0.74, 0.66] }
brick = { colour = [0.55, 0.28, 0.2] }
stone = { colour = [0.55, 0.55, 0.53] }
ochre = { colour = [0.75, 0.55, 0.25] }
pane = { colour = [0.2, 0.3, 0.42] }

[[objects]]
name = "plaza"
shape = { plane = { size = [60.0, 60.0] } }
material = "paving"

[[objects]]
name = "street"
shape = { plane = { size = [120.0, 120.0] } }
material = "road"
position = [0.0, -0.05, 0.0]"""


# The ants of figure 6.

# Just clear of the head: a point inside a mirror has no reflection in it.
EYES = ((0.225, 0.2, 0.074), (0.225, 0.2, -0.074))


def ant():
    model = Model()
    model.ellipsoid("body", (-0.2, 0.15, 0.0), (0.13, 0.09, 0.09), 24, 12)
    model.ellipsoid("body", (0.02, 0.14, 0.0), (0.1, 0.06, 0.06), 22, 12)
    model.ellipsoid("body", (0.2, 0.15, 0.0), (0.075, 0.06, 0.065), 22, 12)
    for side in (-1, 1):
        for lean in (-0.09, 0.0, 0.09):
            foot = 0.02 + 2.2 * lean
            path = [(0.02 + 0.5 * lean, 0.13, side * 0.04), (0.02 + lean, 0.2, side * 0.14),
                    (0.02 + 1.5 * lean, 0.15, side * 0.2), (foot, 0.0, side * 0.26)]
            model.tube("leg", path, 0.012, 8)
        feeler = [(0.26, 0.2, side * 0.03), (0.33, 0.27, side * 0.06), (0.4, 0.24, side * 0.09)]
        model.tube("leg", feeler, 0.006, 6)
    return model


def ants():
    ant().write("ant", {"body": (0.28, 0.1, 0.06), "leg": (0.16, 0.07, 0.05)})
    lines = [MADE + ANTS_HEAD]
    # Where each walks, and which way it looks: degrees counter-clockwise from +x.
    walks = [(-0.7, 0.45, -55.0), (0.55, 0.7, -120.0), (-0.35, -0.6, 20.0), (0.8, -0.35, 160.0)]
    for i, (x, z, turn) in enumerate(walks):
        ahead = (math.cos(math.radians(turn)), -math.sin(math.radians(turn)))
        for part, local, shape, material in [
            ("", (0.0, 0.0, 0.0), '{ obj = { file = "models/ant.obj" } }', None),
            (".left-eye", EYES[0], EYE_SHAPE, "mirror"),
            (".right-eye", EYES[1], EYE_SHAPE, "mirror"),
        ]:
            keys = []
            for time, gone in ((0.0, 0.0), (10.0, 0.3)):
                right = local[0] * ahead[0] + local[2] * -ahead[1]
                back = local[0] * ahead[1] + local[2] * ahead[0]
                at = (x + gone * ahead[0] + right, local[1], z + gone * ahead[1] + back)
                keys.append((time, at, turn))
            lines += placed(f"ant-{i + 1}{part}", shape, material, keys=keys)
    for i in range(12):
        angle = math.radians(30 * i + 15)
        away = 1.35 + 0.35 * (i % 2)
        position = (away * math.cos(angle), 0.225, away * math.sin(angle))
        shape = "{ cylinder = { radius = 0.15, height = 0.45, slices = 64 } }"
        lines += placed(f"can-{i + 1}", shape, f"can-{'abc'[i % 3]}", position)
    choice = random.Random(30153)
    for i in range(8):
        position = (choice.uniform(-0.4, 0.4), 0.04, choice.uniform(-0.4, 0.4))
        shape = "{ box = { size = [0.08, 0.08, 0.08] } }"
        lines += placed(f"sugar-{i + 1}", shape, "sugar", position, choice.uniform(0, 90))
    (SCENES / "ants.toml").write_text("\n".join(lines) + "\n")


EYE_SHAPE = "{ ellipsoid = { radii = [0.03, 0.025, 0.025], slices = 32, stacks = 16 } }"

ANTS_HEAD = """# After Estalella et al. 2006, figure 6: four ants with mirrors for eyes among cans and sugar: 14,856
# vertices (theirs: 14,859), which `virtual-objects:subdivide=0.14` makes 28,973 (theirs: 30,153).
about = "Four ants, whose eight eyes are mirrors, among cans with long thin triangles"
frames = 241
rate_hz = 24.0

[camera]
fov_deg = 50.0
near = 0.01
far = 50.0
keys = [
    { time_s = 0.0, eye = [0.0, 1.5, 2.6], target = [0.0, 0.1, 0.0] },
    { time_s = 5.0, eye = [0.3, 0.9, 0.9], target = [-0.4, 0.15, 0.6] },
    { time_s = 10.0, eye = [-0.347, 0.254, 1.053], target = [-0.459, 0.2, 0.922] },
]

[lighting]
ambient = [0.36, 0.38, 0.42]
sun = [0.8, 0.75, 0.66]
towards_sun = [0.5, 0.8, 0.3]

[environment]
gradient = { zenith = [0.25, 0.45, 0.8], horizon = [0.85, 0.88, 0.9], nadir = [0.3, 0.28, 0.25] }

[materials]
mirror = { mirror = { reflectance = 0.9 } }
ground = { checker = { even = [0.7, 0.66, 0.55], odd = [0.5, 0.45, 0.36], size = [0.2, 0.2] } }
sugar = { colour = [0.92, 0.92, 0.9] }
can-a = { checker = { even = [0.75, 0.1, 0.1], odd = [0.9, 0.9, 0.88], size = [0.25, 0.5] } }
can-b = { checker = { even = [0.1, 0.3, 0.65], odd = [0.9, 0.9, 0.88], size = [0.25, 0.5] } }
can-c = { checker = { even = [0.15, 0.5, 0.2], odd = [0.9, 0.85, 0.3], size = [0.25, 0.5] } }

[[objects]]
name = "ground"
shape = { plane = { size = [6.0, 6.0] } }
material = "ground\""""


if __name__ == "__main__":
    ufo()
    ants()
