"""What is taken out of the bundled wheels, and that nothing else is."""

import struct
import zipfile

import pytest
from trim_wheels import faults, loaded_parts, trim_wheel, trimmed_name, without_symbols

NAME = "example-1.0-cp313-cp313-manylinux_2_28_x86_64.whl"
CODE, SYMBOLS = b"the code that runs. ", b"names for a debugger"


def library(code=CODE, symbols=SYMBOLS, symbols_loaded=False):
    """A 64-bit ELF file of one loaded part, debug symbols after it, and the names of sections."""
    names = b"\0.text\0.debug_info\0.shstrtab\0"
    code_at = 64 + 56
    symbols_at, names_at = code_at + len(code), code_at + len(code) + len(symbols)
    table_at = names_at + len(names)
    loaded = len(code) + (len(symbols) if symbols_loaded else 0)
    head = b"\x7fELF\x02\x01\x01".ljust(16, b"\0")
    head += struct.pack("<HHIQQQIHHHHHH", 3, 62, 1, 0, 64, table_at, 0, 64, 56, 1, 64, 4, 3)
    head += struct.pack("<IIQQQQQQ", 1, 5, code_at, code_at, code_at, loaded, loaded, 1)
    sections = [
        (0, 0, 0, 0),
        (1, 1, code_at, len(code)),
        (7, 1, symbols_at, len(symbols)),
        (19, 3, names_at, len(names)),
    ]
    table = b"".join(struct.pack("<IIQQQQIIQQ", n, kind, 0, 0, at, size, 0, 0, 1, 0) for n, kind, at, size in sections)
    return head + code + symbols + names + table


def wheel(path, files):
    path.parent.mkdir(exist_ok=True)
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


@pytest.fixture
def original(tmp_path):
    files = {
        "example/__init__.py": "answer = 42\n",
        "example/tests/test_answer.py": "assert True\n",
        "example/core.so": library(),
        "skimage/data/brick.png": b"an image",
        "skimage/data/__init__.pyi": "brick: object\n",
        "example-1.0.dist-info/licenses/LICENSE": "as free as can be\n",
        "example-1.0.dist-info/WHEEL": "Wheel-Version: 1.0\nTag: cp313-cp313-manylinux_2_28_x86_64\n",
        "example-1.0.dist-info/RECORD": "",
    }
    return wheel(tmp_path / "original" / NAME, files)


def test_tests_and_sample_images_go_and_all_else_stays(original, tmp_path):
    trimmed = trim_wheel(original, tmp_path / "out")
    with zipfile.ZipFile(trimmed) as archive:
        assert archive.testzip() is None
        assert set(zipfile.ZipFile(original).namelist()) - set(archive.namelist()) == {
            "example/tests/test_answer.py",
            "skimage/data/brick.png",
        }
        assert archive.read("example-1.0.dist-info/licenses/LICENSE") == b"as free as can be\n"
    assert faults(original, trimmed) == []


def test_the_trimmed_wheel_says_so_and_gives_way_to_a_whole_one(original, tmp_path):
    trimmed = trim_wheel(original, tmp_path / "out")
    assert trimmed.name == trimmed_name(NAME) == "example-1.0-0trimmed-cp313-cp313-manylinux_2_28_x86_64.whl"
    # Of two wheels of one version Blender takes the one whose name comes later.
    assert trimmed.name < NAME
    assert b"\nBuild: 0trimmed\n" in zipfile.ZipFile(trimmed).read("example-1.0.dist-info/WHEEL")


def test_the_record_lists_what_the_wheel_holds(original, tmp_path):
    with zipfile.ZipFile(trim_wheel(original, tmp_path / "out")) as archive:
        lines = archive.read("example-1.0.dist-info/RECORD").decode().splitlines()
        assert {line.split(",")[0] for line in lines} == set(archive.namelist())
        assert all(int(line.split(",")[2] or 0) in (0, archive.getinfo(line.split(",")[0]).file_size) for line in lines)


def test_the_same_wheel_gives_the_same_bytes(original, tmp_path):
    first, second = trim_wheel(original, tmp_path / "a"), trim_wheel(original, tmp_path / "b")
    assert first.read_bytes() == second.read_bytes()


def test_symbols_of_a_library_become_zeros_and_what_is_loaded_stays():
    data, emptied = library(), without_symbols(library())
    assert emptied == data.replace(SYMBOLS, bytes(len(SYMBOLS)))
    ((start, length),) = loaded_parts(emptied)
    assert emptied[start : start + length] == CODE


def test_symbols_that_are_loaded_stay():
    data = library(symbols_loaded=True)
    assert without_symbols(data) == data


@pytest.mark.parametrize(
    "data", [b"", b"\x7fELF", b"MZ and so on", b"\xcf\xfa\xed\xfe of a Mac", b"\x7fELF\x01\x01 of 32 bits"]
)
def test_other_files_stay_as_they_are(data):
    assert without_symbols(data) == data


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"example/__init__.py": "answer = 43\n"}, "example/__init__.py is not the original's"),
        ({"example/core.so": library(code=CODE.upper())}, "example/core.so is not the original's"),
        ({"example/added.py": "import os\n"}, "example/added.py is not in the original"),
        ({"example-1.0.dist-info/licenses/LICENSE": None}, "example-1.0.dist-info/licenses/LICENSE is missing"),
    ],
)
def test_a_wheel_that_is_not_the_trimmed_original_is_found_out(original, tmp_path, change, fault):
    with zipfile.ZipFile(trim_wheel(original, tmp_path / "out")) as archive:
        files = {name: archive.read(name) for name in archive.namelist()} | change
    changed = wheel(tmp_path / "changed" / NAME, {name: data for name, data in files.items() if data is not None})
    assert faults(original, changed) == [fault]
