"""The command line with unusable input: one line that says so, the right exit status, nothing written."""

import os
import struct
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from command_line import COLORIZE, assert_refused, run_process, save_seeds
from small_scans import random_scan

from reflcolor_addon import read_scans
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_e57

SEEDS = ("seeds", "garage.ptx", "--photo", "view.png")
_NOBODY = 65534

# Wrong usage


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        ((), "VERB"),
        (("paint",), "paint"),
        (("info",), "SCAN"),
        (("info", "garage.ptx", "--xml"), "--xml"),
        (("colorize", "garage.ptx", "-o", "out.png"), "--seeds"),
        (COLORIZE, "-o"),
        ((*COLORIZE, "-o", "out.png", "--alpha", "x"), "--alpha: expected a number from 0.1 to 64, found x"),
        ((*COLORIZE, "-o", "out.png", "--alpha"), "--alpha"),
        ((*COLORIZE, "-o", "out.png", "--alpha", "-1"), "--alpha: expected a number from 0.1 to 64, found -1"),
        ((*COLORIZE, "-o", "out.png", "--alpha", "nan"), "--alpha: expected a number from 0.1"),
        ((*COLORIZE, "-o", "out.png", "--beta", "inf"), "--beta: expected a number from 0 to"),
        ((*COLORIZE, "-o", "out.png", "--hog-window", "9"), "--hog-window: expected at least a block"),
        (
            (*COLORIZE, "-o", "out.png", "--nearest", "0"),
            "--nearest: expected a whole number from 1 to 1024, or one of auto, all, found 0",
        ),
        ((*COLORIZE, "-o", "out.png", "--nearest", "few"), "one of auto, all, found few"),
        ((*COLORIZE, "-o", "out.png", "--preset", "poster"), "--preset: invalid choice: 'poster'"),
        ((*COLORIZE, "-o", "out.png", "--neighbors", "6"), "--neighbors"),
        ((*COLORIZE, "-o", "out.png", "--color-space", "rgb"), "--color-space"),
        ((*COLORIZE, "-o", "out.gif"), "out.gif: the suffix tells what to write; expected one of .png, "),
        ((*COLORIZE, "-o", "out"), "the suffix tells"),
        ((*COLORIZE, "-o", "out.png", "-o", "./out.png"), "the same file as -o out.png"),
        ((*COLORIZE, "-o", "out.png", "--report", "out.png"), "--report out.png: the same file as -o out.png"),
        ((*COLORIZE, "-o", "out.png", "--report", "seeds.json"), "--report seeds.json: is an input"),
        ((*COLORIZE, "-o", "out.png", "--report", "./garage.ptx"), "is an input"),
        ((*COLORIZE, "--photo", "view.png", "-o", "view.png"), "-o view.png: is an input"),
        ((*SEEDS, "-o", "seeds.txt"), "-o seeds.txt: expected a file that ends in .json"),
        ((*SEEDS, "-o", "new.json", "--matches", "new.jpg"), "--matches new.jpg: expected a file that ends in .png"),
        ((*SEEDS, "-o", "new.json", "--slic-segments", "0"), "--slic-segments: expected a whole number from 1"),
    ],
    ids=lambda value: "" if isinstance(value, str) else " ".join(value[1:]),
)
def test_wrong_usage_is_said_in_one_line_and_nothing_is_written(run_cli, cli_folder, arguments, part):
    write_png(cli_folder / "view.png", np.zeros((2, 2, 3), np.uint8))
    before = {path: path.read_bytes() for path in cli_folder.iterdir()}
    assert_refused(run_cli(*arguments), 2, part)
    assert {path: path.read_bytes() for path in cli_folder.iterdir()} == before


def test_an_output_that_is_an_input_by_another_name_is_refused(run_cli, cli_folder):
    (cli_folder / "linked.png").symlink_to(cli_folder / "garage.ptx")
    assert_refused(run_cli(*COLORIZE, "-o", "linked.png"), 2, "is an input")


# Bad input


def ptx(folder):
    return (folder / "garage.ptx").read_text(encoding="ascii").splitlines()


def with_ptx(change):
    """A case whose PTX file has the lines that ``change`` makes of those of a good one."""

    def prepare(folder):
        (folder / "garage.ptx").write_text("\n".join(change(ptx(folder))) + "\n", encoding="ascii")

    return prepare


def with_seeds(*seeds):
    return lambda folder: save_seeds(folder, *seeds)


def missing(folder):
    (folder / "garage.ptx").unlink()


def directory(folder):
    missing(folder)
    (folder / "garage.ptx").mkdir()


def empty(folder):
    (folder / "garage.ptx").write_bytes(b"")


