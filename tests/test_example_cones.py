"""The example that ships: whole, small, true to its script, and good enough to color."""

import sys
from pathlib import Path

import numpy as np
import pytest

from reflcolor_addon import Seeds, colorize, read_scans
from reflcolor_addon.files.images import read_image

FOLDER = Path(__file__).resolve().parent.parent / "examples" / "cones"


@pytest.fixture(scope="module")
def scan():
    (scan,) = read_scans(FOLDER / "cones.scan.json")
    return scan


@pytest.fixture(scope="module")
def seeds():
    return Seeds.load(FOLDER / "cones.seeds.json")


@pytest.fixture(scope="module")
def truth():
    return read_image(FOLDER / "truth.png")


def chrominance(rgb):
    red, green, blue = np.moveaxis(np.asarray(rgb, float), -1, 0)
    luma = 0.299 * red + 0.587 * green + 0.114 * blue
    return np.stack([(blue - luma) / 1.772, (red - luma) / 1.402], axis=-1)


def test_every_file_is_under_a_megabyte():
    assert max(path.stat().st_size for path in FOLDER.iterdir() if path.is_file()) < 1_000_000


def test_the_scan_stands_upright_on_its_floor(scan):
    assert scan.shape == (300, 450)
    assert scan.color is None
    world = scan.points[scan.valid] @ scan.pose[:3, :3].T + scan.pose[:3, 3]
    heights, counts = np.unique(np.round(world[:, 2], 2), return_counts=True)
    assert abs(heights[np.argmax(counts)]) <= 0.01
    assert world[:, 2].max() < 3


def test_some_pixels_have_no_return(scan):
    assert 0.03 < 1 - scan.valid.mean() < 0.15


def test_seeds_lie_on_returns_and_most_come_from_the_photo(scan, seeds):
    assert scan.valid[seeds.rows, seeds.cols].all()
    assert 12 <= len(seeds) <= 32
    assert np.mean([photo is not None for photo in seeds.photos]) > 0.8


def test_each_seed_has_about_the_chrominance_of_what_it_lies_on(seeds, truth):
    difference = chrominance(seeds.rgb) - chrominance(truth[seeds.rows, seeds.cols])
    assert np.linalg.norm(difference, axis=-1).max() < 40


def test_colorizing_comes_nearer_to_the_truth_than_gray_and_than_one_color(scan, seeds, truth):
    result = chrominance(colorize(scan, seeds).rgb)[scan.valid]
    true = chrominance(truth)[scan.valid]
    error, gray, mean = (
        np.sqrt(((guess - true) ** 2).sum(axis=-1).mean()) for guess in (result, 0 * true, true.mean(axis=0))
    )
    assert error < 0.5 * gray
    assert error < 0.7 * mean


def test_the_reflectance_is_not_the_gray_of_the_color(scan, truth):
    luma = truth @ (0.299, 0.587, 0.114)
    assert np.corrcoef(luma[scan.valid], scan.reflectance[scan.valid])[0, 1] < 0.8


def test_the_script_makes_the_scan_that_ships(blender, scan, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(FOLDER.parents[1])
    try:
        from examples.cones import make
        from examples.cones.scene import build

        with make.shooting.renders.SceneRenders(build()) as renders:
            made, truth = make.shooting.scanner.simulate_scan(renders.caster(make.POSE), make.MODEL, pose=make.POSE)
    finally:
        for name in [name for name in sys.modules if name.split(".")[0] in ("examples", "reflcolor")]:
            del sys.modules[name]
    # Versions of Cycles differ in a few rays along edges and in the last digits of noise.
    assert (made.valid == scan.valid).mean() > 0.998
    both = made.valid & scan.valid
    assert (np.abs(made.range - scan.range)[both] < 1e-3).mean() > 0.99
    assert (np.abs(made.reflectance - scan.reflectance / 65535)[both] < 0.01).mean() > 0.95
    assert np.abs(truth[both].astype(int) - read_image(FOLDER / "truth.png")[both]).mean() < 0.5
