"""A disk that is full while Blender writes: one line, and what was there before survives."""

import contextlib
import importlib

import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon import Seeds, Settings, colorize
from reflcolor_addon.batch.scan_job import ScanJob
from reflcolor_addon.report.report import build_report, scan_entry
from reflcolor_addon.view.picture import Picture

SCENE = "bl_ext.user_default.reflcolor.operators.scene"
resource = pytest.importorskip("resource", reason="needs limits of POSIX")


@contextlib.contextmanager
def no_room_beyond(size):
    """Limit the size of files: as on a full disk, every write beyond that fails."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.fixture(scope="module")
def result():
    scan, seeds = random_scan(5, (30, 40)), Seeds([0, 7], [0, 11], np.array([[220, 60, 30], [30, 90, 200]]))
    colorization = colorize(scan, seeds)
    report = build_report(scan_entry(scan, 1), colorization, Settings(), given_seeds=seeds, inputs=[])
    return ScanJob(name=scan.name, scan=scan, seeds=seeds, colorization=colorization, report=report)


# Blender's own exporters leave files open when writing fails.
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("name", ["wall.blend", "wall.usd", "render.png"])
def test_a_full_disk_is_one_line_and_the_old_file_survives(blender, tmp_path, capfd, monkeypatch, result, name):
    module = importlib.import_module(f"{SCENE}.write_results")
    monkeypatch.setattr(f"{SCENE}.render.picture_size", lambda aspect: (64, 40))
    path = tmp_path / name
    path.write_bytes(b"old and good")
    paths, picture = ([], path) if name.endswith(".png") else ([path], None)
    with pytest.raises(module.OutputError) as caught, no_room_beyond(2000):
        module.write_results([result], paths, picture, Picture(), lambda fraction, text: None)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)
    assert path.read_bytes() == b"old and good"
    assert [left.name for left in tmp_path.iterdir()] == [name]
