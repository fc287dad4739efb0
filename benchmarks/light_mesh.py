"""A light mesh beside the scan's own: python -m benchmarks.light_mesh [--faces N] [--pixels SIDE] [--pictures FOLDER]

The scan `doria`, enlarged to SIDE x SIDE pixels (2,000: 4 megapixels), and colored by its own colors, is rendered as
the command line does it by default, and once more from a light mesh of N faces (200,000): with its image, and with the
colors of its vertices alone. Printed are the structural similarity of each picture to that of the full mesh, over all
three channels of 8 bits; seconds of the processor and the most memory that the runs took, of all their processes
together; and the sizes of the .glb and .blend. Needs the extension built (`make build`). Linux only.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

from benchmarks import geodesic_cases, run_apart
from benchmarks.geodesic_tables import ROOT, head, row
from reflcolor_addon import Seeds
from reflcolor_addon.files.writers import write_e57

_SEEDS_PER_SIDE = 30
# Renders a .blend once more, with the colors of its vertices.
_AT_VERTICES = """
import os, sys
import bpy
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
for material in bpy.data.materials:
    nodes = material.node_tree.nodes if material.node_tree else ()
    images = [node for node in nodes if node.type == "TEX_IMAGE"]
    colors = [node for node in nodes if node.type == "ATTRIBUTE"]
    for link in [link for image in images for link in image.outputs["Color"].links]:
        material.node_tree.links.new(colors[0].outputs["Color"], link.to_socket)
bpy.context.scene.render.filepath = sys.argv[2]
bpy.ops.render.render(write_still=True)
sys.stdout.flush()
os._exit(0)
"""


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faces", type=int, default=200_000)
    parser.add_argument("--pixels", type=int, default=2000, help="of each side of the scan")
    parser.add_argument("--pictures", type=Path, help="folder that keeps the pictures")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = arguments.pictures or Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        compare(folder, arguments.pixels, arguments.faces)


def compare(folder, side, faces):
    """Print what one scan's light mesh takes, and how like it is."""
    scan_file, seeds_file = folder / "scan.e57", folder / "seeds.json"
    scan = geodesic_cases.whole_scan("doria", 1, (side, side))
    write_e57(scan, scan_file)
    rows, cols = (grid.ravel() for grid in np.indices((_SEEDS_PER_SIDE,) * 2) * (side // _SEEDS_PER_SIDE))
    known = scan.valid[rows, cols]
    Seeds(rows[known], cols[known], scan.color[rows[known], cols[known]]).save(seeds_file)
    given = ["colorize", scan_file, "--seeds", seeds_file]
    runs = {
        kind: _run([*given, *more, "-o", folder / f"{kind}.glb", "-o", folder / f"{kind}.blend"])
        for kind, more in (
            ("full", ["--render", folder / "full.png"]),
            ("light", ["--faces", faces, "--render", folder / "light.png"]),
        )
    }
    at_vertices = folder / "vertices.png"
    subprocess.run([sys.executable, "-c", _AT_VERTICES, folder / "light.blend", at_vertices], check=True, stdout=-3)
    whole = cv2.imread(str(folder / "full.png"))
    head(f"{scan.valid.sum():,} returns, and {faces:,} faces", "", "full mesh", "light mesh")
    for label, key, scale in (("seconds of the processor", "processor", 1), ("peak memory, MB", "bytes", 1e6)):
        row(label, *(f"{runs[kind][key] / scale:.1f}" for kind in ("full", "light")))
    for suffix in ("glb", "blend"):
        sizes = [(folder / f"{kind}.{suffix}").stat().st_size / 1e6 for kind in ("full", "light")]
        row(f".{suffix}, MB", *(f"{size:.1f}" for size in sizes))
    row("structural similarity, with its image", "1", f"{_similarity(whole, folder / 'light.png'):.4f}")
    row("structural similarity, colors at its vertices", "1", f"{_similarity(whole, at_vertices):.4f}")


def _run(arguments):
    line = [sys.executable, ROOT / "tools" / "blender_command.py", "--", *arguments]
    return run_apart.measured(list(map(str, line)))


def _similarity(whole, path):
    from skimage.metrics import structural_similarity

    return structural_similarity(whole, cv2.imread(str(path)), channel_axis=2)


if __name__ == "__main__":
    main()
