"""Files of the wrong kind and broken files of other projects: one clear line, or a scan (test_fuzz.py breaks more)."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from e57_samples import with_valid_checksums, write_e57
from sample_scans import intensity_of, ptx_text, room_points

from reflcolor_addon.errors import ScanError
from reflcolor_addon.files.readers import read_scans

ROOT = Path(__file__).resolve().parent.parent
POINTS = room_points()


def shared_files(*folders):
    """Files of the shared data, listed here so that each is a test; empty where there is none."""
    data = Path(os.environ.get("REFLCOLOR_DATA") or ROOT.parent / "shared" / "data")
    return sorted(path.relative_to(data).as_posix() for folder in folders for path in (data / folder).glob("*"))


def outcome(path):
    """The scans of a file, or the one line that it fails with."""
    try:
        return read_scans(path)
    except ScanError as error:
        assert str(error)
        assert "\n" not in str(error)
        return str(error)


def small_e57(path):
    row, column = np.mgrid[: POINTS.shape[0], : POINTS.shape[1]]
    names = ("cartesianX", "cartesianY", "cartesianZ", "intensity", "rowIndex", "columnIndex")
    grids = (*np.moveaxis(POINTS, -1, 0), intensity_of(POINTS), row, column)
    write_e57(path, {"fields": {name: grid.ravel() for name, grid in zip(names, grids, strict=True)}, "name": "yard"})
    return path.read_bytes()


@pytest.mark.parametrize("name", shared_files("robust/e57", "robust/ptx", "robust/pcd_pts"))
def test_a_file_of_other_projects_imports_or_fails_with_one_line(data_dir, name, capfd):
    scans = outcome(data_dir / name)
    if not isinstance(scans, str):
        assert all(scan.valid.any() for scan in scans)
    captured = capfd.readouterr()
    assert captured.out + captured.err == ""


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("e57/cryinc_corrupt_crc.e57", "a checksum does not match"),
        ("e57/libe57_bad-crc.e57", "a checksum does not match"),
        ("e57/cryinc_bunnyFloat.e57", "scan 'bunny' is unstructured"),
        ("e57/cryinc_tiny_spherical.e57", "is unstructured"),
        ("e57/pdal_A_B.e57", "none of its 2 scans can be used: scan 'B2 - Cloud' is unstructured"),
        ("e57/libe57_ZeroPoints.e57", "has no points"),
        ("e57/libe57_empty.e57", "holds no scan"),
        ("e57/dgraham_empty.e57", "is empty"),
        ("e57/dgraham_justxml.e57", "not an E57 file"),
        ("e57/olv_InvalidFileLength.e57", "cut short: 120 of 2048 bytes"),
        ("pcd_pts/pdal_test.pts", "has no grid: its points have neither rows nor columns"),
    ],
)
def test_what_is_said_about_a_file_that_cannot_be_used(data_dir, name, said):
    assert said in outcome(data_dir / "robust" / name)


@pytest.mark.parametrize(
    ("name", "shape", "warned"),
    [
        ("1.2-with-color.ptx", (71, 15), "world coordinates"),
        ("no-color.ptx", (1, 15), "world coordinates"),
        ("olv_tiny.ptx", (2, 2), "position (0 0 0) is not the matrix's (10 20 30)"),
    ],
)
def test_odd_ptx_files_import_and_say_what_is_odd(data_dir, name, shape, warned):
    (scan,) = outcome(data_dir / "robust/ptx" / name)
    assert scan.shape == shape
    assert warned in " ".join(scan.warnings)


def test_what_is_no_file_or_no_scan_file_is_told(tmp_path):
    assert "no such file" in outcome(tmp_path / "missing.ptx")
    assert "is a directory" in outcome(tmp_path)
    (tmp_path / "folder.ptx").mkdir()
    assert "is a directory" in outcome(tmp_path / "folder.ptx")
    assert "cannot be read" in outcome("nul\0character.ptx")
    for suffix in (".ptx", ".e57", ".scan.json", ".txt"):
        path = tmp_path / f"nothing{suffix}"
        path.touch()
        assert outcome(path).startswith(f"{path}: is empty, expected a scan file (.ptx, .e57, .scan.json, ")
    photo = tmp_path / "photo.png"
    photo.write_bytes(b"\x89PNG")
    assert outcome(photo).startswith("photo.png: not a scan file by its name, expected one of .ptx, .e57, .scan.json, ")


def test_a_suffix_that_does_not_fit_the_contents_is_told(tmp_path):
    ptx, e57 = tmp_path / "a.e57", tmp_path / "a.ptx"
    ptx.write_text(ptx_text(POINTS, intensity_of(POINTS)))
    small_e57(e57)
    assert outcome(ptx) == "a.e57: its contents look like .ptx: rename it"
    assert outcome(e57) == "a.ptx: its contents look like .e57: rename it"
    assert "its contents look like .e57: rename it" in outcome(e57.rename(tmp_path / "a.dat"))


def test_suffixes_may_be_in_upper_case(tmp_path):
    path = tmp_path / "GARAGE.PTX"
    path.write_text(ptx_text(POINTS, intensity_of(POINTS)))
    assert outcome(path)[0].name == "GARAGE"


def test_a_file_that_may_not_be_read_is_told(tmp_path, monkeypatch):
    path = tmp_path / "garage.ptx"
    path.write_text(ptx_text(POINTS, intensity_of(POINTS)))

    def refuse(*_args, **_options):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", refuse)
    assert outcome(path) == f"{path}: cannot be read (Permission denied); ask its owner for the right to read it"


def test_numbers_of_an_e57_header_may_be_anything(tmp_path):
    whole = small_e57(tmp_path / "whole.e57")
    path = tmp_path / "odd.e57"
    for count in (b"-26", b"999", b"  0", b"abc", b"nan", b"9" * 20):
        odd = whole.replace(b'recordCount="126"', b'recordCount="' + count + b'"')[: len(whole)]
        assert odd != whole
        path.write_bytes(with_valid_checksums(odd))
        assert isinstance(outcome(path), str)


def test_native_libraries_print_nothing_beside_the_one_line(tmp_path):
    path = tmp_path / "cut.e57"
    path.write_bytes(with_valid_checksums(small_e57(tmp_path / "whole.e57").replace(b"<e57Root", b"<e57Ro<>")))
    script = "import sys\nfrom reflcolor_addon import read_scans\ntry: read_scans(sys.argv[1])\nexcept ValueError: pass"
    done = subprocess.run(
        [sys.executable, "-c", script, path], cwd=ROOT, capture_output=True, text=True, timeout=120, check=True
    )
    assert done.stdout + done.stderr == ""
