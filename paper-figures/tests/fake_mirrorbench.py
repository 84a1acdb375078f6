#!/usr/bin/env python3
"""A stand-in for the binary: the same files and rows from a toy scene, so that the figure library is
tested without a Vulkan device. A mirror sphere on a chequered floor among diffuse balls.
"""

import argparse
import json
import os
import re
import sys
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

CENTRE, RADIUS = np.array([0.0, 1.0, 0.0]), 1.0
NO_OBJECT = 0xFFFFFFFF
COLOURS = np.array([[0.8, 0.1, 0.1], [0.1, 0.6, 0.1], [0.1, 0.2, 0.8], [0.8, 0.7, 0.1]])
COUNTERS = (
    "fetches", "hits", "visits", "texels", "texels-again", "texels-skipped", "map-reads", "nodes", "triangles",
    "evaluations", "halved", "no-room", "intersections", "most_intersections", "second_order", "look-ups", "rays",
    "segments",
)  # fmt: skip
FLOOR = len(COLOURS)
MIRROR = FLOOR + 1
NAMED = {
    "patow-room": {0: "quad", 1: "hidden-quad"},
    "statue": {0: "statue.default"},
    "slide9": {0: "statue.default"},
    "standins": {FLOOR: "box"},
    "border": {0: "near", FLOOR: "far"},
    "tube": {0: "tube"},
}
"""Objects some figures ask for by name, by scene; of a scene made for a figure by the first word of its file."""
FACES = [  # +X -X +Y -Y +Z -Z: forward, right, down of each face's image
    ((1, 0, 0), (0, 0, -1), (0, -1, 0)),
    ((-1, 0, 0), (0, 0, 1), (0, -1, 0)),
    ((0, 1, 0), (1, 0, 0), (0, 0, 1)),
    ((0, -1, 0), (1, 0, 0), (0, 0, -1)),
    ((0, 0, 1), (1, 0, 0), (0, -1, 0)),
    ((0, 0, -1), (-1, 0, 0), (0, -1, 0)),
]


def balls() -> list[tuple[np.ndarray, float]]:
    turns = np.radians([-60, -20, 20, 60])
    return [(np.array([1.8 * np.sin(a), 0.8, 1.8 * np.cos(a)]), 0.3) for a in turns]


def hit_sphere(origin, direction, centre, radius):
    to = origin - centre
    b = (to * direction).sum(-1)
    root = b * b - (to * to).sum(-1) + radius**2
    t = -b - np.sqrt(np.maximum(root, 0))
    return np.where((root > 0) & (t > 1e-4), t, np.inf)


def trace(origin, direction):
    """Object, point and colour of the diffuse scene along unit rays."""
    hits = [hit_sphere(origin, direction, *ball) for ball in balls()]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = -origin[..., 1] / direction[..., 1]
    hits.append(np.where(t > 1e-4, t, np.inf))
    t = np.min(hits, axis=0)
    found = np.isfinite(t)
    obj = np.where(found, np.argmin(hits, axis=0), NO_OBJECT).astype(np.uint32)
    point = np.where(found[..., None], origin + direction * np.where(found, t, 0)[..., None], direction)
    sky = np.full(direction.shape, [0.3, 0.5, 0.7]) + 0.3 * direction[..., 1:2]
    checker = (np.floor(point[..., 0] * 2) + np.floor(point[..., 2] * 2)) % 2
    colour = np.where(found[..., None], (0.35 + 0.3 * checker)[..., None], sky)
    for i, (centre, radius) in enumerate(balls()):
        light = 0.4 + 0.6 * np.clip((point - centre)[..., 1] / radius, 0, 1)
        colour = np.where((obj == i)[..., None], COLOURS[i] * light[..., None], colour)
    return obj, point, colour


