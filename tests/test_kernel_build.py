"""The wheels of the kernel."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

BUILD = Path(__file__).resolve().parent.parent / "kernel" / "build.py"


@pytest.fixture(scope="module")
def wheels(tmp_path_factory):
    """The host's wheel, built twice."""
    if subprocess.run([sys.executable, "-m", "ziglang", "version"], capture_output=True, check=False).returncode:
        pytest.skip("needs the package ziglang, which make setup installs")
    built = []
    for folder in (tmp_path_factory.mktemp("first"), tmp_path_factory.mktemp("second")):
        subprocess.run([sys.executable, BUILD, "--host", folder], check=True, capture_output=True)
        built += folder.iterdir()
    return built


def test_the_same_sources_give_the_same_bytes(wheels):
    first, second = wheels
    assert first.name == second.name
    assert first.read_bytes() == second.read_bytes()


def test_a_wheel_fits_every_python_of_its_platform_and_records_its_files(wheels):
    with zipfile.ZipFile(wheels[0]) as wheel:
        names = set(wheel.namelist())
        record = next(name for name in names if name.endswith(".dist-info/RECORD"))
        listed = {line.split(",")[0] for line in wheel.read(record).decode().splitlines()}
        tag = wheel.read(record.replace("RECORD", "WHEEL")).decode()
    assert listed == names
    assert "Tag: py3-none-" in tag
    assert "-py3-none-" in wheels[0].name


def test_the_library_names_no_folder_of_the_machine_it_was_built_on(wheels):
    with zipfile.ZipFile(wheels[0]) as wheel:
        content = b"".join(wheel.read(name) for name in wheel.namelist())
    assert str(Path(BUILD).parent).encode() not in content


@pytest.mark.skipif(sys.platform != "linux", reason="reads an ELF library")
def test_the_library_needs_no_newer_c_library_than_2_17(wheels):
    import re

    with zipfile.ZipFile(wheels[0]) as wheel:
        library = wheel.read(next(name for name in wheel.namelist() if name.endswith(".so")))
    versions = {tuple(map(int, found)) for found in re.findall(rb"GLIBC_(\d+)\.(\d+)", library)}
    assert versions
    assert max(versions) <= (2, 17)
    assert b"ubsan" not in library
