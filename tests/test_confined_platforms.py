"""What each system refuses to the process that reads E57, and where its Python is found."""

import ctypes
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from reflcolor_addon.files.confined import child, confinement, python_program, reading, windows_job


@pytest.mark.parametrize("machine", ["x86_64", "aarch64"])
def test_the_filter_of_calls_decides_each_as_it_should(machine):
    """The program of the filter, run by a small interpreter of its instructions."""
    opening = {"x86_64": 257, "aarch64": 56}[machine]
    numbers = {"x86_64": {"socket": 41, "execve": 59, "read": 0}, "aarch64": {"socket": 198, "execve": 221, "read": 63}}
    architecture = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}[machine]

    def decide(number, arguments=(0, 0, 0), arch=architecture):
        data = {0: number, 4: arch} | {16 + 8 * place: value for place, value in enumerate(arguments)}
        program = confinement._program(machine)
        lines = [confinement.struct.unpack_from("HBBI", program, at) for at in range(0, len(program), 8)]
        at, value = 0, 0
        while True:
            code, yes, no, k = lines[at]
            at += 1
            if code == 0x06:
                return k
            if code == 0x20:
                value = data[k]
            else:
                test = {0x15: value == k, 0x45: bool(value & k), 0x35: value >= k}[code]
                at += yes if test else no

    refused, allowed, killed = 0x0005000D, 0x7FFF0000, 0x80000000
    assert decide(numbers[machine]["socket"]) == decide(numbers[machine]["execve"]) == refused
    assert decide(numbers[machine]["read"]) == allowed
    assert decide(opening, (0, 0, os.O_RDONLY)) == allowed
    assert {decide(opening, (0, 0, flag)) for flag in (os.O_WRONLY, os.O_RDWR, os.O_CREAT, os.O_TRUNC)} == {refused}
    assert decide(numbers[machine]["read"], arch=1) == killed
    assert decide(0x40000000 | numbers[machine]["socket"]) == refused


def test_a_machine_whose_calls_are_not_known_is_not_filtered(monkeypatch):
    monkeypatch.setattr(confinement.platform, "machine", lambda: "riscv64")
    with pytest.raises(ValueError, match="riscv64"):
        confinement._filter_calls()


# Windows and macOS, with stubs: they are not tried


def test_on_macos_the_network_is_left_by_its_sandbox(monkeypatch):
    asked = []

    def sandbox(profile, flags, _error):
        asked.append((profile, flags))
        return 0

    monkeypatch.setattr(confinement.sys, "platform", "darwin")
    monkeypatch.setattr(confinement.ctypes, "CDLL", lambda path: SimpleNamespace(sandbox_init=sandbox))
    assert confinement._leave_network()
    assert asked == [(b"(version 1)(allow default)(deny network*)", 0)]
    assert not confinement._end_with_parent()
    assert not confinement._filter_calls()


@pytest.fixture
def windows(monkeypatch):
    """What a stub of Windows was asked for: (call, arguments)."""
    asked, results = [], {"CreateJobObjectW": 7}

    class Call:
        def __init__(self, name):
            self.name = name

        def __call__(self, *arguments):
            asked.append((self.name, arguments))
            return results.get(self.name, 1)

    names = ("CreateJobObjectW", "SetInformationJobObject", "AssignProcessToJobObject", "CloseHandle")
    kernel = SimpleNamespace(**{name: Call(name) for name in names})
    monkeypatch.setattr(ctypes, "windll", SimpleNamespace(kernel32=kernel), raising=False)
    return asked, results


def test_on_windows_a_child_is_put_into_a_job_with_limits(windows):
    asked, results = windows
    close = windows_job.limited(5, memory=1 << 30, seconds=20)
    assert [name for name, _ in asked] == [
        "CreateJobObjectW", "SetInformationJobObject", "AssignProcessToJobObject",
    ]  # fmt: skip
    limits = asked[1][1][2]._obj
    assert asked[1][1][1] == 9 and ctypes.sizeof(limits) == asked[1][1][3]
    assert (limits.basic.flags, limits.basic.active_processes) == (0x2108 | 0x2, 1)
    assert (limits.basic.process_time, limits.process_memory) == (200_000_000, 1 << 30)
    close()
    assert asked[-1][0] == "CloseHandle"
    results["AssignProcessToJobObject"] = 0
    with pytest.raises(OSError, match="gives no job"):
        windows_job.limited(5, memory=1 << 30, seconds=20)


def test_on_windows_a_child_starts_without_a_window_and_opens_files_by_name(windows, monkeypatch):
    started = []

    def start(line, **options):
        started.append((line, options))
        raise OSError("a stub starts nothing")

    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(child.subprocess, "Popen", start)
    monkeypatch.setattr(child.subprocess, "CREATE_NO_WINDOW", 0x08000000, raising=False)
    monkeypatch.setattr(child, "python_program", lambda: Path("python.exe"))
    with pytest.raises(child.ChildFailed):
        child.Child(Path("points.py"), inherited=[3])
    line, options = started[0]
    assert line == ["python.exe", "-I", "-S", "-B", "points.py"]
    assert options["creationflags"] == 0x08000000
    assert not options.keys() & {"pass_fds", "start_new_session"}
    monkeypatch.delattr(os, "memfd_create", raising=False)
    number, shown = reading.shared_file(64)
    try:
        assert Path(shown).stat().st_size == 64
    finally:
        os.close(number)
        Path(shown).unlink()


@pytest.mark.parametrize(
    ("platform", "executable", "there"),
    [
        ("linux", "/usr/bin/python3.13", "/usr/bin/python3.13"),
        ("linux", "/opt/blender/blender", "/opt/blender/5.2/python/bin/python{v}"),
        ("darwin", "", "/Blender.app/Resources/5.2/python/bin/python{v}"),
        ("win32", "C:/Blender/blender.exe", "C:/Blender/5.2/python/bin/python.exe"),
        ("win32", "C:/Blender/blender.exe", "C:/Blender/5.2/python/python.exe"),
        ("linux", "/opt/blender/blender", None),
    ],
)
def test_the_python_beside_blender_is_found(monkeypatch, platform, executable, there):
    there = there and there.format(v=f"{sys.version_info.major}.{sys.version_info.minor}")
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setattr(sys, "executable", executable)
    monkeypatch.setattr(sys, "_base_executable", executable, raising=False)
    monkeypatch.setattr(sys, "base_exec_prefix", there.split("/python/")[0] + "/python" if there else "/nowhere")
    monkeypatch.setattr(Path, "is_file", lambda path: path.as_posix() == there)
    found = python_program.python_program()
    assert (found and found.as_posix()) == there