def draw(case: str, width: int, height: int, frame: int) -> dict[str, np.ndarray]:
    # Never as far as the sphere, however late the frame.
    eye = np.array([0.0, 1.6, 4.2 - 0.011 * min(frame, 240)])
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    rays = np.stack([(x - width / 2) / height, (height / 2 - y) / height - 0.12, np.full(x.shape, -0.87)], -1)
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    eyes = np.broadcast_to(eye, rays.shape)
    t = hit_sphere(eyes, rays, CENTRE, RADIUS)
    obj, point, colour = trace(eyes, rays)
    direct = np.where(obj == NO_OBJECT, np.inf, np.linalg.norm(point - eyes, axis=-1))
    mirror = t < direct
    position = eyes + rays * np.where(mirror, t, 0)[..., None]
    normal = np.where(mirror[..., None], (position - CENTRE) / RADIUS, 0.0)
    out = rays - 2 * (rays * normal).sum(-1, keepdims=True) * normal
    start = position
    if "surface" in case:
        out = normal
    if case != "truth":
        start = np.broadcast_to(CENTRE, rays.shape)
    shown, shown_point, reflection = trace(start, out)
    if "layers=1" in case:  # a hole where the second object is
        shown = np.where(shown == 1, NO_OBJECT, shown).astype(np.uint32)
    final = np.where(mirror[..., None], 0.9 * reflection, colour)
    layers = {"Z": np.minimum(direct, t) * -rays[..., 2]}
    for i, axis in enumerate("RGB"):
        layers[axis] = final[..., i]
        layers[f"reflection.{axis}"] = np.where(mirror, reflection[..., i], 0)
    for i, axis in enumerate("XYZ"):
        layers[f"shown.{axis}"] = np.where(mirror, shown_point[..., i], 0)
        layers[f"normal.{axis}"] = normal[..., i]
        layers[f"position.{axis}"] = np.where(mirror, position[..., i], 0)
        layers[f"refracted.{axis}"] = layers[f"shown.{axis}"]
    layers = {name: np.ascontiguousarray(a, np.float32) for name, a in layers.items()}
    status = np.where(shown == NO_OBJECT, 2, 1)
    ids = {"shown.object": shown, "shown.order": 1, "shown.status": status, "reflector.id": MIRROR}
    ids["refracted.object"] = shown
    for name, value in ids.items():
        off = 0 if name in ("shown.order", "shown.status") else NO_OBJECT
        layers[name] = np.where(mirror, value, off).astype(np.uint32)
    layers["object.id"] = np.where(mirror, MIRROR, obj).astype(np.uint32)
    return layers


def cube(size: int) -> dict[str, np.ndarray]:
    s = (np.arange(size) + 0.5) / size * 2 - 1
    layers = {}
    for face, (forward, right, down) in enumerate(np.array(FACES, float)):
        rays = forward + s[None, :, None] * right + s[:, None, None] * down
        rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
        colour = trace(np.broadcast_to(CENTRE, rays.shape), rays)[2]
        for i, axis in enumerate("RGB"):
            layers[f"face{face}.{axis}"] = np.ascontiguousarray(colour[..., i], np.float32)
    return layers


def depths(size: int) -> dict[str, np.ndarray]:
    """Two layers of depths along the faces' axes: the bits of their inverse, and nothing behind."""
    s = (np.arange(size) + 0.5) / size * 2 - 1
    layers = {}
    for face, (forward, right, down) in enumerate(np.array(FACES, float)):
        rays = forward + s[None, :, None] * right + s[:, None, None] * down
        units = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
        obj, point, _ = trace(np.broadcast_to(CENTRE, rays.shape), units)
        inverse = np.where(obj == NO_OBJECT, 0, 1 / ((point - CENTRE) @ forward))
        layers[f"face{face}.R"] = np.ascontiguousarray(inverse, np.float32).view(np.uint32)
        layers[f"face{face + 6}.R"] = np.zeros((size, size), np.uint32)
    return layers


def ball(size: int) -> dict[str, dict[str, np.ndarray]]:
    """The images of a sphere map, by name."""
    s, t = np.meshgrid(*((np.arange(size) + 0.5) / size * 2 - 1,) * 2)
    z = np.sqrt(np.maximum(1 - s * s - t * t, 0))
    rays = np.stack([2 * z * s, -2 * z * t, 2 * z * z - 1], -1)
    obj, _, colour = trace(np.broadcast_to(CENTRE, rays.shape), rays)
    layers = {"map_ids": {"R": obj}}
    for name, image in (("map_radiance", colour), ("map_point", rays)):
        image = np.ascontiguousarray(np.moveaxis(image, -1, 0), np.float32)
        layers[name] = dict(zip("RGB", image, strict=True))
    return layers


