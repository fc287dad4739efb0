"""E57 is read in a separate process: any failure of it is one line here, and its rights are few."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from small_scans import random_scan

from reflcolor_addon.errors import Cancelled, ScanError
from reflcolor_addon.files.confined import child, confinement, reading
from reflcolor_addon.files.readers import e57_columns, read_scans
from reflcolor_addon.files.writers import write_e57

FOLDER = Path(confinement.__file__).parent
LINUX = pytest.mark.skipif(
    not sys.platform.startswith("linux"),
    reason="needs what Linux has: /proc, limits of a process, a filter of its calls",
)
LISTEN = "import json, os, sys, time\nline = sys.stdin.readline()\n"
READY = LISTEN + 'print(json.dumps({"ready": True}), flush=True)\nsys.stdin.readline()\n'


@pytest.fixture
def scan_file(tmp_path):
    path = tmp_path / "garage.e57"
    write_e57(random_scan(shape=(6, 10)), path)
    return path


@pytest.fixture
def stub(tmp_path, monkeypatch):
    """A function that puts a program of ours in place of the one that reads points."""

    def put(program):
        script = tmp_path / "stub.py"
        script.write_text(program)
        monkeypatch.setattr(e57_columns, "SCRIPT", script)

    return put


def failure(path):
    with pytest.raises(ScanError) as caught:
        read_scans(path)
    assert str(caught.value).startswith("garage.e57: ")
    assert str(caught.value).isprintable() and len(str(caught.value)) < 400
    return str(caught.value)


def children():
    """Processes that this one started and that are still there."""
    return Path(f"/proc/{os.getpid()}/task/{threading.get_native_id()}/children").read_text().split()


@pytest.mark.parametrize(
    ("program", "said"),
    [
        (LISTEN + "os.abort()", "crashed on it"),
        (READY + "os.abort()", "crashed on it"),
        (READY + "os.kill(os.getpid(), 11)", "crashed on it"),
        (READY + "sys.exit(0)", "crashed on it"),
        (READY + "raise ValueError", "crashed on it"),
        (READY + "os.kill(os.getpid(), 9)", "takes longer to read, or more memory"),
        ("syntax error", "crashed on it"),
        (READY + 'print("words", flush=True)\ntime.sleep(60)', "answered what makes no sense"),
        (READY + 'print("[1]", flush=True)\ntime.sleep(60)', "answered what makes no sense"),
        (READY + 'print(json.dumps({"read": 61}), flush=True)\ntime.sleep(60)', "answered what makes no sense"),
        (READY + 'print(json.dumps({"read": -1}), flush=True)\ntime.sleep(60)', "answered what makes no sense"),
        (READY + 'print(json.dumps({"read": "1"}), flush=True)\ntime.sleep(60)', "answered what makes no sense"),
        (READY + 'print(json.dumps({"no": 1}), flush=True)\ntime.sleep(60)', "answered what makes no sense"),
        (READY + 'sys.stdout.write("{" * 10**6)\nsys.stdout.flush()\ntime.sleep(60)', "answered what makes no sense"),
        (READY + 'os.write(1, b"\\xff\\x00\\n")\ntime.sleep(60)', "answered what makes no sense"),
        (
            READY + 'print(json.dumps({"done": 59}), flush=True)\ntime.sleep(60)',
            "holds 59 points where 60 were announced",
        ),
        (READY + 'print(json.dumps({"error": "two\\nlines"}), flush=True)', "cannot be read as E57 (two)"),
        (READY + 'print(json.dumps({"error": "(ErrorBadChecksum)"}), flush=True)', "a checksum does not match"),
        (READY + 'print(json.dumps({"error": "x" * 9999}), flush=True)', "cannot be read as E57 (xxx"),
        (READY + 'print(json.dumps({"error": "ErrorMemory"}), flush=True)', "does not fit into memory"),
        (READY + "while True: pass", "was not read on for 1 s"),
        (READY + "import signal\nsignal.signal(15, signal.SIG_IGN)\ntime.sleep(60)", "was not read on for 1 s"),
        (READY + "os.close(1)\ntime.sleep(60)", "answered what makes no sense"),
    ],
)
def test_whatever_the_child_does_is_one_line(scan_file, stub, monkeypatch, program, said):
    monkeypatch.setattr(child, "_STALLED_S", 1)
    monkeypatch.setattr(child, "_ENDS_WITHIN_S", 1)
    stub(program)
    assert said in failure(scan_file)
    assert children() == []


@pytest.mark.parametrize("program", [READY + "time.sleep(60)", LISTEN + "time.sleep(60)", "while True: pass"])
def test_cancelling_ends_the_child_at_once(scan_file, stub, program):
    stub(program)
    start = time.monotonic()
    with pytest.raises(Cancelled):
        read_scans(scan_file, cancelled=lambda: time.monotonic() > start + 0.5)
    assert time.monotonic() - start < 5
    assert children() == []


def test_a_child_that_eats_memory_or_time_is_ended_by_its_limits(scan_file, stub, monkeypatch):
    limited = (
        f"import json, os, sys\nsys.path.insert(0, {str(FOLDER)!r})\nfrom confinement import confine\n"
        "request = json.loads(sys.stdin.readline())\n"
        'confine(**{key: request[key] for key in ("memory", "written", "seconds")})\n'
        'print(json.dumps({"ready": True}), flush=True)\n'
    )
    stub(limited + "held = []\nwhile True: held.append(bytearray(1 << 26))")
    assert "crashed on it" in failure(scan_file)
    # Not before: on a busy machine it takes longer than a second to hold as much as may be held.
    monkeypatch.setattr(e57_columns, "_BASE_SECONDS", 1)
    stub(limited + "while True: pass")
    assert "takes longer to read, or more memory" in failure(scan_file)


def test_a_real_file_comes_back_whole_and_no_process_is_left(scan_file):
    told = []
    (scan,) = read_scans(scan_file, progress=lambda fraction, text: told.append(fraction))
    assert np.allclose(scan.points, random_scan(shape=(6, 10)).points)
    assert told[0] == 0 and told[-1] == 1
    assert children() == []


def test_files_are_read_in_several_threads_at_a_time(scan_file):
    found = []
    threads = [threading.Thread(target=lambda: found.append(read_scans(scan_file)[0].shape)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [(6, 10)] * 4


def test_a_name_that_is_no_text_opens(scan_file):
    odd = scan_file.with_name(os.fsdecode(b"gar\xffage.e57"))
    scan_file.rename(odd)
    assert read_scans(odd)[0].shape == (6, 10)


def test_the_file_that_was_looked_at_is_the_one_that_is_read(scan_file, monkeypatch):
    """The child gets what is open, not a name that may show another file by now."""
    start = reading.Child

    def replaced(*arguments, **options):
        scan_file.unlink()
        scan_file.write_bytes(b"another")
        return start(*arguments, **options)

    monkeypatch.setattr(reading, "Child", replaced)
    assert read_scans(scan_file)[0].shape == (6, 10)


def test_where_nothing_can_be_handed_on_it_is_opened_by_its_name(scan_file, monkeypatch):
    monkeypatch.delattr(os, "memfd_create", raising=False)
    assert read_scans(scan_file)[0].shape == (6, 10)
    assert confinement.reopened(None, "a.e57") == "a.e57"
    assert confinement.reopened(10**6, "a.e57") == "a.e57"


# What the child may still do


@LINUX
def test_a_confined_process_can_reach_nobody_start_nothing_and_change_nothing(tmp_path):
    (tmp_path / "there").write_text("kept")
    acts = {
        "socket": "import socket; socket.socket()",
        "socket pair": "import socket; socket.socketpair()",
        "fork": "os.fork()",
        "program": "os.execv('/bin/true', ['true'])",
        "write": "open('there', 'w')",
        "append": "open('there', 'a')",
        "create": "open('new', 'x')",
        "remove": "os.unlink('there')",
        "rename": "os.rename('there', 'gone')",
        "folder": "os.mkdir('made')",
        "link": "os.symlink('there', 'link')",
        "kill": "os.kill(os.getppid(), 0)",
        "mode": "os.chmod('there', 0o600)",
        "read": "open('there').read()",
    }
    program = (
        f"import json, os, sys\nsys.path.insert(0, {str(FOLDER)!r})\nimport socket\n"
        "from confinement import confine\n"
        "done = confine(memory=1 << 30, written=1 << 20, seconds=20)\nfound = {}\n"
        f"for name, act in {acts!r}.items():\n"
        "    try:\n        exec(act)\n        found[name] = None\n"
        "    except OSError as error:\n        found[name] = error.errno\n"
        "print(json.dumps([done, found]))\n"
    )
    run = subprocess.run(
        [sys.executable, "-I", "-S", "-c", program],
        cwd=tmp_path,
        # It is the system that has to refuse, not the library of make test-no-network.
        env={name: value for name, value in os.environ.items() if name != "LD_PRELOAD"},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    done, found = json.loads(run.stdout)
    assert done == ["limits", "ends with parent", "calls"]
    assert found.pop("read") is None
    assert found == dict.fromkeys(acts.keys() - {"read"}, 13)
    assert [path.name for path in tmp_path.iterdir()] == ["there"]
    assert (tmp_path / "there").read_text() == "kept"


@LINUX
def test_a_child_ends_with_its_parent(tmp_path, scan_file):
    program = (
        "import sys, threading, time, os\n"
        "from pathlib import Path\n"
        "from reflcolor_addon.files.readers import e57_columns, read_scans\n"
        f"e57_columns.SCRIPT = Path({str(tmp_path / 'stub.py')!r})\n"
        f"read_scans({str(scan_file)!r})\n"
    )
    (tmp_path / "stub.py").write_text(
        f"import sys\nsys.path.insert(0, {str(FOLDER)!r})\nfrom confinement import confine\n"
        "confine(memory=1 << 30, written=1 << 20, seconds=20)\nimport time\ntime.sleep(60)"
    )
    parent = subprocess.Popen([sys.executable, "-c", program], cwd=Path(__file__).parent.parent)
    task = Path(f"/proc/{parent.pid}/task/{parent.pid}/children")
    end = time.monotonic() + 30
    while not (started := task.read_text().split()):
        assert time.monotonic() < end
        time.sleep(0.02)
    time.sleep(0.5)
    parent.kill()
    parent.wait()
    while Path(f"/proc/{started[0]}").exists() and time.monotonic() < end:
        time.sleep(0.02)
    assert not Path(f"/proc/{started[0]}").exists()


def test_without_any_python_the_way_out_is_named(scan_file, monkeypatch):
    monkeypatch.setattr(child, "python_program", lambda: None)
    assert "none was found beside Blender; export the scan as PTX" in failure(scan_file)


def test_a_child_that_does_not_start_is_one_line(scan_file, monkeypatch):
    def busy(*_, **__):
        raise BlockingIOError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(child.subprocess, "Popen", busy)
    assert "did not start (Resource temporarily unavailable); close other programs" in failure(scan_file)


def test_ctrl_c_reaches_only_the_parent(scan_file, stub):
    """A terminal sends it to all of a group; the child is in one of its own."""
    stub(READY + 'print(json.dumps({"error": str(os.getpgid(0) == os.getpid())}), flush=True)')
    assert "cannot be read as E57 (True)" in failure(scan_file)
    assert signal.getsignal(signal.SIGINT) is not None
