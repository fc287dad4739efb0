"""What is written, opened by CloudCompare, where that is installed (Debian's package has no plugin for E57)."""

import os
import shutil
import subprocess

import numpy as np
import pytest
from hall import HALL, NAMES
from sample_scans import ptx_text

from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.writers import write_ply
from reflcolor_addon.files.writers.ptx_colors import write_ptx_colors
from reflcolor_addon.scan.surface import ScanSurface

CLOUDCOMPARE = shutil.which("CloudCompare")
pytestmark = pytest.mark.skipif(CLOUDCOMPARE is None, reason="CloudCompare is not installed")
RGB = np.random.default_rng(7).integers(0, 256, HALL.shape, np.uint8)


@pytest.fixture
def scan(tmp_path):
    (tmp_path / "hall.ptx").write_text(ptx_text(HALL, NAMES / NAMES.max()))
    (scan,) = read_scans(tmp_path / "hall.ptx")
    return scan


def as_cloudcompare_reads(path, *steps):
    """Return (N, 3) points and (N, 3) colors."""
    read = ["-SILENT", "-AUTO_SAVE", "OFF", "-C_EXPORT_FMT", "ASC", "-PREC", "12", "-ADD_HEADER", "-O", path]
    save = [*steps, "-SAVE_CLOUDS", "FILE", path.with_suffix(".asc")]
    environment = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    subprocess.run([CLOUDCOMPARE, *read, *save], check=True, capture_output=True, env=environment, timeout=120)
    head, *lines = path.with_suffix(".asc").read_text().splitlines()
    table = dict(zip(head.strip("/").split(), np.loadtxt(lines).T, strict=True))
    return np.stack([table[axis] for axis in "XYZ"], axis=-1), np.stack([table[color] for color in "RGB"], axis=-1)


def same(found, expected):
    """Whether both are the same rows, in whatever order."""
    assert len(found[0]) == len(expected[0])
    order, wanted = (np.lexsort(np.round(points, 4).T) for points in (found[0], expected[0]))
    # CloudCompare holds coordinates in single precision.
    np.testing.assert_allclose(found[0][order], expected[0][wanted], atol=2e-6)
    np.testing.assert_array_equal(found[1][order], expected[1][wanted])


def test_a_ptx_with_colors_shows_them_to_the_byte(scan, tmp_path):
    write_ptx_colors(tmp_path / "hall.ptx", {0: RGB}, tmp_path / "made.ptx")
    same(as_cloudcompare_reads(tmp_path / "made.ptx"), (scan.points[scan.valid], RGB[scan.valid]))


def test_a_ply_shows_its_colors_to_the_byte(scan, tmp_path):
    write_ply([ScanSurface(scan, RGB)], tmp_path / "made.ply")
    read = as_cloudcompare_reads(tmp_path / "made.ply", "-EXTRACT_VERTICES")
    same(read, (scan.points[scan.valid], RGB[scan.valid]))
