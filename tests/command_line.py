"""The command line for tests: in a folder with a scan and its seeds, in this process or in one of its own."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from small_scans import random_scan

from reflcolor_addon.batch.blender_tasks import BlenderTasks
from reflcolor_addon.cli.main import main
from reflcolor_addon.files.writers import write_ptx

ROOT = Path(__file__).resolve().parent.parent
SHAPE = (6, 10)
COLORIZE = ("colorize", "garage.ptx", "--seeds", "seeds.json")


@pytest.fixture
def cli_folder(tmp_path, monkeypatch):
    """A folder, made the current one, with a scan and its seeds."""
    monkeypatch.chdir(tmp_path)
    write_ptx(random_scan(shape=SHAPE), tmp_path / "garage.ptx")
    save_seeds(tmp_path, {"row": 1, "col": 2, "rgb": [200, 80, 40]}, {"row": 4, "col": 8, "rgb": [20, 80, 220]})
    return tmp_path


@pytest.fixture
def run_cli(cli_folder, capfd):
    """A function that runs the command line and returns exit status, standard output and standard error."""

    def run(*arguments, **options):
        capfd.readouterr()
        status = main([str(argument) for argument in arguments], **options)
        said = capfd.readouterr()
        return status, said.out, said.err

    return run


def blender_tasks(**acts):
    """A Blender for the command line that can do only what is given."""

    def cannot(*_arguments):
        raise AssertionError("was not to be called")

    return BlenderTasks(
        version="5.2.2 LTS", **dict.fromkeys(("write_scene", "decimate", "simulate", "read_provenance"), cannot) | acts
    )


def process_line(*arguments):
    """The command and the options of `subprocess` for the command line in a process of its own."""
    line = [sys.executable, "-m", "reflcolor_addon", *map(str, arguments)]
    return line, {"env": os.environ | {"PYTHONPATH": str(ROOT)}}


def run_process(*arguments, environment=None, **options):
    """Run the command line in a process of its own and return that, with its outputs as text."""
    line, settings = process_line(*arguments)
    settings["env"] |= environment or {}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "timeout": 60}
    return subprocess.run(line, **settings | pipes | options, check=False)


def save_seeds(folder, *seeds):
    """Write a file of seeds."""
    document = {"format": "reflcolor-seeds", "version": 1, "seeds": seeds}
    (folder / "seeds.json").write_text(json.dumps(document), encoding="utf-8")


def assert_refused(outcome, status, *parts):
    """The command ended with the status and one line on standard error that holds the parts."""
    found, out, err = outcome
    assert found == status
    assert out == ""
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    assert err.endswith("\n")
    for part in parts:
        assert part in err