def no_image(folder):
    (folder / "view.jpg").write_text("a photo, they said", encoding="ascii")
    save_seeds(folder, {"row": 1, "col": 2, "photo": "view.jpg", "x": 1, "y": 1})


def cut_photo(folder):
    write_png(folder / "view.png", np.random.default_rng(0).integers(0, 256, (40, 40, 3), np.uint8))
    (folder / "view.png").write_bytes((folder / "view.png").read_bytes()[:1000])


SCAN_CASES = {
    "missing file": (missing, "garage.ptx: no such file"),
    "directory": (directory, "garage.ptx"),
    "empty file": (empty, "garage.ptx: is empty"),
    "truncated": (with_ptx(lambda lines: lines[:15]), "it is cut short"),
    "words among numbers": (with_ptx(lambda lines: [*lines[:20], "0 one 0 0", *lines[21:]]), "line 21"),
    "terabytes announced": (with_ptx(lambda lines: ["99999999", "99999999", *lines[2:]]), "99999999 rows"),
    "zero columns": (with_ptx(lambda lines: ["0", *lines[1:]]), "line 1"),
    "zero rows": (with_ptx(lambda lines: [lines[0], "0", *lines[2:]]), "line 2"),
    "negative columns": (with_ptx(lambda lines: ["-10", *lines[1:]]), "garage.ptx"),
    "no returns": (with_ptx(lambda lines: lines[:10] + ["0 0 0 0.5"] * 60), "no pixel with a return"),
}
CASES = SCAN_CASES | {
    "seed outside the grid": (
        with_seeds({"row": 6, "col": 0, "rgb": [1, 2, 3]}),
        "seeds.json: seed 1: row 6, column 0 is outside the scan's grid (rows 0 to 5, columns 0 to 9); "
        "expected seeds of the scan garage",
    ),
    "negative seed": (with_seeds({"row": 0, "col": -1, "rgb": [1, 2, 3]}), "column -1 is outside"),
    "no seeds": (with_seeds(), "no seeds"),
    "seeds without color": (with_seeds({"row": 0, "col": 0}), "seeds.json: seed 1: expected a color"),
    "seeds missing": (lambda folder: (folder / "seeds.json").unlink(), "seeds.json: no such file"),
    "seeds are no JSON": (lambda folder: (folder / "seeds.json").write_text("row, col"), "seeds.json: line 1"),
    "photo that is no image": (no_image, "view.jpg"),
    "photo that is missing": (
        with_seeds({"row": 0, "col": 0, "photo": "view.jpg", "x": 1, "y": 1}),
        "view.jpg was not given and is not beside",
    ),
}


@pytest.mark.parametrize(("prepare", "part"), CASES.values(), ids=CASES)
def test_bad_input_is_said_in_one_line_and_nothing_is_written(run_cli, cli_folder, prepare, part):
    prepare(cli_folder)
    before = sorted(cli_folder.rglob("*"))
    assert_refused(run_cli(*COLORIZE, "-o", "out.png", "--report", "r.json"), 1, part)
    assert sorted(cli_folder.rglob("*")) == before


@pytest.mark.parametrize(("prepare", "part"), SCAN_CASES.values(), ids=SCAN_CASES)
def test_info_says_what_is_wrong_with_a_scan_in_one_line(run_cli, cli_folder, prepare, part):
    prepare(cli_folder)
    assert_refused(run_cli("info", "garage.ptx"), 1, part)


def test_an_e57_with_a_bad_checksum_is_said_in_one_line(run_cli, cli_folder):
    write_e57(random_scan(shape=(40, 60)), cli_folder / "garage.e57")
    content = bytearray((cli_folder / "garage.e57").read_bytes())
    # Every page of 1024 bytes ends with its checksum.
    (page,) = struct.unpack_from("<I", content, 2 * 1024 - 4)
    struct.pack_into("<I", content, 2 * 1024 - 4, page ^ 0xFFFF)
    (cli_folder / "garage.e57").write_bytes(content)
    outcome = run_cli("colorize", "garage.e57", "--seeds", "seeds.json", "-o", "out.png")
    assert_refused(outcome, 1, "garage.e57", "checksum")
    assert not (cli_folder / "out.png").exists()


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("--photo", "gone.jpg"), "gone.jpg: no such file"),
        (("--photo", "seeds.json"), "seeds.json: is not an image"),
        (("--photo", "view.png"), "view.png"),
        (("-o", "gone/more.png"), "there is no folder gone; make it first"),
        (("-o", "folder.png"), "folder.png: cannot be written: it is a directory"),
        (("-o", "garage.ptx/more.png"), "cannot be written"),
        (("-o", f"{'long' * 100}.png"), "cannot be written (File name too long); choose a shorter name"),
        (("--report", "gone/r.json"), "there is no folder gone; make it first"),
    ],
    ids=lambda value: "" if isinstance(value, str) else " ".join(value)[:40],
)
def test_bad_options_are_said_in_one_line_before_anything_is_written(run_cli, cli_folder, arguments, part):
    (cli_folder / "folder.png").mkdir()
    cut_photo(cli_folder)
    before = sorted(cli_folder.rglob("*"))
    assert_refused(run_cli(*COLORIZE, "-o", "out.png", *arguments), 1, part)
    assert sorted(cli_folder.rglob("*")) == before


