"""The package for Python without Blender, as `pip install .` builds it."""

import ast
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from small_scans import random_scan

import reflcolor_addon
from reflcolor_addon import Seeds, __version__
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_ptx

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A folder with what the wheel installs."""
    folder = tmp_path_factory.mktemp("package")
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-build-isolation"]
    command += ["--no-deps", "--no-index", "--wheel-dir", str(folder), str(ROOT)]
    # pip makes a socket when it is started, to see whether there is IPv6: `make test-no-network` need not hear of it.
    environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, env=environment)
    assert done.returncode == 0, done.stderr
    (wheel,) = folder.glob("reflcolor-*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site")
    return folder / "site"


def run(installed, *arguments, cwd):
    """Python with the package in place of the sources; bpy cannot be imported, nor another build of the kernel."""
    (installed / "bpy.py").write_text("raise ImportError('no Blender here')")
    line = [sys.executable, "-W", "error", "-P", *arguments]
    environment = os.environ | {"PYTHONPATH": str(installed)}
    return subprocess.run(line, cwd=cwd, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_the_examples_of_the_readme_run_with_the_native_kernel(installed, tmp_path):
    write_ptx(random_scan(shape=(20, 30)), tmp_path / "garage.ptx")
    Seeds([1, 15], [2, 20], [[200, 80, 40], [20, 80, 220]]).save(tmp_path / "garage.seeds.json")
    write_png(tmp_path / "garage.png", np.random.default_rng(0).integers(0, 256, (64, 96, 3), np.uint8))
    (tmp_path / "garage.png").rename(tmp_path / "garage.jpg")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    # Noise shows no scan, so that no photo is verified.
    example = example.replace(
        'match_photos(scan, ["garage.jpg"])', 'match_photos(scan, ["garage.jpg"], Settings(guess=True))'
    )
    assert "guess" in example
    example += "\nimport reflcolor_addon, reflcolor_kernel; print(reflcolor_addon.__file__, reflcolor_kernel.__file__)"
    example += "\nprint(result.method['engine'], result.rgb.shape, reflcolor_addon.__version__)"
    done = run(installed, "-c", example, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    places, result = done.stdout.strip().splitlines()[-2:]
    assert all(place.startswith(str(installed)) for place in places.split())
    assert re.fullmatch(rf"reflcolor kernel, interface \d+ \(20, 30, 3\) {re.escape(__version__)}", result)


def test_the_command_line_runs_as_a_program(installed, tmp_path):
    entry = (next(installed.glob("*.dist-info")) / "entry_points.txt").read_text()
    assert "reflcolor = reflcolor_addon.__main__:main" in entry
    done = run(installed, "-m", "reflcolor_addon", "--version", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, f"reflcolor {__version__}\n")


def test_the_package_says_that_it_is_typed_and_brings_its_license(installed):
    assert (installed / "reflcolor_addon" / "py.typed").is_file()
    assert next(installed.glob("*.dist-info/licenses/LICENSE")).is_file()


def test_what_the_package_gives_and_what_type_checkers_are_told_are_the_same():
    stub = ast.parse((ROOT / "reflcolor_addon" / "__init__.pyi").read_text(encoding="utf-8"))
    told = {alias.name for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert told == set(reflcolor_addon.__all__)
    assert all(getattr(reflcolor_addon, name) is not None for name in told)
