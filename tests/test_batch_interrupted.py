"""A batch that is ended, whose workers are killed, whose folder goes, or which meets another batch."""

import csv
import io
import json
import os
import signal
import subprocess
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from archives import HEAD, damage_points, make_archive, outputs_of, table_of
from command_line import process_line, run_process

from reflcolor_addon.batch.archive import color_stage
from reflcolor_addon.batch.archive.done import Done
from reflcolor_addon.batch.archive.fingerprints import Fingerprints
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.registrations import Registrations
from reflcolor_addon.batch.archive.workers import Workers
from reflcolor_addon.cli.interruption import Interruption
from reflcolor_addon.errors import OutputError
from reflcolor_addon.files.images import write_png

COUNT, SHAPE = 4, (60, 90)


def test_two_batches_on_one_folder_leave_each_other_alone(archive, batch):
    folder = BatchFolder(Path("colored"))
    folder.make()
    with folder.claimed("hall_1") as mine:
        assert mine
        # A lock belongs to a process: the other batch is one of its own.
        done = run_process("batch", "batch.toml", "--jobs", "1", cwd=archive)
    assert done.returncode == 0
    assert "hall_1" in done.stderr and "another batch" in done.stderr
    assert not (archive / "colored" / "hall_1.png").exists()
    assert (archive / "colored" / "hall_2.png").exists()


def test_two_batches_share_the_work(archive, batch):
    line, options = process_line("batch", "batch.toml", "--jobs", "1", "--resume")
    both = [subprocess.Popen(line, cwd=archive, stdout=subprocess.PIPE, **options) for _ in range(2)]
    said = b"".join(process.communicate()[0] for process in both).decode()
    assert [process.returncode for process in both] == [0, 0]
    assert said.count(": done in") == 3
    assert "0 done, 3 done before" in batch("--resume")[1]


def test_a_worker_that_is_killed_is_replaced(archive, batch, monkeypatch):
    from reflcolor_addon.batch.archive import workers

    killed, give = [], workers.Workers._give

    def give_and_kill(self, worker, task):
        give(self, worker, task)
        if task.name == "hall_1" and not killed:
            killed.append(worker.process.pid)
            worker.process.kill()

    monkeypatch.setattr(workers.Workers, "_give", give_and_kill)
    monkeypatch.setattr("reflcolor_addon.batch.archive.options.Options.wait_s", 0.0)
    status, out, _ = batch()
    assert killed and status == 0
    assert "hall_1: its process ended (SIGKILL); trying again" in out
    assert "3 done" in out


class _Worker:
    """What `Workers` sees of a process."""

    def __init__(self, in_blender):
        self.in_blender, self.task = in_blender, None
        self.process = SimpleNamespace(stdin=io.StringIO())


def test_a_worker_that_was_sent_home_gets_no_work(monkeypatch):
    pool = Workers(count=2, threads=1, memory=0, blender=("blender",), cancelled=lambda: False)
    pool._processes = [_Worker(False), _Worker(False)]

    def started(in_blender):
        pool._processes.append(_Worker(in_blender))
        return pool._processes[-1]

    monkeypatch.setattr(pool, "_started", started)
    first = pool._idle(True)
    first.task = "a scene"
    assert pool._processes[0].process.stdin.closed
    assert pool._idle(False) is pool._processes[1]
    pool._processes[1].task = "an image"
    # Two are at work, and the third is about to end.
    assert [worker.process.stdin.closed for worker in pool._processes] == [True, False, False]


