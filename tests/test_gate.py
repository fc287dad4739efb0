"""Anything but an ordinary file is refused at once, and side files may only name files in their own folder."""

import json
import os
import signal
import socket
import stat
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import COLORIZE, assert_refused, save_seeds
from small_scans import random_scan

from reflcolor_addon.errors import Cancelled, ReflcolorError, ScanError, SeedsError
from reflcolor_addon.files.gate import beside, contents, opened
from reflcolor_addon.files.images import read_image, write_png
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.writers import write_image_pair
from reflcolor_addon.report.report import fingerprint
from reflcolor_addon.seeds.seeds import Seeds

pytestmark = pytest.mark.skipif(os.name == "nt", reason="pipes, devices and links of POSIX")


def pipe(path):
    os.mkfifo(path)


def device(path):
    path.symlink_to("/dev/zero")


def listening(path):
    if sys.platform.startswith("linux"):
        # As binding a socket does it; opening one would be noted by make test-no-network.
        os.mknod(path, stat.S_IFSOCK | 0o600)
        return
    with socket.socket(socket.AF_UNIX) as end:
        end.bind(str(path))


def process_memory(path):
    path.symlink_to("/proc/self/mem")


def process_state(path):
    path.symlink_to("/proc/self/status")


def directory(path):
    path.mkdir()


def itself(path):
    path.symlink_to(path)


KINDS = {
    pipe: "is a pipe",
    device: "is a device",
    listening: "is a socket",
    process_memory: "is empty",
    process_state: "is empty",
    directory: "is a directory",
    itself: "cannot be read",
}


@pytest.fixture(autouse=True)
def at_once():
    """Nothing may wait for what never comes."""

    def late(*_):
        raise TimeoutError

    previous = signal.signal(signal.SIGALRM, late)
    signal.alarm(20)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, previous)


@pytest.mark.parametrize(("kind", "said"), KINDS.items(), ids=lambda value: getattr(value, "__name__", ""))
@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        *((f"named.{suffix}", ("info", f"named.{suffix}")) for suffix in ("ptx", "e57", "scan.json")),
        ("named.json", ("colorize", "garage.ptx", "--seeds", "named.json", "-o", "out.png")),
        ("named.png", (*COLORIZE, "--photo", "named.png", "-o", "out.png")),
        ("named.png", ("seeds", "garage.ptx", "--photo", "named.png", "-o", "out.json")),
        ("named.png", ("evaluate", "garage.ptx", "named.png", "--truth", "named.png")),
        ("named.json", ("verify", "named.json")),
        ("pair.range.png", ("info", "pair.scan.json")),
        ("view.png", ("colorize", "garage.ptx", "--seeds", "photo.json", "-o", "out.png")),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_what_is_no_ordinary_file_is_refused_at_once(run_cli, cli_folder, kind, said, name, arguments):
    write_image_pair(random_scan(shape=(6, 10)), cli_folder / "pair.scan.json")
    save_seeds(cli_folder, {"row": 1, "col": 1, "photo": "view.png", "x": 1, "y": 1})
    (cli_folder / "seeds.json").rename(cli_folder / "photo.json")
    save_seeds(cli_folder, {"row": 1, "col": 1, "rgb": [1, 2, 3]})
    (cli_folder / name).unlink(missing_ok=True)
    kind(cli_folder / name)
    status, out, err = run_cli(*arguments)
    assert_refused((status, out, err), 1, name)
    # What is only named by a side file must be a file, and lie beside that: a link to a device is neither.
    assert any(part in err for part in (said, "was not given and is not beside", "lies outside of the folder"))
    assert not (cli_folder / "out.png").exists()


def test_a_pipe_that_came_while_it_was_looked_at_is_refused_too(tmp_path, monkeypatch):
    path = tmp_path / "a.ptx"
    path.write_text("1")
    stat = Path.stat

    def looked_at(self, **options):
        found = stat(self, **options)
        if self == path:
            path.unlink()
            os.mkfifo(path)
        return found

    monkeypatch.setattr(Path, "stat", looked_at)
    with pytest.raises(ReflcolorError, match="is a pipe"), opened(path, "a scan"):
        pass


def test_a_file_that_is_too_large_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "large.json"
    with path.open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(SeedsError, match=r"large\.json: has 1 TB, expected a JSON file of seeds of at most 256 MB"):
        Seeds.load(path)
    with pytest.raises(ReflcolorError, match="has 1 TB"):
        read_image(path)


