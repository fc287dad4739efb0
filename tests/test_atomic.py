"""Outputs are whole or not there, what was there before survives, and nothing is left lying around."""

import os
import signal
import stat
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from reflcolor_addon.errors import OutputError
from reflcolor_addon.files import work_folder
from reflcolor_addon.files.atomic import require_writable, written_atomically

ROOT = Path(__file__).resolve().parent.parent
POSIX = pytest.mark.skipif(os.name == "nt", reason="Windows has other permissions and links")


def write(path, text="new"):
    with written_atomically(path) as temporary:
        temporary.write_text(text)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def refusal(act, *arguments):
    with pytest.raises(OutputError) as caught:
        act(*arguments)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_what_is_written_takes_the_old_ones_place(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    write(path)
    assert path.read_text() == "new"
    assert names(tmp_path) == ["a.txt"]


def test_a_writer_that_fails_changes_nothing(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError), written_atomically(path) as temporary:
        temporary.write_text("half")
        raise ZeroDivisionError
    assert path.read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("written", [None, b"", b'{"format": "ref'])
def test_a_writer_that_leaves_no_whole_file_changes_nothing(tmp_path, written):
    path = tmp_path / "a.json"
    path.write_text("{}")

    def stump():
        with written_atomically(path) as temporary:
            if written is not None:
                temporary.write_bytes(written)

    assert "a.json: was not written completely (" in refusal(stump)
    assert path.read_text() == "{}"
    assert names(tmp_path) == ["a.json"]


@POSIX
@pytest.mark.parametrize("mode", [0o600, 0o640, 0o666])
def test_an_existing_file_keeps_its_permissions(tmp_path, mode):
    path = tmp_path / "a.txt"
    path.write_text("old")
    path.chmod(mode)
    write(path)
    assert stat.S_IMODE(path.stat().st_mode) == mode


@POSIX
def test_a_new_file_has_the_permissions_of_any_new_file(tmp_path):
    (tmp_path / "other").touch()
    write(tmp_path / "a.txt")
    assert (tmp_path / "a.txt").stat().st_mode == (tmp_path / "other").stat().st_mode


@POSIX
@pytest.mark.parametrize("there", [True, False])
def test_a_link_is_followed(tmp_path, there):
    (tmp_path / "far").mkdir()
    (tmp_path / "near").mkdir()
    real, link = tmp_path / "far" / "real.txt", tmp_path / "near" / "a.txt"
    if there:
        real.write_text("old")
    link.symlink_to("../far/real.txt")
    write(link)
    assert link.is_symlink()
    assert real.read_text() == "new"
    assert (names(tmp_path / "far"), names(tmp_path / "near")) == (["real.txt"], ["a.txt"])


@POSIX
def test_a_file_with_several_names_keeps_them(tmp_path):
    path, other = tmp_path / "a.txt", tmp_path / "b.txt"
    path.write_text("old and longer than the new one")
    other.hardlink_to(path)
    write(path)
    assert (path.read_text(), other.read_text()) == ("new", "new")
    assert path.samefile(other)
    assert names(tmp_path) == ["a.txt", "b.txt"]


@POSIX
def test_a_file_with_several_names_keeps_its_contents_where_the_disk_is_full(tmp_path, monkeypatch):
    path, other = tmp_path / "a.txt", tmp_path / "b.txt"
    path.write_text("old")
    other.hardlink_to(path)
    fallocate = os.posix_fallocate

    def full(number, offset, size):
        if size > 3:
            os.write(number, b"torn")
            raise OSError(28, "No space left on device")
        fallocate(number, offset, size)

    monkeypatch.setattr(os, "posix_fallocate", full)
    assert "No space left" in refusal(write, path, "new and longer")
    assert (path.read_text(), other.read_text()) == ("old", "old")
    assert names(tmp_path) == ["a.txt", "b.txt"]


@POSIX
def test_devices_and_write_protected_files_are_refused(tmp_path, monkeypatch):
    os.mkfifo(tmp_path / "pipe.txt")
    for act in (write, require_writable):
        assert "is not an ordinary file" in refusal(act, tmp_path / "pipe.txt")
        assert "is a directory" in refusal(act, tmp_path)
        assert "null" in refusal(act, Path("a\0.txt"))
    (tmp_path / "a.txt").write_text("old")
    monkeypatch.setattr(os, "access", lambda *_: False)
    for act in (write, require_writable):
        assert "exists and is write-protected" in refusal(act, tmp_path / "a.txt")
    assert (tmp_path / "a.txt").read_text() == "old"


def test_a_folder_that_vanishes_meanwhile_is_told(tmp_path):
    folder = tmp_path / "gone"
    folder.mkdir()

    def vanish():
        with written_atomically(folder / "a.txt") as temporary:
            temporary.parent.rename(tmp_path / "moved")
            folder.rmdir()
            temporary.write_text("new")

    assert "cannot be written (No such file or directory)" in refusal(vanish)


@POSIX
def test_the_file_is_on_the_disk_before_it_takes_the_old_ones_place_and_its_name_after_that(tmp_path, monkeypatch):
    path, steps = tmp_path / "a.txt", []
    replace = Path.replace

    def flushed(number):
        steps.append("folder" if stat.S_ISDIR(os.fstat(number).st_mode) else "file")

    def replaced(source, target):
        steps.append("name")
        return replace(source, target)

    monkeypatch.setattr(os, "fsync", flushed)
    monkeypatch.setattr(Path, "replace", replaced)
    write(path)
    assert steps == ["file", "name", "folder"]


# Killed runs

WRITING = """
import sys, time
from pathlib import Path
from reflcolor_addon.files.atomic import written_atomically
with written_atomically(Path(sys.argv[1])) as temporary:
    temporary.write_text("half")
    print("writing", flush=True)
    time.sleep(60)
"""


def started(script, *arguments):
    process = subprocess.Popen([sys.executable, "-c", script, *arguments], cwd=ROOT, stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"writing\n"
    return process


def killed(process):
    process.kill()
    process.communicate()


@pytest.fixture
def another_run():
    """As if the process had not yet written anywhere."""
    work_folder._cleaned.clear()


def test_the_next_run_cleans_what_a_killed_one_left_and_nothing_else(tmp_path, another_run):
    dead, alive = started(WRITING, tmp_path / "a.txt"), started(WRITING, tmp_path / "b.txt")
    try:
        killed(dead)
        (tmp_path / ".reflcolor-empty").mkdir()
        (tmp_path / ".reflcolor-strange").mkdir()
        (tmp_path / ".reflcolor-strange" / "thing").touch()
        assert len(names(tmp_path)) == 4
        write(tmp_path / "a.txt")
        left = [name for name in names(tmp_path) if name.startswith(".reflcolor-")]
        assert ".reflcolor-strange" in left
        assert len(left) == 2
        assert [path.name for path in tmp_path.glob(".reflcolor-*/b.txt")] == ["b.txt"]
    finally:
        killed(alive)


def test_the_next_run_cleans_the_temporary_folder_of_a_killed_one(tmp_path, another_run, monkeypatch):
    script = """
import time
from reflcolor_addon.files.work_folder import scratch_folder
with scratch_folder() as folder:
    (folder / "mesh.npy").write_bytes(b"x" * 1000)
    print("writing", flush=True)
    time.sleep(60)
"""
    for name in ("TMPDIR", "TEMP", "TMP"):
        monkeypatch.setenv(name, str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", None)
    dead, alive = started(script), started(script)
    try:
        killed(dead)
        with work_folder.scratch_folder() as folder:
            assert folder.parent == tmp_path
            assert len(names(tmp_path)) == 2
    finally:
        killed(alive)


@POSIX
def test_a_folder_that_a_stranger_made_changes_no_file(tmp_path, another_run):
    secret, target = tmp_path / "secret", tmp_path / "a.txt"
    secret.write_text("secret")
    target.write_text("mine")
    folder = tmp_path / ".reflcolor-sent"
    folder.mkdir()
    (folder / ".reflcolor-owner").touch()
    (folder / ".reflcolor-name").write_text(f"{target.stat().st_ino}\na.txt")
    (folder / ".reflcolor-before").symlink_to(secret)
    write(tmp_path / "b.txt")
    assert target.read_text() == "mine"
    assert not folder.exists()


@POSIX
def test_a_file_with_several_names_is_put_back_by_the_next_run_after_a_kill(tmp_path, another_run):
    path, other = tmp_path / "a.txt", tmp_path / "b.txt"
    path.write_text("the old contents")
    other.hardlink_to(path)
    script = WRITING.replace("from pathlib", "import shutil\nfrom pathlib").replace(
        'print("writing", flush=True)\n    time.sleep(60)',
        "pass\n    copy = shutil.copyfileobj\n"
        "    def torn(source, target, size):\n"
        "        if target.name == sys.argv[1]:\n"
        '            target.write(b"to"); target.flush()\n'
        '            print("writing", flush=True); time.sleep(60)\n'
        "        copy(source, target, size)\n"
        "    shutil.copyfileobj = torn",
    )
    killed(started(script, path))
    assert path.read_text().startswith("to")
    write(tmp_path / "c.txt")
    assert (path.read_text(), other.read_text()) == ("the old contents", "the old contents")
    assert names(tmp_path) == ["a.txt", "b.txt", "c.txt"]


@POSIX
def test_two_processes_on_one_output_leave_one_of_the_two_whole(tmp_path):
    script = """
import sys
from pathlib import Path
from reflcolor_addon.files.atomic import written_atomically
print("writing", flush=True)
for _ in range(20):
    for name in sys.argv[2:]:
        with written_atomically(Path(name)) as temporary:
            temporary.write_text(sys.argv[1] * 200_000)
"""
    plain, linked = tmp_path / "a.txt", tmp_path / "b.txt"
    for path in (plain, linked):
        path.write_text("c" * 200_000)
    (tmp_path / "c.txt").hardlink_to(linked)
    processes = [started(script, letter, plain, linked) for letter in "ab"]
    while any(process.poll() is None for process in processes):
        assert len(set(plain.read_text())) == 1
    for process in processes:
        process.communicate()
        assert process.returncode == 0
    for path in (plain, linked):
        assert path.read_text() in ("a" * 200_000, "b" * 200_000)
    assert names(tmp_path) == ["a.txt", "b.txt", "c.txt"]


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="Windows cannot kill a process with SIGKILL")
def test_killed_at_any_moment_the_old_or_the_new_file_is_there_whole(tmp_path, another_run):
    script = """
import sys
from pathlib import Path
from reflcolor_addon.files.atomic import written_atomically
print("writing", flush=True)
for number in range(10**6):
    with written_atomically(Path(sys.argv[1])) as temporary:
        temporary.write_text(str(number % 10) * 50_000)
"""
    path = tmp_path / "a.txt"
    write(path, "0" * 50_000)
    process = started(script, path)
    time.sleep(0.05)
    killed(process)
    text = path.read_text()
    assert (len(text), len(set(text))) == (50_000, 1)
    work_folder._cleaned.clear()
    write(path)
    assert names(tmp_path) == ["a.txt"]
