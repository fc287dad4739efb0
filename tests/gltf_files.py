"""GLB files in tests: validated by Khronos, and read by their own words."""

import json
import os
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent
_HERE = ROOT / "tests" / "gltf_validator"


@pytest.fixture(scope="session")
def gltf_validator():
    """A function from a GLB's path to the report of the Khronos validator; skips where there is no Node."""
    folder = ROOT / "build" / "gltf_validator"
    if shutil.which("node") is None or shutil.which("npm") is None:
        pytest.skip("needs Node and npm for the Khronos glTF validator")
    if not (folder / "node_modules" / "gltf-validator").is_dir():
        shutil.copytree(_HERE, folder, dirs_exist_ok=True)
        line = ["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts", "--prefix", str(folder)]
        # `make test-no-network` watches what runs, not what installs the tools for it.
        environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
        done = subprocess.run(line, capture_output=True, text=True, timeout=300, check=False, env=environment)
        if done.returncode:
            shutil.rmtree(folder)
            pytest.skip(f"npm could not install the Khronos glTF validator: {done.stderr.strip()[-200:]}")

    def validate(path):
        line = ["node", str(folder / "validate.js"), str(path)]
        return json.loads(subprocess.run(line, capture_output=True, text=True, timeout=120, check=True).stdout)

    return validate


class Glb:
    """A GLB, read by the specification: its document, and arrays by accessor."""

    def __init__(self, path):
        data = Path(path).read_bytes()
        magic, version, length = struct.unpack("<4sII", data[:12])
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size = struct.unpack("<I", data[12:16])[0]
        self.document = json.loads(data[20 : 20 + size])
        self._binary = data[28 + size :]

    def array(self, index):
        """(N, width) values of an accessor, normalized ones as float64 in 0..1."""
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]]
        kind = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        array = np.frombuffer(self._binary, kind, accessor["count"] * width, start).reshape(-1, width)
        return array / np.iinfo(kind).max if accessor.get("normalized") else array

    def bytes_of(self, index):
        """The bytes of a buffer view."""
        view = self.document["bufferViews"][index]
        return self._binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]

    def image(self, index=0):
        """(rows, columns, 3) uint8 of an embedded image."""
        # In Blender, tests look whether it comes from the extension's zip.
        import cv2

        data = self.bytes_of(self.document["images"][index]["bufferView"])
        return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)[..., ::-1]

    def primitive(self, node=0, mode=4):
        """The primitive of a node's mesh that draws triangles (4) or points (0); None where there is none."""
        mesh = self.document["meshes"][self.document["nodes"][node]["mesh"]]
        found = [primitive for primitive in mesh["primitives"] if primitive["mode"] == mode]
        return found[0] if found else None

    def attribute(self, name, node=0):
        """(N, width) of an attribute of a node's mesh."""
        mesh = self.document["meshes"][self.document["nodes"][node]["mesh"]]
        return self.array(mesh["primitives"][0]["attributes"][name])

    def world_points(self, node=0):
        """(N, 3) float64 of a node's vertices in the world, Z up, the shift added."""
        stated = self.document["nodes"][node]
        x, y, z, w = stated.get("rotation", [0, 0, 0, 1])
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        points = self.attribute("POSITION", node).astype(np.float64) @ rotation.T + stated["translation"]
        shift = self.document["scenes"][0]["extras"]["reflcolor_shift"]
        return points[:, [0, 2, 1]] * [1, -1, 1] + shift


def encoded(linear):
    """sRGB 0..255 of linear colors."""
    low = linear <= 0.0031308
    return np.rint(255 * np.where(low, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055))