def test_workers_end_with_their_parent(archive):
    """A worker whose standard input ends is gone soon, whatever it was doing."""
    line, options = process_line("work")
    with subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, **options) as worker:
        worker.stdin.close()
        assert worker.wait(timeout=60) == 0


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """What a batch makes that nothing happens to."""
    folder = tmp_path_factory.mktemp("undisturbed")
    make_archive(folder, COUNT, SHAPE)
    run_process("batch", "batch.toml", "--jobs", "2", cwd=folder)
    return outputs_of(folder / "colored")


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="Windows does not end a process with SIGTERM or SIGKILL")
@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGKILL])
def test_a_batch_that_is_ended_goes_on_where_it_was(tmp_path, monkeypatch, undisturbed, stop):
    monkeypatch.chdir(tmp_path)
    make_archive(tmp_path, COUNT, SHAPE)
    line, options = process_line("batch", "batch.toml", "--jobs", "2", "--resume")
    process = subprocess.Popen(line, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    done = tmp_path / "colored" / "batch-state" / "done"
    while process.poll() is None and not (done.is_dir() and any(done.iterdir())):
        time.sleep(0.02)
    process.send_signal(stop)
    process.communicate(timeout=60)
    if stop == signal.SIGTERM:
        assert process.returncode == 143
        assert (tmp_path / "colored" / "report.html").is_file()
    finished = {path.name: path.stat().st_mtime_ns for path in done.glob("*.json")}
    again = run_process("batch", "batch.toml", "--jobs", "2", "--resume", cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    assert f"{COUNT - len(finished)} done, {len(finished)} done before" in again.stdout
    assert finished.items() <= {path.name: path.stat().st_mtime_ns for path in done.glob("*.json")}.items()
    assert not list((tmp_path / "colored").rglob(".reflcolor-*"))

    assert outputs_of(tmp_path / "colored") == undisturbed


def test_an_interrupted_batch_reports_what_is_done_and_how_to_go_on(archive, batch, monkeypatch):
    for name in ("a.png", "b.png"):
        write_png(archive / name, np.full((40, 60, 3), 90 if name == "a.png" else 120, np.uint8))
    text = HEAD + 'scans = "hall_[01].ptx"\nphotos = ["a.png", "b.png"]\n[[scan]]\nfile = "hall_2.ptx"\n'
    (archive / "batch.toml").write_text(text + 'seeds = "hall_2.seeds.json"\n', encoding="utf-8")
    requested, record = [], Done.record

    def record_and_interrupt(*arguments):
        record(*arguments)
        requested.append(True)

    monkeypatch.setattr(Done, "record", record_and_interrupt)
    monkeypatch.setattr(Interruption, "requested", lambda self: bool(requested))
    status, out, err = batch()
    assert status == 130 and "hall_0: none of 2 photos" in out
    assert err.splitlines() == ["error: batch.toml: interrupted; to go on, run the same command with --resume"]
    with (archive / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = [(row["scan"], row["photo"], row["shows"]) for row in csv.DictReader(file)]
    # All were matched before the first was colorized.
    pairs = [(name, photo) for name in ("hall_0", "hall_1") for photo in ("a.png", "b.png")]
    assert rows == [(*pair, "cannot be tested") for pair in pairs]
    states = {name: row["state"] for name, row in table_of(archive).items()}
    assert states == {"hall_0": "unshown", "hall_1": "open", "hall_2": "open"}
    monkeypatch.undo()
    monkeypatch.chdir(archive)
    status, out, _ = batch("--resume")
    assert status == 0 and "1 done, 0 done before, 0 failed, 2 without a certain photo, 0 not begun" in out


def test_an_unwritable_folder_is_named_before_the_work(archive, batch):
    (archive / "colored").write_text("a file")
    status, _, err = batch()
    assert status == 2 and "colored" in err


def test_a_folder_that_vanishes_ends_the_batch_in_one_line(archive, batch, monkeypatch):
    from reflcolor_addon.batch.archive import stage

    kept = stage._kept

    def kept_and_gone(*arguments):
        outcome = kept(*arguments)
        (archive / "colored").rename(archive / "away")
        return outcome

    monkeypatch.setattr(stage, "_kept", kept_and_gone)
    status, _, err = batch("--keep-going")
    assert status == 1 and err.count("error:") == 1
    assert "colored: the output folder is gone; bring it back, and run the batch again with --resume" in err
    (archive / "away").rename(archive / "colored")
    monkeypatch.undo()
    monkeypatch.chdir(archive)
    status, out, _ = batch("--resume")
    assert status == 0 and "2 done, 1 done before" in out


def test_a_record_that_cannot_be_kept_costs_one_scan_and_no_other(archive, batch, monkeypatch):
    record = Done.record

    def full(self, name, *arguments):
        if name == "hall_1":
            raise OutputError("{file}: cannot be written (No space left on device)", file="done")
        record(self, name, *arguments)

    monkeypatch.setattr(Done, "record", full)
    status, out, err = batch("--keep-going")
    assert status == 1 and "2 done, 0 done before, 1 failed" in out
    assert "hall_1: failed: done: cannot be written (No space left on device)" in out and "hall_1" in err
    monkeypatch.undo()
    monkeypatch.chdir(archive)
    assert "1 done, 2 done before" in batch("--resume")[1]


def test_a_full_disk_is_told_by_what_failed_and_what_to_do_not_by_the_table_of_pairs(archive, batch, monkeypatch):
    def full(*_):
        raise OutputError("{file}: cannot be written (No space left on device)", file="pairs.csv")

    damage_points(archive / "hall_1.ptx")
    monkeypatch.setattr(color_stage, "write_table", full)
    status, out, err = batch("--keep-going")
    assert status == 1 and "hall_1: failed: hall_1.ptx: line 11" in out
    table, told = err.splitlines()
    assert table == "error: pairs.csv: cannot be written (No space left on device)"
    assert told.startswith("error: batch.toml: 1 of 3 failed: hall_1; ")
    assert told.endswith("run the batch again with --resume")


def test_a_result_that_is_gone_before_it_is_recorded_costs_one_scan_and_no_other(archive, batch, monkeypatch):
    record = Done.record

    def record_without_its_output(self, name, stage, key, outcome):
        if name == "hall_1":
            Path(outcome["written"][0]).unlink()
        record(self, name, stage, key, outcome)

    monkeypatch.setattr(Done, "record", record_without_its_output)
    status, out, err = batch("--keep-going")
    assert status == 1 and "2 done" in out and "1 failed" in out
    assert "hall_1" in err and "Traceback" not in err


def test_batches_on_one_folder_keep_each_others_hashes(tmp_path):
    folder = BatchFolder(tmp_path)
    folder.make()
    for name in "abc":
        (tmp_path / name).write_text(name)
    first, second = Fingerprints(folder), Fingerprints(folder)
    for hashes, name in ((first, "a"), (second, "b"), (first, "c")):
        hashes.of(tmp_path / name)
        hashes.save()
    kept = json.loads(folder.state("hashes.json").read_text(encoding="utf-8"))
    assert sorted(Path(path).name for path in kept) == ["a", "b", "c"]


def test_files_that_cannot_be_hashed_share_no_registration(tmp_path):
    folder = BatchFolder(tmp_path)
    folder.make()
    known = Registrations(folder, {"a.ptx": "1", "one.jpg": "", "two.jpg": ""})
    job = SimpleNamespace(path=Path("a.ptx"), index=1)
    assert [known(job, photo, lambda photo=photo: photo) for photo in ("one.jpg", "two.jpg")] == ["one.jpg", "two.jpg"]
    assert not list(tmp_path.glob("**/*.json"))


def test_nothing_is_known_of_work_on_files_that_cannot_be_hashed(tmp_path):
    folder = BatchFolder(tmp_path)
    folder.make()
    done = Done(folder, None)
    done.record("hall", "color", done.key("color", None, {"a.ptx": ""}), {"written": []})
    assert done.recall("hall", "color") is not None
    assert done.recall("hall", "color", done.key("color", None, {"a.ptx": ""})) is None


def test_a_record_that_cannot_be_moved_is_invalid_all_the_same(tmp_path, monkeypatch):
    folder = BatchFolder(tmp_path)
    folder.make()
    done = Done(folder, None)
    done.record("hall", "color", "key", {"written": []})
    monkeypatch.setattr(Path, "replace", lambda *_: (_ for _ in ()).throw(OSError(28, "full")))
    done.begin("hall", "color")
    assert done.recall("hall", "color") is None


def test_outputs_of_an_earlier_run_are_known_until_the_work_ends(tmp_path):
    folder = BatchFolder(tmp_path)
    folder.make()
    (tmp_path / "hall.png").write_bytes(b"colored")
    done = Done(folder, Fingerprints(folder))
    done.record("hall", "color", "key", {"written": [str(tmp_path / "hall.png")]})
    for _ in range(2):
        done.begin("hall", "color")
        assert done.recall("hall", "color") is None
        assert list(done.outputs("hall", "color")) == [str(tmp_path / "hall.png")]
    done.record("hall", "color", "key", {"written": []})
    assert list(done.outputs("hall", "color")) == [str(tmp_path / "hall.png")]
    done.end("hall", "color")
    assert not done.outputs("hall", "color")
