"""Files of commit b961f62 (old_files/README.md) mean what they meant: seeds, a report, a result."""

import shutil
from pathlib import Path

import numpy as np

from reflcolor_addon import Seeds
from reflcolor_addon.files.images import read_image
from reflcolor_addon.report.provenance import outline, read_report

OLD = Path(__file__).parent / "old_files"


def test_seeds_saved_in_the_window_are_read():
    seeds = Seeds.load(OLD / "window.seeds.json")
    assert (seeds.rows.tolist(), seeds.cols.tolist()) == ([1, 4], [2, 7])
    assert seeds.rgb.tolist() == [[204, 51, 26], [26, 76, 178]]


def test_seeds_with_a_point_of_a_photo_are_read():
    seeds = Seeds.load(OLD / "photo.seeds.json")
    assert seeds.rgb.tolist() == [[200, 80, 40], [62, 54, 110]]
    assert seeds.photos == (None, "photo.png")


def test_a_report_is_read():
    report = read_report(OLD / "wall.json")
    assert report["settings"]["alpha"] == 6
    assert outline(report)


def test_verify_says_that_a_report_of_then_has_no_hashes(run_cli, tmp_path):
    shutil.copytree(OLD, tmp_path, dirs_exist_ok=True)
    status, out, err = run_cli("verify", "wall.json")
    line = "error: wall.json: does not hold the hashes of its outputs; it was written by an earlier release\n"
    assert (status, out) == (1, "") and err.endswith(line)


def test_the_same_files_and_the_settings_of_then_give_the_same_colors(run_cli, tmp_path):
    shutil.copytree(OLD, tmp_path, dirs_exist_ok=True)
    files = ("wall.ptx", "--seeds", "photo.seeds.json", "--photo", "photo.png")
    status, _, err = run_cli("colorize", *files, "-o", "new.png", "--preset", "paper")
    assert status == 0, err
    np.testing.assert_array_equal(read_image(tmp_path / "new.png"), read_image(OLD / "wall.png"))