def test_reading_is_cancelled_between_its_parts_and_takes_what_was_there(tmp_path, monkeypatch):
    path = tmp_path / "a.bin"
    path.write_bytes(bytes(range(100)))
    monkeypatch.setattr("reflcolor_addon.files.gate._CHUNK", 10)
    answers = iter([False, False, True])
    with pytest.raises(Cancelled):
        contents(path, "numbers", cancelled=lambda: next(answers))

    def growing():
        with path.open("ab") as file:
            file.write(b"more")

    assert contents(path, "numbers", cancelled=growing) == bytes(range(100))


def test_a_hash_takes_no_longer_than_the_file_was(tmp_path, monkeypatch):
    path = tmp_path / "a.bin"
    path.write_bytes(b"abc")
    assert fingerprint(path)["bytes"] == 3
    (tmp_path / "endless").symlink_to("/dev/zero")
    with pytest.raises(ReflcolorError, match="is a device"):
        fingerprint(tmp_path / "endless")


# What a side file may name


@pytest.mark.parametrize(
    ("name", "allowed"),
    [
        ("a.png", True),
        ("below/a.png", True),
        ("./a.png", True),
        ("..a.png", True),
        ("/etc/passwd", False),
        ("../a.png", False),
        ("below/../../a.png", False),
        ("below\\..\\..\\a.png", False),
        ("C:\\a.png", False),
        ("C:a.png", False),
        ("\\\\host\\share\\a.png", False),
        ("//host/share/a.png", False),
        ("out/a.png", False),
        ("within/a.png", True),
    ],
)
def test_a_side_file_names_what_lies_in_its_folder_or_below(tmp_path, name, allowed):
    folder = tmp_path / "folder"
    (folder / "below").mkdir(parents=True)
    (folder / "out").symlink_to(tmp_path)
    (folder / "within").symlink_to(folder / "below")
    found = beside(folder / "a.scan.json", name)
    assert found == (folder / name if allowed else None)
    assert beside(folder / "a.scan.json", name, outside=True) == folder / name


@pytest.mark.parametrize("key", ["range", "reflectance", "color"])
def test_images_outside_of_the_folder_are_opened_only_where_that_is_asked_for(tmp_path, key):
    folder = tmp_path / "sent"
    folder.mkdir()
    path = folder / "a.scan.json"
    scan = random_scan(shape=(6, 10))
    write_image_pair(type(scan)(**{**vars(scan), "color": np.full((6, 10, 3), (9, 8, 7), np.uint8)}), path)
    description = json.loads(path.read_text())
    (folder / description[key]).rename(tmp_path / "own.png")
    path.write_text(json.dumps({**description, key: "../own.png"}))
    with pytest.raises(ScanError, match=rf"^a\.scan\.json: {key}: \.\./own\.png lies outside of the folder"):
        read_scans(path)
    assert read_scans(path, outside=True)[0].shape == (6, 10)


def test_seeds_open_no_photo_outside_of_their_folder_unless_it_is_given(tmp_path):
    folder = tmp_path / "sent"
    folder.mkdir()
    write_png(tmp_path / "own.png", np.full((4, 4, 3), 90, np.uint8))
    save_seeds(folder, {"row": 0, "col": 0, "photo": "../own.png", "x": 1, "y": 1})
    with pytest.raises(SeedsError, match="was not given and is not beside"):
        Seeds.load(folder / "seeds.json")
    assert Seeds.load(folder / "seeds.json", [tmp_path / "own.png"]).rgb.tolist() == [[90, 90, 90]]


def test_outside_files_are_allowed_on_the_command_line(run_cli, cli_folder):
    sent = cli_folder / "sent"
    sent.mkdir()
    write_image_pair(random_scan(shape=(6, 10)), sent / "a.scan.json")
    description = json.loads((sent / "a.scan.json").read_text())
    (sent / description["range"]).rename(cli_folder / "own.png")
    (sent / "a.scan.json").write_text(json.dumps({**description, "range": "../own.png"}))
    for arguments in (("info",), ("colorize", "--seeds", "seeds.json", "-o", "out.png")):
        given = (arguments[0], "sent/a.scan.json", *arguments[1:])
        assert_refused(run_cli(*given), 1, "../own.png lies outside of the folder of a.scan.json")
        assert run_cli(*given, "--outside-files")[0] == 0
