"""Scans and seeds for the scenarios, made from the shipped example."""

import json
from pathlib import Path

import bpy
import numpy as np

PAPER_SIZE = (760, 1135)


def write_large_scan(window, shape=PAPER_SIZE):
    """Write the example enlarged to (rows, columns), with a little noise of its own; return its path."""
    import cv2

    description = json.loads(Path(window.example("cones.scan.json")).read_text(encoding="utf-8"))
    size, noise = shape[::-1], np.random.default_rng(1)
    for kind, method in (("reflectance", cv2.INTER_LINEAR), ("range", cv2.INTER_NEAREST)):
        small = cv2.imread(window.example(description[kind]), cv2.IMREAD_UNCHANGED)
        large = cv2.resize(small, size, interpolation=method).astype(np.float64)
        spread = 0.004 * large.max() if kind == "reflectance" else 2
        large = np.where(large > 0, large + noise.normal(0, spread, shape), 0)
        limit = np.iinfo(small.dtype).max
        description[kind] = f"large.{kind}.png"
        cv2.imwrite(window.output(description[kind]), np.clip(np.rint(large), 0, limit).astype(small.dtype))
    path = window.output("large.scan.json")
    Path(path).write_text(json.dumps(description), encoding="utf-8")
    return path


def write_seeds(window, shape, count):
    """Write so many seeds on a lattice over a grid of (rows, columns), of many colors; return the file's path."""
    rows, cols = shape
    down = max(1, round(np.sqrt(count * rows / cols)))
    across = -(-count // down)
    seeds = [
        {
            "row": int((i // across + 0.5) * rows / down),
            "col": int((i % across + 0.5) * cols / across),
            "rgb": [50 + 37 * i % 200, 50 + 71 * i % 200, 50 + 113 * i % 200],
        }
        for i in range(count)
    ]
    path = window.output(f"lattice-{count}.seeds.json")
    Path(path).write_text(json.dumps({"format": "reflcolor-seeds", "version": 1, "seeds": seeds}), encoding="utf-8")
    return path


def shown_colors(obj):
    """Return the name of the color attribute that is seen on an object, and its values: (N, 3) uint8 sRGB."""
    attribute = obj.data.color_attributes[obj.data.color_attributes.active_color_name]
    values = np.empty(4 * len(attribute.data), np.float32)
    attribute.data.foreach_get("color_srgb", values)
    return attribute.name, np.rint(values.reshape(-1, 4)[:, :3] * 255).astype(np.uint8)


def state_of(obj):
    """Return what a cancelled act must leave alone, to compare: seeds, colors, attributes, images."""
    seeds = tuple((seed.row, seed.col, tuple(seed.color)) for seed in obj.reflcolor.seeds)
    name, colors = shown_colors(obj)
    return (
        seeds,
        name,
        colors.tobytes(),
        tuple(sorted(obj.data.attributes.keys())),
        tuple(sorted(bpy.data.images.keys())),
    )