def dump(wanted: list[str], folder, case: str, size: list[int], frame: int) -> None:
    images = {
        "environment-map/ball": lambda: ball(64),
        "environment-map/capture": lambda: {"radiance": cube(128)},
        "depth-impostors/portrait": lambda: portraits(64),
        "virtual-objects/gbuffer": lambda: gbuffer(case, *size, frame),
        "z-buffered-map/capture": lambda: {"surface": depths(128)},
    }
    for name in wanted:
        if name in images:
            for variable, layers in images[name]().items():
                save(folder / name / f"{variable}.exr", layers)
        elif ":" in name:
            file = folder / f"{name.replace(':', '/')}.npy"
            file.parent.mkdir(parents=True, exist_ok=True)
            np.save(file, morphed(case)[file.stem])


def morphed(case: str) -> dict[str, np.ndarray]:
    """Buffers of a grid of points before the mirror, all of them drawn, each case's a little apart; each pair of rows
    hides others."""
    x, y, z = (a.ravel() for a in np.meshgrid((-0.5, 0.5), np.linspace(0.6, 2.4, 12), (1.5, 3.5)))
    vertices = np.stack([x, y, z], 1)
    towards = np.array([0.3, 1.6, 4.0]) - CENTRE
    out = (vertices - CENTRE) / np.linalg.norm(vertices - CENTRE, axis=1)[:, None] + towards / np.linalg.norm(towards)
    seen = CENTRE + RADIUS * out / np.linalg.norm(out, axis=1)[:, None]
    images = CENTRE - (0.2 + 1e-4 * len(case)) * (vertices - CENTRE)
    empty = np.zeros((len(vertices), 1))
    corners = np.concatenate([vertices, empty, images, empty], 1).astype(np.float32)
    points = np.broadcast_to(np.concatenate([seen, empty + 1], 1), (8, len(vertices), 4)).astype(np.float32)
    triangles = np.stack([np.arange(40), np.arange(40) + 1, np.arange(40) + 2], 1).astype(np.uint32)
    words = {"corners": corners, "points": points, "source_indices": triangles}
    lists = np.arange(9, dtype=np.uint32)
    words |= {"cells": lists, "starts": lists, "lists": lists[:8], "segments": np.zeros((4, 8), np.uint32)}
    return {name: np.ascontiguousarray(a).ravel().view(np.uint32) for name, a in words.items()}


def gbuffer(case: str, width: int, height: int, frame: int) -> dict[str, dict[str, np.ndarray]]:
    """The mirror's points and normals, by name, in textures of the width the case names."""
    if named := re.search(r"texture=(\d+)", case):
        width, height = int(named[1]), int(named[1]) * height // width
    drawn = draw(case, width, height, frame)
    mask = (drawn["reflector.id"] == MIRROR).astype(np.float32)
    images = {"position": mask, "normal": 0 * mask}
    return {
        name: {c: drawn[f"{name}.{axis}"] for c, axis in zip("RGB", "XYZ", strict=True)} | {"A": alpha}
        for name, alpha in images.items()
    }


def portraits(size: int) -> dict[str, dict[str, np.ndarray]]:
    """Two depth images by name: a floor and a ball, metres before the picture's plane."""
    s, t = np.meshgrid(*((np.arange(size) + 0.5) / size * 2 - 1,) * 2)
    square = 0.6 - s * s - t * t
    heights = (0 * s, np.sqrt(np.maximum(square, 0)))
    there = (np.ones_like(s), square > 0)
    images = {}
    for name, alphas in (("point", heights), ("albedo", there)):
        images[name] = {
            f"face{i}.{c}": np.ascontiguousarray(alpha, np.float32) for i, alpha in enumerate(alphas) for c in "RGBA"
        }
    return images


def filmed(cases: list[str], width: int, height: int, frame: int) -> Image.Image:
    """A film's picture: the cases side by side."""
    drawn = [draw(case, width, height, frame) for case in cases]
    panels = [np.stack([layers[c] for c in "RGB"], -1) for layers in drawn]
    return Image.fromarray((255 * np.clip(np.concatenate(panels, 1), 0, 1)).astype(np.uint8))


