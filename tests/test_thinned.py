"""Scans of which only every n-th row and column is read: which, in how much memory, and how colors come back."""

import tracemalloc

import numpy as np
import pytest
from e57_samples import write_e57
from sample_scans import intensity_of, ptx_text, room_points

from reflcolor_addon import Scan, ScanSurface, write_ply
from reflcolor_addon.files.readers import ReadOptions, read_scans
from reflcolor_addon.files.writers.scans_back import ColoredScan, write_scans_back

HALL = room_points(40, 90, step_deg=(3.0, 4.0), top_deg=60.0, left_deg=178.0)
NAMES = intensity_of(HALL)
ROWS, COLS = np.mgrid[:40, :90]


def read(path, step, **options):
    (scan,) = read_scans(path, options=ReadOptions(step=step, **options))
    return scan


def require_thinned(scan, step, points=HALL, names=NAMES):
    """Every ``step``-th row and column of the hall, from whichever it begins with."""
    found = np.argwhere(names == scan.reflectance[0, 0])
    assert len(found) == 1 and (found[0] < step).all()
    every = tuple(slice(first, None, step) for first in found[0])
    np.testing.assert_array_equal(scan.reflectance, names[every])
    np.testing.assert_array_equal(scan.points, points[every])


@pytest.mark.parametrize("step", [2, 7])
@pytest.mark.parametrize("swapped_header", [False, True])
@pytest.mark.parametrize("by_rows", [False, True])
def test_every_order_of_a_ptx_is_thinned(tmp_path, step, swapped_header, by_rows):
    lines = ptx_text(HALL, NAMES).splitlines(keepends=True)
    header, body = lines[:10], np.array(lines[10:]).reshape(90, 40)
    header[:2] = header[1::-1] if swapped_header else header[:2]
    (tmp_path / "hall.ptx").write_text("".join(header) + "".join((body.T if by_rows else body).ravel()))
    require_thinned(read(tmp_path / "hall.ptx", step), step)


def test_a_thinned_ptx_takes_the_memory_of_what_is_kept(tmp_path, monkeypatch):
    # What is read, or looked at, at a time is the same for all.
    monkeypatch.setattr("reflcolor_addon.files.readers.text_lines._BLOCK", 1 << 14)
    monkeypatch.setattr("reflcolor_addon.scan.coherence._PAIRS_OF_LINES", 1 << 8)
    points = np.repeat(np.repeat(HALL, 4, axis=0), 4, axis=1) * np.linspace(1, 2, 160)[:, None, None]
    (tmp_path / "hall.ptx").write_text(ptx_text(points, intensity_of(points)))
    peaks = []
    for step in (1, 4):
        read(tmp_path / "hall.ptx", step)  # what is loaded once does not count
        tracemalloc.start()
        read(tmp_path / "hall.ptx", step)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < peaks[0] / 3


@pytest.mark.parametrize("order", ["rows", "columns", "shuffled"])
@pytest.mark.parametrize(("counted_by", "step"), [(1, 2), (1, 5), (3, 2), (2, 2), (2, 6)])
def test_an_e57_is_thinned_whatever_its_numbers(tmp_path, monkeypatch, order, counted_by, step):
    monkeypatch.setattr("reflcolor_addon.files.readers.e57_columns._ROOM", 1000)
    order = {
        "rows": np.arange(3600),
        "columns": np.arange(3600).reshape(40, 90).T.ravel(),
        "shuffled": np.random.default_rng(0).permutation(3600),
    }[order]
    columns = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), HALL.reshape(-1, 3).T, strict=True))
    columns |= {"intensity": NAMES, "rowIndex": counted_by * ROWS + 1, "columnIndex": counted_by * COLS - 7}
    write_e57(tmp_path / "hall.e57", {"fields": {name: np.ravel(values)[order] for name, values in columns.items()}})
    scan = read(tmp_path / "hall.e57", step)
    require_thinned(scan, step)
    assert bool(scan.warnings) == (counted_by > 1)


def colored(path, step, made, **options):
    """The red of every point of a copy that was colored from every ``step``-th pixel with that pixel's number."""
    scan = read(path, step, **options)
    rgb = np.zeros((*scan.shape, 3), np.uint8)
    rgb[..., 0] = np.arange(scan.valid.size).reshape(scan.shape) % 251
    given = ColoredScan(scan=scan, rgb=rgb, source=path, index=1, options=ReadOptions(step=step, **options))
    write_scans_back([given], made)
    (whole,) = read_scans(made)
    return scan, rgb[..., 0], whole


@pytest.mark.parametrize("suffix", [".ptx", ".e57"])
def test_every_point_of_the_file_gets_the_color_of_a_pixel_beside_it(tmp_path, suffix):
    path = tmp_path / f"hall{suffix}"
    if suffix == ".ptx":
        path.write_text(ptx_text(HALL, NAMES))
    else:
        columns = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), HALL.reshape(-1, 3).T, strict=True))
        columns |= {"intensity": NAMES.ravel(), "rowIndex": 2 * ROWS[::-1].ravel(), "columnIndex": 2 * COLS.ravel()}
        write_e57(path, {"fields": columns})
    scan, red, whole = colored(path, 3, tmp_path / f"made{suffix}")
    np.testing.assert_array_equal(whole.points, HALL)
    place = np.argwhere(scan.reflectance[0, 0] == NAMES)[0]
    kept = whole.color[place[0] :: 3, place[1] :: 3, 0]
    np.testing.assert_array_equal(kept, red)
    # Others have the color of one that is less than three rows and columns away.
    for row, col in np.random.default_rng(0).integers((3, 3), (36, 86), (50, 2)):
        near = whole.color[row - 2 : row + 3, col - 2 : col + 3, 0]
        there = ((np.arange(row - 2, row + 3) - place[0]) % 3 == 0)[:, None] & (
            (np.arange(col - 2, col + 3) - place[1]) % 3 == 0
        )
        assert whole.color[row, col, 0] in near[there]


@pytest.mark.parametrize("suffix", [".npz", ".npy", ".pcd", ".ply"])
def test_other_grids_are_thinned(tmp_path, suffix):
    path = tmp_path / f"hall{suffix}"
    names = NAMES.astype(np.float32)
    if suffix == ".npz":
        np.savez_compressed(path, xyz=HALL, reflectance=names, color=np.zeros((40, 90, 3), np.uint8))
    elif suffix == ".npy":
        np.save(path, np.asfortranarray(np.concatenate([HALL, names[..., None]], axis=-1)))
    elif suffix == ".ply":
        whole = Scan(name="hall", points=HALL, reflectance=names, valid=np.ones((40, 90), bool))
        write_ply([ScanSurface(whole, np.zeros((40, 90, 3), np.uint8), {})], path)
    else:
        header = "VERSION .7\nFIELDS x y z intensity\nSIZE 8 8 8 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 90\nHEIGHT 40\n"
        table = np.zeros(3600, [("xyz", "<f8", 3), ("intensity", "<f4")])
        table["xyz"], table["intensity"] = HALL.reshape(-1, 3), names.ravel()
        path.write_bytes(header.encode() + b"POINTS 3600\nDATA binary\n" + table.tobytes())
    require_thinned(read(path, 4), 4, names=names)
