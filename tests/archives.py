"""A small archive of scans with seeds and a manifest, for tests of batches."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon import Seeds
from reflcolor_addon.batch.archive.check import check_manifest
from reflcolor_addon.batch.archive.manifest_file import load_manifest
from reflcolor_addon.cli.main import main
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_ptx

HEAD = 'format = "reflcolor-batch"\nversion = 1\noutput = "colored"\n'


def make_archive(folder, count=3, shape=(12, 16)):
    """Write ``count`` scans with seeds, and the manifest batch.toml that names them; return its path."""
    tables = []
    for number in range(count):
        write_ptx(random_scan(shape=shape, seed=number), folder / f"hall_{number}.ptx")
        seeds = Seeds([1, 8], [2, 13], [[200, 80, 40 + number], [20, 80, 220]])
        seeds.save(folder / f"hall_{number}.seeds.json")
        tables.append(f'[[scan]]\nfile = "hall_{number}.ptx"\nseeds = "hall_{number}.seeds.json"\n')
    path = folder / "batch.toml"
    path.write_text(HEAD + 'write = ["png", "ply"]\n' + "\n".join(tables), encoding="utf-8")
    return path


def damage_points(path):
    """Make the first line of points of a PTX something else, which its header does not tell."""
    lines = path.read_text(encoding="utf-8").splitlines()
    lines[10] = "no point"
    path.write_text("\n".join(lines), encoding="utf-8")


def outputs_of(folder):
    """The bytes of everything that a batch made for its user, by path; reports without their times."""
    found = {}
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        if path.is_dir() or parts[0] in ("batch-state", "logs") or path.suffix in (".html", ".csv"):
            continue
        found["/".join(parts)] = _timeless(path) if path.suffix == ".json" else path.read_bytes()
    return found


def _timeless(path):
    report = json.loads(Path(path).read_text(encoding="utf-8"))
    return {key: value for key, value in report.items() if key not in ("times_s", "created")}


def table_of(folder):
    """The rows of a batch's table of figures, by scan."""
    with (folder / "colored" / "report.csv").open(encoding="utf-8", newline="") as file:
        return {row["scan"]: row for row in csv.DictReader(file)}


@pytest.fixture
def archive(tmp_path, monkeypatch):
    """The current folder, with an archive of three scans."""
    monkeypatch.chdir(tmp_path)
    make_archive(tmp_path)
    return tmp_path


@pytest.fixture
def batch(archive, capfd):
    """A function that runs a batch in this process, its workers beside it; returns status, output and errors."""

    def run(*options):
        capfd.readouterr()
        status = main(["batch", "batch.toml", "--jobs", "1", *options])
        said = capfd.readouterr()
        return status, said.out, said.err

    return run


def read_manifest(folder, text):
    """The manifest of this text in a folder, and the lines of what is wrong with it."""
    path, faults = folder / "batch.toml", []
    path.write_text(text, encoding="utf-8")
    manifest = load_manifest(path, faults.append)
    if manifest is not None:
        check_manifest(manifest, None, faults.append)
    return manifest, [str(fault).removeprefix(f"{path}: ") for fault in faults]


@pytest.fixture
def folder(tmp_path):
    """An archive of three scans, and two photos in a folder of their own."""
    make_archive(tmp_path)
    (tmp_path / "photos").mkdir()
    for name in ("a.png", "b.png"):
        write_png(tmp_path / "photos" / name, np.full((8, 8, 3), 90, np.uint8))
    return tmp_path
