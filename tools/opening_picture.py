"""The picture that README.md opens with: python tools/opening_picture.py OUT.jpg

The example that ships, from its photo alone: the scan as it comes, the photo in its corner, and beside them the colored
mesh, from the same camera. Needs the zip that `make build` leaves in dist/.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "examples" / "cones"
WIDTH_PX, GAP_PX = 1600, 8
# Of the width of the scan's half.
PHOTO_SHARE, PHOTO_EDGE = 0.36, 0.025
# What draws the gray mesh through the camera of the colored one, in a Blender of its own: it ends as it likes.
GRAY = """
import os, sys, bpy
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
for material in bpy.data.materials:
    for node in material.node_tree.nodes if material.node_tree else ():
        if node.type == "ATTRIBUTE" and node.attribute_name == "Colorized":
            node.attribute_name = "Reflectance_Gray"
bpy.context.scene.render.filepath = sys.argv[2]
bpy.ops.render.render(write_still=True)
sys.stdout.flush()
os._exit(0)
"""


def main() -> None:
    """Colorize, render both, put them side by side."""
    target = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        file, colored, gray = (Path(folder) / name for name in ("cones.blend", "colored.png", "gray.png"))
        command = ["colorize", EXAMPLE / "cones.scan.json", "--photo", EXAMPLE / "photo.jpg"]
        command += ["-o", file, "--render", colored]
        subprocess.run([sys.executable, ROOT / "tools" / "blender_command.py", "--", *command], check=True)
        subprocess.run([sys.executable, "-c", GRAY, file, gray], check=True)
        picture = side_by_side(*(cv2.imread(str(path)) for path in (gray, EXAMPLE / "photo.jpg", colored)))
    cv2.imwrite(str(target), picture, [cv2.IMWRITE_JPEG_QUALITY, 88])


def side_by_side(gray: np.ndarray, photo: np.ndarray, colored: np.ndarray) -> np.ndarray:
    """The gray picture with the photo in its corner, and the colored one beside it."""
    width = (WIDTH_PX - GAP_PX) // 2
    gray, colored = (_of_width(picture, width) for picture in (gray, colored))
    photo = _of_width(photo, round(PHOTO_SHARE * width))
    photo = cv2.copyMakeBorder(photo, 3, 3, 3, 3, cv2.BORDER_CONSTANT, value=(255, 255, 255))
    edge = round(PHOTO_EDGE * width)
    gray[-edge - photo.shape[0] : -edge, edge : edge + photo.shape[1]] = photo
    return np.hstack([gray, np.full((len(gray), GAP_PX, 3), 255, np.uint8), colored])


def _of_width(picture, width):
    height = round(len(picture) * width / picture.shape[1])
    return cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA)


if __name__ == "__main__":
    main()
