"""No file that is read opens a socket, in this process or in a child: under a library that notes and refuses it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
READ = """
import sys, tempfile
from pathlib import Path
from fuzz.trial import Trials
from reflcolor_addon import ScanError, read_scans
with tempfile.TemporaryDirectory() as folder:
    trials = Trials(Path(folder), seed=4)
    for kind, samples in trials.samples.items():
        for sample in samples:
            path = trials.folder / sample.name
            path.write_bytes(sample.data)
            try:
                sample.read(path)
            except ValueError:
                pass
        for number in range(5):
            trials.run(kind, number)
for path in sys.argv[1:]:
    try:
        read_scans(path)
    except ScanError:
        pass
"""


@pytest.fixture(scope="module")
def watched(tmp_path_factory):
    """A function that runs Python under the library and returns the calls that were refused."""
    compiler = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
    if not sys.platform.startswith("linux") or compiler is None:
        pytest.skip("needs Linux and a C compiler")
    folder = tmp_path_factory.mktemp("watched")
    source = ROOT / "tests" / "refuse_sockets.c"
    subprocess.run([compiler, "-shared", "-fPIC", "-o", folder / "refuse.so", source], check=True)

    def run(code, *arguments):
        log = folder / "log"
        log.write_text("")
        env = os.environ | {"LD_PRELOAD": str(folder / "refuse.so"), "REFLCOLOR_SOCKETS": str(log)}
        del env["PYTEST_CURRENT_TEST"]
        env["PYTHONPATH"] = os.pathsep.join((str(ROOT / "tests"), str(ROOT)))
        subprocess.run([sys.executable, "-c", code, *arguments], env=env, check=True, timeout=300)
        return log.read_text().split()

    return run


def test_the_library_sees_sockets_here_and_in_a_child(watched):
    code = "import socket\ntry: socket.socket()\nexcept PermissionError: pass\n"
    assert watched(code) == ["socket"]
    assert watched(f"import subprocess, sys; subprocess.run([sys.executable, '-I', '-c', {code!r}])") == ["socket"]


@pytest.mark.slow
def test_no_file_that_is_read_opens_a_socket(watched):
    data = Path(os.environ.get("REFLCOLOR_DATA") or ROOT.parent / "shared" / "data")
    named = sorted(str(path) for folder in ("robust/e57", "robust/ptx", "cases") for path in (data / folder).glob("*"))
    assert watched(READ, *named) == []