def save(path: Path, layers: dict[str, np.ndarray]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, layers).write(str(path))


def row(scene: str, case: str, size: list[int], frame: int, timed: bool, baseline: str) -> dict:
    names = "particle-{}" if "particles" in scene else ["column-{}", "object-{}"][scene == "lecture"]
    objects = [names.format(i + 1) for i in range(FLOOR)] + ["floor", "mirror"]
    if "columns-" in scene:
        objects.append("column-6")
    made_for = Path(scene).stem.split("-")[0]
    for place, name in NAMED.get(scene, NAMED.get(made_for, {})).items():
        objects[place] = name
    scale = {"none": 1.0, "truth": 0.0}.get(case, 1.6 + 0.05 * len(case)) * (2 if timed else 1)
    accuracy = {
        "bad_share": {"0.5": 0.9, "1": 1.0 if case == "none" else 0.72 - 0.01 * len(case), "2": 0.5, "4": 0.3},
        "covered": 0.93, "missing": 0.0, "spurious": 0.02, "wrong_object": 0.11, "wrong_depth": 0.05,
        "unreachable": 0.01, "footprint_mismatch": 0.0004,
        "displacement_px": {"median": 21.4, "p95": 74.2, "max": 132.8},
        "angle_deg": {"median": 5.0, "p95": 21.0, "max": 44.0},
        "relmse": 0.2, "relmse_shading": 0.19, "psnr": 17.2, "flip": {"mean": 0.2, "p95": 0.5, "ppd": 67.0, "exposure": 1.0},
        "by_order": [{"order": order, "share": share, "missing": 0.02,
                      "bad_share": {"0.5": 0.3, "1": 0.2, "2": 0.1, "4": 0.1}}
                     for order, share in ((1, 0.9), (2, 0.1))],
        "by_reflector": [{"reflector": name, "share": share, "missing": 0.02,
                          "bad_share": {"0.5": 0.3, "1": 0.2, "2": 0.1, "4": 0.1}}
                         for name, share in (("teapot.body", 0.9), ("teapot.lid", 0.1))],
        "by_second": [{"second": second, "share": 0.05, "missing": 0.02,
                       "bad_share": {"0.5": 0.3, "1": 0.2, "2": 0.1, "4": 0.1}} for second in ("own", "other")],
    }  # fmt: skip
    device = {"name": "toy device", "driver": "toy 1.0", "api": "1.3.0", "is_software": True}
    time = {"median": scale, "min": 0.9 * scale, "p95": 1.3 * scale, "n": 20,
            "ci95": [0.95 * scale, 1.06 * scale], "with_prepare": 2 * scale}  # fmt: skip
    compared = {"median": 1.7, "ci95": [1.6, 1.8], "verdict": "slower"}
    ratio = {"baseline": baseline, "rounds": 20, "frame": compared, "with_prepare": compared}
    gpu = {"median": scale / 2, "min": scale / 2, "p95": scale / 2}
    waves = ("scene/deform", "scene/vertices") if "wobble" in scene else ()
    method = re.split("[:@]", case)[0]
    builds = ("depth-impostors/rotate", "depth-impostors/simplify") if method == "depth-impostors" else ()
    asks = ("look-up-still", "look-up-moving", "morph", "octree") if method == "reflection-morphing" else ()
    steps = (*waves, *builds, *(f"{method}/{ask}" for ask in asks), "direct-view/shade", f"{method}/reflect")
    return {
        "schema_version": 2, "run": "toy", "commit": "0123456789abcdef",
        "scene": {"name": scene, "hash": "0", "triangles": 12, "vertices": 8, "objects": objects},
        "case": case, "method": method, "variant": "published", "params": {},
        "fallback": "none", "size": size, "frames": [frame],
        "record": "full", "truth_frames": [frame], "device": device, "software_timing": True,
        "reflector_pixels": 1000.0,
        "prepare": {"calls": 1, "gpu_ms": 3.2, "cpu_ms": 0.1, "bytes": 1 << 20},
        "frame_gpu_ms": time if timed else None,
        "ratio": ratio if timed and case != baseline else None,
        "passes": [
            {"name": s, "prepare": False, "gpu_ms": gpu, "cpu_ms": 0.0, "invocations": 100} for s in steps
        ],
        "counters": dict.fromkeys(COUNTERS, 900) | {"searches": 10.0, "steps": 200.0, "max-steps": 50.0}, "accuracy": None if case == "truth" else accuracy, "stability": None,
        "clock": {"before_mhz": None, "after_mhz": None, "throttled": 0, "load": 0.1,
                  "load_after": 1.2, "steady": True},
    }  # fmt: skip


