"""Real scans colorized from 30 seeds of their own color, rendered beside the truth: python -m benchmarks.own_colors OUT

For every scan of benchmarks/real_scans.py a picture OUT/NAME.png: the reflectance image, the colorized image and the
true one; below, the mesh rendered in its colorized and in its true colors. Runs in the bpy wheel.
"""

import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from benchmarks import real_scans
from benchmarks.experiments.meshes import Renderer
from reflcolor_addon import Seeds, colorize

ROOT = Path(__file__).resolve().parent.parent
ROWS, COLUMNS = 5, 6
WIDTH = 1200


def own_seeds(scan):
    """Return 30 seeds of the scan's own color: in each cell of a 5 x 6 division, the known pixel nearest its center."""
    known = real_scans.has_truth(scan)
    height, width = scan.shape
    rows, cols = np.nonzero(known)
    places = []
    for i in range(ROWS):
        for j in range(COLUMNS):
            row, col = (i + 0.5) * height / ROWS, (j + 0.5) * width / COLUMNS
            nearest = np.argmin(((rows - row) / height) ** 2 + ((cols - col) / width) ** 2)
            places.append((rows[nearest], cols[nearest]))
    rows, cols = np.transpose(sorted(set(places)))
    return Seeds(rows, cols, scan.color[rows, cols])


def main():
    """Make the pictures of all scans, or of those named on the command line."""
    folder, names = Path(sys.argv[1]), sys.argv[2:] or real_scans.NAMES
    folder.mkdir(parents=True, exist_ok=True)
    scans = {name: real_scans.load(name, ROOT.parent / "shared" / "data") for name in names}
    with tempfile.TemporaryDirectory() as resources:
        renderer = Renderer(Path(resources))
        for name, scan in scans.items():
            colorized = colorize(scan, own_seeds(scan))
            truth = np.where(scan.valid[..., None], scan.color, 0)
            gray = colorize(scan, replace(colorized.seeds, rgb=np.full_like(colorized.seeds.rgb, 128)))
            flat = [fitted(rgb, WIDTH // 3) for rgb in (gray.rgb, colorized.rgb, truth)]
            renders = [fitted(renderer.picture([scan], [rgb]), WIDTH // 2) for rgb in (colorized.rgb, truth)]
            picture = np.vstack([np.hstack(flat), np.hstack(renders)])
            cv2.imwrite(str(folder / f"{name}.png"), picture[..., ::-1])
            print(f"{folder / name}.png: {len(colorized.seeds)} seeds", flush=True)
    renderer.end(0)


def fitted(picture, width):
    """A picture scaled to a width, its shape kept."""
    height = round(picture.shape[0] * width / picture.shape[1])
    return cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA)


if __name__ == "__main__":
    main()