@contextmanager
def as_nobody():
    """Files are opened as a user without rights, where tests run as root, to whom everything is writable."""
    root = os.geteuid() == 0
    if root:
        os.seteuid(_NOBODY)
    try:
        yield
    finally:
        if root:
            os.seteuid(0)


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="Windows has other permissions, and no other user to become")
def test_a_folder_or_file_that_may_not_be_written_is_said_in_one_line(run_cli, cli_folder):
    # What is imported on the way lies where nobody may read.
    assert run_cli(*COLORIZE, "-o", "first.png")[0] == 0
    cli_folder.chmod(0o777)
    (cli_folder / "shut").mkdir()
    (cli_folder / "shut").chmod(0o555)
    (cli_folder / "kept.png").write_bytes(b"kept")
    (cli_folder / "kept.png").chmod(0o444)
    for name in ("shut/out.png", "kept.png"):
        with as_nobody():
            outcome = run_cli(*COLORIZE, "-o", name)
        assert_refused(outcome, 1, f"{name}: cannot be written")
    assert (cli_folder / "kept.png").read_bytes() == b"kept"


def test_a_folder_that_nobody_may_write_to_is_said_in_one_line(run_cli):
    # Not even root may: the folder is the kernel's own.
    if not Path("/proc/self").is_dir():
        pytest.skip("needs a file system that is read-only to everybody")
    assert_refused(run_cli(*COLORIZE, "-o", "/proc/out.png"), 1, "/proc/out.png: cannot be written")


def test_running_out_of_memory_is_said_in_one_line(run_cli, cli_folder, monkeypatch):
    def exhausted(*_, **__):
        raise MemoryError

    monkeypatch.setattr("reflcolor_addon.batch.pipeline.colorize", exhausted)
    assert_refused(run_cli(*COLORIZE, "-o", "out.png"), 1, "garage.ptx: not enough memory")
    assert not (cli_folder / "out.png").exists()


def test_a_warning_does_not_make_two_lines_of_an_error(run_cli, cli_folder):
    lines = ptx(cli_folder)
    (cli_folder / "garage.ptx").write_text("\n".join([*lines[:10], "nan 0 0 0", *lines[11:]]), encoding="ascii")
    save_seeds(cli_folder, {"row": 99, "col": 0, "rgb": [1, 2, 3]})
    assert read_scans(cli_folder / "garage.ptx")[0].warnings
    assert_refused(run_cli(*COLORIZE, "-o", "out.png"), 1, "row 99")


def test_a_file_name_with_a_line_break_stays_one_line(run_cli):
    assert_refused(run_cli("info", "two\nlines.ptx"), 1, r"two\nlines.ptx: no such file")


def test_bad_input_ends_a_process_with_one_line(cli_folder):
    (cli_folder / "view.jpg").write_bytes(b"\xff\xd8\xff\xe0 broken")
    done = run_process(*COLORIZE, "--photo", "view.jpg", "-o", "out.png")
    assert_refused((done.returncode, done.stdout, done.stderr), 1, "view.jpg")


def test_seeds_by_hand_of_another_scan_are_refused_by_their_file(run_cli, cli_folder):
    write_png(cli_folder / "view.png", np.zeros((20, 20, 3), np.uint8))
    save_seeds(cli_folder, {"row": 99, "col": 0, "rgb": [1, 2, 3]})
    outcome = run_cli(*SEEDS, "--hand", "seeds.json", "-o", "new.json")
    assert_refused(outcome, 1, "seeds.json: seed 1: row 99, column 0 is outside", "expected seeds of the scan garage")
    assert not (cli_folder / "new.json").exists()


def test_a_defect_is_not_hidden(run_cli, monkeypatch):
    def broken(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr("reflcolor_addon.batch.pipeline.colorize", broken)
    with pytest.raises(ZeroDivisionError):
        run_cli(*COLORIZE, "-o", "out.png")