def path(case: str, first: int, end: int) -> list[dict]:
    """Frames of a path as the binary writes them: no jitter at either end."""
    jitter = {"median": 0.01 * len(case), "p95": 0.03 * len(case)}
    return [
        {
            "frame": frame, "points": 900, "covered": 0.8, "speed_px": None if frame == first else 1.5,
            "jitter_px": jitter if first < frame < end - 1 else None,
            "popping": 0.004 * (frame % 3), "temporal_error": None,
        }
        for frame in range(first, end)
    ]  # fmt: skip


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("command", choices=["list", "render", "bench", "diff", "doctor"])
    parser.add_argument("what", nargs="*")
    parser.add_argument("--scene")
    parser.add_argument("--case", action="append")
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--frame", type=int, default=0)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--dump", action="append", default=[])
    parser.add_argument("--frames", default="0..1")
    parser.add_argument("--path", action="store_true")
    parser.add_argument("--film", type=Path)
    parser.add_argument("--beside", action="append", default=[])
    for ignored in ("--repeat", "--record", "--truth-frames", "--fallback"):
        parser.add_argument(ignored)
    parser.add_argument("--json", action="store_true")
    args = parser.parse_args()
    if args.command == "list":
        print("toy device")
    if args.command == "diff":
        print(json.dumps({"accuracy": row("", "environment-map", [16, 9], 0, False, "")["accuracy"]}))
    if log := os.environ.get("FAKE_MIRRORBENCH_LOG"):
        with open(log, "a", encoding="utf-8") as file:
            file.write(" ".join(sys.argv[1:]) + "\n")
    if args.scene == "no-such-scene":
        print("no scene 'no-such-scene'; there are columns, lecture", file=sys.stderr)
        return 2
    # Tests ask for small pictures whatever the figure wants.
    size = [int(n) for n in os.environ.get("FAKE_MIRRORBENCH_SIZE", args.size).split("x")]
    for case in args.case or []:
        if args.command == "render":
            save(args.out / f"frame-{args.frame:04}.exr", draw(case, *size, args.frame))
            dump(args.dump, args.out / "dump", case, size, args.frame)
        if args.film:
            first, end = (int(n) for n in args.frames.split(".."))
            pictures = [filmed([case, *args.beside], *size, frame) for frame in range(first, end)]
            pictures[0].save(args.film, save_all=True, append_images=pictures[1:])
        timed = args.command == "bench"
        answer = row(args.scene, case, size, args.frame, timed, args.case[0])
        answer["run"] = f"toy-{len(case)}"
        arrays = {"run": answer["run"], "timed": [], "path": []}
        if timed:
            passes = {step["name"]: step["gpu_ms"]["median"] for step in answer["passes"]}
            arrays["timed"] = [{"frame": args.frame, "passes_gpu_ms": passes}] * 20
        if args.path:
            first, end = (int(n) for n in args.frames.split(".."))
            frames = arrays["path"] = path(case, first, end)
            answer["stability"] = {
                "frames": [first, end - 1], "jitter_px": frames[1]["jitter_px"], "pops": 1,
                "temporal_error": 0.01, "points": 900.0, "covered": 0.8, "speed_px": 1.5,
            }  # fmt: skip
            arrays["path_counters"] = [
                {"searches": 10, "steps": 20 + f["frame"] % 7, "max-steps": 9} for f in frames
            ]
        if args.out:
            (args.out / f"{answer['run']}.frames.json").write_text(json.dumps(arrays))
        print(json.dumps(answer))
    return 0


if __name__ == "__main__":
    sys.exit(main())
