"""The public names of the package: their examples run, they are typed, and what does not fit is refused in a line."""

import doctest
import inspect
from pathlib import Path

import api_page
import numpy as np
import pytest
from small_scans import random_scan

import reflcolor_addon
from reflcolor_addon import (
    Colorizer,
    Scan,
    ScanError,
    Seeds,
    SeedsError,
    Settings,
    SettingsError,
    colorize,
    evaluate,
    geodesic_distances,
    match_photos,
    write_ptx,
)
from reflcolor_addon.files.images import write_png

EXCEPTIONS = {name for name in reflcolor_addon.__all__ if name.endswith("Error") or name == "Cancelled"}
# What is made by the package and only read by others.
RESULTS = {"Colorization", "Matching", "Observed", "PhotoMatch"}
EXPLAINED = sorted(set(reflcolor_addon.__all__) - EXCEPTIONS - RESULTS - {"__version__"})


@pytest.fixture
def garage(tmp_path, monkeypatch):
    """The files that the examples name, in the working directory."""
    monkeypatch.chdir(tmp_path)
    write_ptx(random_scan(shape=(20, 30)), "garage.ptx")
    write_png(Path("garage.jpg.png"), np.random.default_rng(0).integers(0, 256, (64, 96, 3), np.uint8))
    Path("garage.jpg.png").rename("garage.jpg")


@pytest.mark.parametrize("name", EXPLAINED)
@pytest.mark.filterwarnings("ignore")
def test_the_example_of_a_public_name_runs(name, garage):
    (example,) = doctest.DocTestFinder(recurse=False).find(getattr(reflcolor_addon, name), name, globs={})
    assert example.examples, f"{name} has no example"
    said = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    runner.run(example, out=said.append)
    assert runner.failures == 0, "".join(said)


@pytest.mark.parametrize("name", EXPLAINED)
def test_a_public_name_is_typed(name):
    public = getattr(reflcolor_addon, name)
    signature = inspect.signature(public)
    bare = [p.name for p in signature.parameters.values() if p.annotation is p.empty]
    assert not bare and (inspect.isclass(public) or signature.return_annotation is not signature.empty)


def test_the_reference_is_that_of_the_docstrings():
    written = api_page.PAGE.read_text(encoding="utf-8")
    assert written == api_page.page(), "run python tools/api_page.py"


def wrong_calls():
    scan = random_scan()
    mask = np.full(scan.shape, 255, np.uint8)
    image = np.zeros((*scan.shape, 3), np.uint8)
    seeds = Seeds([1], [2], [[200, 80, 40]])
    scan_of = {"points": scan.points, "reflectance": scan.reflectance, "valid": scan.valid}
    booleans = "valid: expected booleans, found uint8; write valid > 0"
    way = "read_scans reads files, Scan(name=..., points=...) takes arrays"
    yield "a mask of bytes for a scan", lambda: Scan(name="wall", **scan_of | {"valid": mask}), f"wall: {booleans}"
    yield "a mask of bytes to evaluate", lambda: evaluate(image, image, mask), booleans
    yield "a mask of bytes for distances", lambda: geodesic_distances(scan.reflectance, 1, 2, valid=mask), booleans
    yield (
        "reflectance in words",
        lambda: Scan(name="wall", **scan_of | {"reflectance": np.full(scan.shape, "dark")}),
        "wall: reflectance: expected numbers, found <U4",
    )
    yield (
        "reflectance of another shape",
        lambda: Scan(name="wall", **scan_of | {"reflectance": scan.reflectance[1:]}),
        "wall: reflectance has shape (5, 10), expected (6, 10)",
    )
    yield "colors as shares", lambda: evaluate(image / 255, image, scan.valid), "colors: expected uint8, found float64"
    yield (
        "colors of another shape",
        lambda: evaluate(image[1:], image, scan.valid),
        "colors: expected an image of shape (6, 10, 3), found (5, 10, 3)",
    )
    yield (
        "an array to colorize",
        lambda: colorize(scan.reflectance, seeds),
        f"scan: expected Scan, found ndarray; {way}",
    )
    yield "a path to colorize", lambda: Colorizer("garage.ptx"), f"scan: expected Scan, found str; {way}"
    yield (
        "a list as seeds",
        lambda: colorize(scan, [(1, 2, (200, 80, 40))]),
        "seeds: expected Seeds, found list; write Seeds(rows, cols, rgb), or Seeds.load(path)",
    )
    yield (
        "settings in a dictionary",
        lambda: colorize(scan, seeds, {"alpha": 4}),
        "settings: expected Settings, found dict; write Settings(alpha=6) or Settings.preset(name)",
    )
    yield "an array to match", lambda: match_photos(scan.points, [image]), f"scan: expected Scan, found ndarray; {way}"
    yield "a setting out of range", lambda: Settings(alpha=0), "alpha: expected a number from 0.1 to 64, found 0"
    yield (
        "seeds of shares",
        lambda: Seeds([1], [2], [[0.5, 0.2, 0.1]]),
        "seeds: rgb: expected whole numbers, found float64",
    )


@pytest.mark.parametrize(("call", "line"), [pytest.param(call, line, id=name) for name, call, line in wrong_calls()])
def test_what_does_not_fit_is_refused_in_one_clear_line(call, line):
    with pytest.raises((ScanError, SeedsError, SettingsError)) as refused:
        call()
    assert str(refused.value) == line
