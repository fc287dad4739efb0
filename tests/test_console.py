"""What the command line shows, whatever it is connected to."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import COLORIZE, SHAPE, assert_refused, process_line, run_process
from small_scans import random_scan

from reflcolor_addon.files.writers import write_ptx


def test_progress_is_shown_on_a_terminal_and_leaves_no_trace(run_cli, cli_folder, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setattr("reflcolor_addon.cli.console._REDRAW_S", 0.0)
    status, out, err = run_cli(*COLORIZE, "-o", "out.png")
    assert (status, out) == (0, "wrote out.png\n")
    assert " 78%  Estimating by kriging" in err
    assert "\n" not in err
    assert err.rpartition("\r")[0].endswith(" ")
    assert err.endswith("\r")


def test_it_is_no_error_when_nobody_reads_the_output(cli_folder):
    reader, writer = os.pipe()
    os.close(reader)
    done = run_process("info", "garage.ptx", stdout=writer)
    os.close(writer)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_an_output_that_is_full_is_said_in_one_line(cli_folder):
    with Path("/dev/full").open("w") as full:
        done = run_process("info", "garage.ptx", stdout=full)
    assert_refused((done.returncode, "", done.stderr), 1, "standard output: cannot be written")


def test_names_that_the_output_cannot_encode_are_escaped(cli_folder):
    write_ptx(random_scan(shape=SHAPE), cli_folder / "gar\u00e1\u017e.ptx")
    done = run_process("info", "gar\u00e1\u017e.ptx", environment={"PYTHONIOENCODING": "latin-1"}, text=False)
    assert done.returncode == 0
    assert done.stdout.startswith(b"1  gar\xe1\\u017e")


def closed(arguments, numbers):
    """The outcome of a run that is started with some of its standard streams closed."""
    line, options = process_line(*arguments)
    close = f"import os, sys; [os.close(n) for n in {numbers}]; os.execv(sys.argv[1], sys.argv[1:])"
    return subprocess.run([sys.executable, "-c", close, *line], **options, capture_output=True, timeout=60, check=False)


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="streams are closed the POSIX way")
def test_closed_streams_change_nothing_in_the_outputs(cli_folder):
    # Native code prints about a broken photo, to whichever file is number 2.
    (cli_folder / "view.jpg").write_bytes(b"\xff\xd8\xff\xe0 broken")
    assert closed((*COLORIZE, "-o", "a.ply"), ()).returncode == 0
    assert closed((*COLORIZE, "-o", "b.ply"), (0, 1, 2)).returncode == 0
    assert (cli_folder / "a.ply").read_bytes() == (cli_folder / "b.ply").read_bytes()
    refused = closed((*COLORIZE, "--photo", "view.jpg", "-o", "c.ply"), (1,))
    assert_refused((refused.returncode, "", refused.stderr.decode()), 1, "view.jpg")


@pytest.mark.parametrize("arguments", [("--help",), ("info", "none.ptx")])
def test_nobody_to_read_anything_is_no_traceback(cli_folder, arguments):
    reader, writer = os.pipe()
    os.close(reader)
    done = run_process(*arguments, stdout=writer, stderr=writer)
    os.close(writer)
    assert done.returncode == {"--help": 0, "info": 1}[arguments[0]]


@pytest.mark.skipif(os.name == "nt", reason="Windows keeps a current folder from being deleted")
def test_a_current_folder_that_was_deleted_is_one_line(cli_folder, monkeypatch):
    gone = cli_folder / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    done = run_process(*COLORIZE, "-o", "out.png")
    assert_refused((done.returncode, done.stdout, done.stderr), 1, "the current folder was deleted")
    # What is named in full is found all the same.
    done = run_process("info", cli_folder / "garage.ptx")
    assert (done.returncode, done.stderr) == (0, "")


TOO_LONG = [
    ("info", "{}.ptx"),
    ("colorize", "garage.ptx", "--seeds", "{}.json", "-o", "a.png"),
    ("colorize", "garage.ptx", "--photo", "{}.png", "-o", "a.png"),
    (*COLORIZE, "-o", "{}.png"),
    (*COLORIZE, "-o", "{}/a.png"),
    (*COLORIZE, "-o", "a.png", "--report", "{}.json"),
    ("verify", "{}.json"),
    ("evaluate", "garage.ptx", "{}.png"),
]


@pytest.mark.parametrize("arguments", TOO_LONG)
@pytest.mark.parametrize("name", ["n" * 300, "deep/" * 1000 + "n"], ids=["name", "path"])
def test_a_name_that_is_too_long_is_one_line(run_cli, arguments, name):
    assert_refused(run_cli(*(part.format(name) for part in arguments)), 1)
