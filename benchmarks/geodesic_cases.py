"""Graphs and seeds that the geodesic engine is measured on, made from real scans."""

import os
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from benchmarks import real_scans
from reflcolor_addon import Scan
from reflcolor_addon.geodesic.engines import NativeEngine
from reflcolor_addon.geodesic.exact import HeldFields, add_fields
from reflcolor_addon.geodesic.graph import PixelGraph
from reflcolor_addon.scan.grid_mesh import face_mask
from reflcolor_addon.scan.normalization import normalize

PAPER_SIZE = (760, 1135)
DATA = Path(os.environ.get("REFLCOLOR_DATA") or Path(__file__).resolve().parent.parent.parent / "shared" / "data")
SCANS = ("doria", "bildstein_25")
_JITTER = 0.3


def enlarged(name, shape=PAPER_SIZE):
    """(H, W) float32 luminance and range, 0..255, and (H, W) bool valid of a scan, interpolated to ``shape``."""
    import cv2

    scan = real_scans.load(name, DATA)
    luminance, _ = normalize(scan.reflectance, scan.valid)
    range_image, _ = normalize(scan.range, scan.valid)
    size = shape[::-1]
    valid = cv2.resize(scan.valid.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST) > 0
    images = (np.where(scan.valid, image, 0).astype(np.float32) for image in (luminance, range_image))
    return *(cv2.resize(image, size, interpolation=cv2.INTER_CUBIC).clip(0, 255) for image in images), valid


def tiled(shape, name="bildstein_25"):
    """The same, but the scan's own pixels, mirrored at its edges as often as it takes: real noise at any size."""
    scan = real_scans.load(name, DATA)
    images = normalize(scan.reflectance, scan.valid)[0], normalize(scan.range, scan.valid)[0], scan.valid
    pad = [(0, most - have) for most, have in zip(shape, scan.shape, strict=True)]
    if min(more for _, more in pad) < 0:
        return tuple(np.ascontiguousarray(image[: shape[0], : shape[1]]) for image in images)
    return tuple(np.pad(image, pad, mode="symmetric") for image in images)


def case(name, shape=PAPER_SIZE):
    """Luminance, range and valid by name: a scan of `SCANS`, enlarged, or "tiled"."""
    return tiled(shape) if name == "tiled" else enlarged(name, shape)


def pixel_graph(images, neighbors=8):
    """The graph that scipy works on."""
    luminance, range_image, valid = images
    return PixelGraph(luminance=luminance, range_image=range_image, valid=valid, neighbors=neighbors)


def whole_scan(name, stride, shape=PAPER_SIZE):
    """A scan of `SCANS`, enlarged to ``shape`` and thinned out again; its color is enlarged, too.

    Its range is interpolated on surfaces alone: between two of them it jumps, as a scanner would have measured it.
    """
    import cv2

    small = real_scans.load(name, DATA)
    luminance, _, valid = enlarged(name, shape)
    height, width = valid.shape
    azimuth, elevation = np.linspace(-0.7, 0.7, width), np.linspace(0.4, -0.4, height)[:, None]
    towards = np.cos(elevation) * np.cos(azimuth), -np.cos(elevation) * np.sin(azimuth), np.sin(elevation) + 0 * azimuth
    thin = np.s_[::stride, ::stride]
    points = np.stack([each[thin] for each in towards], axis=-1)
    points *= 1 + _enlarged_range(small, shape)[thin][..., None] / 25
    return Scan(
        name=name,
        points=points,
        reflectance=luminance[thin],
        valid=valid[thin],
        color=cv2.resize(small.color, (width, height), interpolation=cv2.INTER_LINEAR)[thin],
    )


def _enlarged_range(small, shape):
    """(H, W) float32, 0..255: interpolated where the four pixels around a place are a face of the scan's mesh, else
    that of the nearest pixel."""
    import cv2

    range_image, _ = normalize(small.range, small.valid)
    within, nearest = (
        cv2.resize(range_image, shape[::-1], interpolation=way) for way in (cv2.INTER_LINEAR, cv2.INTER_NEAREST)
    )
    faces = face_mask(small)
    # Of each place, the pixel above and left of it; beyond the middle of a pixel at the edge there is no face.
    places = [(np.arange(new) + 0.5) * old / new - 0.5 for new, old in zip(shape, small.shape, strict=True)]
    rows, cols = (np.floor(place).astype(np.int64) for place in places)
    inside = ((rows >= 0) & (rows < faces.shape[0]))[:, None] & ((cols >= 0) & (cols < faces.shape[1]))
    smooth = faces[np.clip(rows, 0, faces.shape[0] - 1)[:, None], np.clip(cols, 0, faces.shape[1] - 1)] & inside
    return np.where(smooth, within, nearest)


def images_of(scan):
    """Luminance, range and valid of a scan, as the Colorizer has them by default."""
    return normalize(scan.reflectance, scan.valid)[0], normalize(scan.range, scan.valid)[0], scan.valid


def exact(images, pixels, alpha, threads, colors=None):
    """The mean of all seeds, as the Colorizer takes it."""
    engine = NativeEngine(pixel_graph(images))
    blend = engine.blend(alpha)
    colors = seed_colors(pixels) if colors is None else colors
    seeds = list(zip(pixels.tolist(), map(tuple, colors.tolist()), strict=True))
    called = {"added": lambda index, field: None, "cancelled": lambda: False}
    add_fields(engine, blend, seeds, threads=threads, held=HeldFields(0), **called)
    return blend.mean(keep=False)


def spread_seeds(valid, count):
    """About ``count`` valid pixels (row * W + column), one in every cell of a grid, somewhat off its center."""
    height, width = valid.shape
    cell = np.sqrt(np.count_nonzero(valid) / count)
    random = np.random.default_rng(0)
    rows, cols = np.mgrid[cell / 2 : height : cell, cell / 2 : width : cell]
    rows = (rows + random.uniform(-_JITTER, _JITTER, rows.shape) * cell).clip(0, height - 1).astype(np.int64)
    cols = (cols + random.uniform(-_JITTER, _JITTER, cols.shape) * cell).clip(0, width - 1).astype(np.int64)
    pixels = (rows * width + cols).ravel()
    return pixels[valid.ravel()[pixels]]


def seed_colors(pixels):
    """(S, 2) chrominance."""
    return np.random.default_rng(1).uniform(-100, 100, (len(pixels), 2)).astype(np.float32)


def as_scan(images, pixels):
    """What `benchmarks.quality.peers.levin` asks of a scan and of seeds."""
    luminance, range_image, valid = images
    scan = SimpleNamespace(shape=valid.shape, reflectance=luminance, range=range_image, valid=valid)
    rows, cols = np.divmod(pixels, valid.shape[1])
    rgb = np.random.default_rng(1).integers(0, 256, (len(pixels), 3), dtype=np.uint8)
    return scan, SimpleNamespace(rows=rows, cols=cols, rgb=rgb)
