"""One estimate of a whole run's memory, before the work that it is about begins."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from command_line import COLORIZE, assert_refused, blender_tasks
from small_scans import random_scan

from reflcolor_addon.batch import memory
from reflcolor_addon.batch.scan_job import ScanJob
from reflcolor_addon.errors import ReflcolorError
from reflcolor_addon.files.images import image_size


@pytest.fixture
def free(monkeypatch):
    """A function that says how much memory is free, to the estimate alone."""
    return lambda count: monkeypatch.setattr(memory, "available_bytes", lambda: count)


@pytest.fixture
def idle(monkeypatch):
    """Nothing is matched or colorized."""

    def work(*_arguments, **_options):
        raise AssertionError("the work had begun")

    for name in ("match_site", "colorize"):
        monkeypatch.setattr(f"reflcolor_addon.batch.pipeline.{name}", work)


def test_a_run_that_fits_is_done(run_cli, free):
    free(1 << 30)
    assert run_cli(*COLORIZE, "-o", "out.png")[0] == 0


def test_colors_that_do_not_fit_are_refused_before_the_work(run_cli, free, idle):
    free(3000)
    assert_refused(run_cli(*COLORIZE, "-o", "out.png"), 1, "garage.ptx: colorizing needs about", "and 2.93 KB are free")


def test_a_scene_that_does_not_fit_is_refused_before_the_work(run_cli, free, idle):
    free(20_000)
    outcome = run_cli(*COLORIZE, "--render", "out.png", "-o", "out.blend", blender=blender_tasks())
    assert_refused(outcome, 1, "writing out.png needs about", "and 19.5 KB are free", "step 2")


def test_a_light_mesh_that_cannot_be_made_is_refused_before_the_work(run_cli, free, idle):
    free(20_000)
    outcome = run_cli(*COLORIZE, "--faces", "100", "-o", "out.glb", blender=blender_tasks())
    assert_refused(outcome, 1, "making the mesh lighter needs about", "and 19.5 KB are free")


def test_a_photo_that_does_not_fit_is_refused_before_it_is_decoded(run_cli, cli_folder, free, idle, monkeypatch):
    cv2.imwrite(str(cli_folder / "view.png"), np.zeros((900, 1200, 3), np.uint8))
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("was decoded"))
    free(10_000_000)
    outcome = run_cli("colorize", "garage.ptx", "--photo", "view.png", "-o", "out.png")
    assert_refused(outcome, 1, "finding seeds needs about")


def test_what_several_scans_hold_together_counts(free):
    jobs = [ScanJob(name=str(number), scan=random_scan(number)) for number in range(3)]
    photos = [("a", np.zeros((100, 100, 3), np.uint8))]
    assert memory.bytes_of_matching(jobs, photos * 2) > memory.bytes_of_matching(jobs, photos)
    free(10)
    with pytest.raises(ReflcolorError, match=r"^0, 1, 2: finding seeds needs about"):
        memory.require_matching(jobs, photos)
    with pytest.raises(ReflcolorError, match=r"a\.e57: making meshes needs about"):
        memory.require_objects([job.scan for job in jobs], Path("a.e57"))
    with pytest.raises(ReflcolorError, match=r"making the mesh lighter needs about"):
        memory.require_light_mesh(jobs[0].scan, 100)


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif", ".webp", ".bmp"])
def test_the_size_of_a_picture_is_known_before_it_is_decoded(tmp_path, suffix, monkeypatch):
    path = tmp_path / f"a{suffix}"
    cv2.imwrite(str(path), np.zeros((30, 50, 3), np.uint8))
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("was decoded"))
    assert image_size(path) == (30, 50)
