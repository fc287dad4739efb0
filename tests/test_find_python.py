"""How make setup finds its Python: a candidate counts only if it runs; what is missing is said in one line."""

import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parent.parent / "tools" / "find_python.sh"
VERSION = f"{sys.version_info.major}.{sys.version_info.minor}"
BASE_PYTHON = Path(sys.base_prefix, "bin", "python3")

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="a POSIX shell script")


def find(*arguments, path, home, **variables):
    return subprocess.run(
        ["/bin/sh", TOOL, *arguments],
        env={"PATH": f"{path}:/usr/bin:/bin", "HOME": str(home), **variables},
        capture_output=True,
        text=True,
        check=False,
    )


def command(folder, name, script):
    folder.mkdir(exist_ok=True)
    file = folder / name
    file.write_text(f"#!/bin/sh\n{script}\n")
    file.chmod(0o755)
    return file


def test_a_shim_that_does_not_run_is_passed_over(tmp_path):
    shims, real = tmp_path / "shims", tmp_path / "home" / ".pyenv" / "versions" / f"{VERSION}.0" / "bin"
    command(shims, f"python{VERSION}", "echo 'pyenv: command not found' >&2; exit 127")
    command(shims, "python3", "exit 127")
    command(shims, "python", "exit 127")
    real.mkdir(parents=True)
    command(real, "python", f'exec "{BASE_PYTHON}" "$@"')
    done = find(VERSION, path=shims, home=tmp_path / "home")
    assert done.returncode == 0
    assert Path(done.stdout.strip()).exists()


def test_a_python_of_another_version_does_not_count(tmp_path):
    command(tmp_path / "bin", "python3.99", f'exec "{BASE_PYTHON}" "$@"')
    done = find("3.99", path=tmp_path / "bin", home=tmp_path)
    assert done.returncode == 1


def test_the_named_python_is_taken(tmp_path):
    done = find(path=tmp_path, home=tmp_path, PYTHON=str(BASE_PYTHON))
    assert done.returncode == 0
    assert Path(done.stdout.strip()).samefile(BASE_PYTHON)


def test_a_named_python_that_does_not_run_is_said(tmp_path):
    done = find(path=tmp_path, home=tmp_path, PYTHON="/no/such/python")
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr.startswith("setup: PYTHON=/no/such/python is no 64-bit CPython 3.13 or 3.11")
    assert len(done.stderr.splitlines()) == 1


def test_a_python_without_venv_is_said(tmp_path):
    named = command(tmp_path, "python", f"echo without-venv {tmp_path}/python")
    done = find("3.11", path=tmp_path, home=tmp_path, PYTHON=str(named))
    assert done.returncode == 1
    assert done.stderr == "setup: Python 3.11 lacks its venv module: apt-get install python3.11-venv\n"


def test_no_python_at_all_says_what_to_install(tmp_path):
    done = find("3.99", path=tmp_path, home=tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith("setup: no Python 3.99 found: apt-get install python3.11 python3.11-venv")
    assert len(done.stderr.splitlines()) == 1
