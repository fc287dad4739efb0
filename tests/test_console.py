"""What the command line shows, whatever it is connected to."""

import os
import sys
from pathlib import Path

import pytest
from command_line import COLORIZE, SHAPE, assert_refused, run_process
from small_scans import random_scan

from reflcolor_addon.files.writers import write_ptx


def test_progress_is_shown_on_a_terminal_and_leaves_no_trace(run_cli, cli_folder, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setattr("reflcolor_addon.cli.console._REDRAW_S", 0.0)
    status, out, err = run_cli(*COLORIZE, "-o", "out.png")
    assert (status, out) == (0, "wrote out.png\n")
    assert " 48%  Seed 1 of 2" in err
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
