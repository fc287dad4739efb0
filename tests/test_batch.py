"""A batch: every scan is colorized once, and one scan's fault never affects another."""

import csv
import io
import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import MISSING, fields
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from archives import HEAD, make_archive, outputs_of
from command_line import process_line, run_process
from small_scans import random_scan

from reflcolor_addon import Seeds, Settings, read_scans
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.pairs import COLUMNS, read_pairs, write_pairs
from reflcolor_addon.batch.archive.workers import Workers
from reflcolor_addon.batch.plan import IMAGE, Output, Plan
from reflcolor_addon.batch.plan_document import as_document, from_document
from reflcolor_addon.batch.read import safe_label
from reflcolor_addon.cli.main import main
from reflcolor_addon.errors import OutputError, UsageError
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.readers.options import ReadOptions
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.report.provenance import read_report
from reflcolor_addon.report.verification import WHOLE, verify_outputs
from reflcolor_addon.view.picture import Picture

COUNT, SHAPE = 4, (60, 90)


@pytest.fixture
def archive(tmp_path, monkeypatch):
    """The current folder, with an archive of three scans."""
    monkeypatch.chdir(tmp_path)
    make_archive(tmp_path)
    return tmp_path


@pytest.fixture
def batch(archive, capfd):
    """A function that runs a batch in this process, its workers beside it; returns status, output and errors."""

    def run(*options):
        capfd.readouterr()
        status = main(["batch", "batch.toml", "--jobs", "1", *options])
        said = capfd.readouterr()
        return status, said.out, said.err

    return run


def table(folder):
    with (folder / "colored" / "report.csv").open(encoding="utf-8", newline="") as file:
        return {row["scan"]: row for row in csv.DictReader(file)}


def test_all_scans_are_colorized_and_a_second_run_does_nothing_again(archive, batch):
    status, out, err = batch("--jobs", "2")
    assert (status, err) == (0, "")
    assert "3 done" in out
    for number in range(3):
        report = archive / "colored" / "reports" / f"hall_{number}.json"
        assert {part.state for part in verify_outputs(read_report(report), report)} == {WHOLE}
    times = {path: path.stat().st_mtime_ns for path in (archive / "colored").glob("hall_*")}
    status, out, _ = batch("--resume")
    assert status == 0 and "0 done, 3 done before" in out
    assert times == {path: path.stat().st_mtime_ns for path in (archive / "colored").glob("hall_*")}


def test_what_changed_is_done_again_and_nothing_else(archive, batch):
    batch()
    Seeds([3], [3], [[9, 9, 9]]).save(archive / "hall_1.seeds.json")
    (archive / "colored" / "hall_2.png").write_bytes(b"damaged")
    status, out, _ = batch("--resume")
    assert status == 0 and "2 done, 1 done before" in out
    assert "hall_1: done" in out and "hall_2: done" in out


def test_one_scan_that_fails_costs_no_other(archive, batch):
    (archive / "hall_0.ptx").write_text("no scan\n")
    status, out, err = batch("--keep-going")
    assert status == 1
    assert "2 done, 0 done before, 1 failed" in out
    assert "batch.toml: 1 of 3 failed: hall_0" in err
    rows = table(archive)
    assert [rows[f"hall_{number}"]["state"] for number in range(3)] == ["failed", "done", "done"]
    assert "hall_0.ptx: line 1" in rows["hall_0"]["note"]
    assert "hall_0.ptx: line 1" in (archive / "colored" / "logs" / "hall_0.log").read_text(encoding="utf-8")


def test_without_keep_going_nothing_more_is_begun(archive, batch):
    (archive / "hall_0.ptx").write_text("no scan\n")
    status, out, _ = batch()
    assert status == 1 and "2 not begun" in out
    assert not (archive / "colored" / "hall_1.png").exists()


def test_a_slice_of_the_manifest(archive, batch):
    status, out, _ = batch("--index", "2-3")
    assert status == 0 and "2 done" in out
    assert not (archive / "colored" / "hall_0.png").exists()
    assert batch("--index", "4")[0] == 2


def test_check_alone_touches_nothing(archive, batch):
    status, out, _ = batch("--check")
    assert status == 0 and "3 scans" in out and "memory" in out
    assert not (archive / "colored").exists()


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


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """What a batch makes that nothing happens to."""
    folder = tmp_path_factory.mktemp("undisturbed")
    make_archive(folder, COUNT, SHAPE)
    run_process("batch", "batch.toml", "--jobs", "2", cwd=folder)
    return outputs_of(folder / "colored")


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX systems")
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
    finished = {path.name: path.stat().st_mtime_ns for path in done.glob("*.json")}
    again = run_process("batch", "batch.toml", "--jobs", "2", "--resume", cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    assert f"{COUNT - len(finished)} done, {len(finished)} done before" in again.stdout
    assert finished.items() <= {path.name: path.stat().st_mtime_ns for path in done.glob("*.json")}.items()
    assert not list((tmp_path / "colored").rglob(".reflcolor-*"))

    assert outputs_of(tmp_path / "colored") == undisturbed


def test_workers_end_with_their_parent(archive):
    """A worker whose standard input ends is gone soon, whatever it was doing."""
    line, options = process_line("work")
    with subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, **options) as worker:
        worker.stdin.close()
        assert worker.wait(timeout=60) == 0


def test_an_unwritable_folder_is_named_before_the_work(archive, batch):
    (archive / "colored").write_text("a file")
    status, _, err = batch()
    assert status == 2 and "colored" in err


def test_progress_for_an_engine_of_a_render_farm(archive, batch):
    status, out, _ = batch("--openjd")
    assert status == 0 and "openjd_progress: 100" in out
    (archive / "hall_2.ptx").write_text("no scan\n")
    status, out, _ = batch("--openjd", "--keep-going")
    assert status == 1 and "openjd_fail: batch.toml: 1 of 3 failed: hall_2" in out


def test_the_table_of_pairs_survives_a_spreadsheet(tmp_path):
    path = tmp_path / "pairs.csv"
    write_pairs(path, [("hall, east", "photos/a.png", "yes", "2.10", "straight"), ("b", "p.jpg", "no", "0.1", "")])
    known = {("hall, east", "photos/a.png"): True, ("b", "p.jpg"): False}
    assert read_pairs(path) == known
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    edited = "\r\n".join(";".join(f'"{cell}"' for cell in row) for row in rows)
    path.write_bytes(b"\xef\xbb\xbf" + edited.encode("utf-8"))
    assert read_pairs(path) == known
    path.write_text("scan,photo\na,b\n")
    with pytest.raises(UsageError, match="expected the columns " + ", ".join(COLUMNS[:3])):
        read_pairs(path)


def test_the_report_page_is_one_file_that_tells_of_every_scan(archive, batch):
    (archive / "hall_0.ptx").write_text("no scan\n")
    batch("--keep-going")
    page = (archive / "colored" / "report.html").read_text(encoding="utf-8")
    for name in ("hall_0", "hall_1", "hall_2"):
        assert f'data-value="{name}"' in page
    assert page.count("data:image/jpeg;base64,") == 2
    assert "http://" not in page.replace("http://www.w3.org", "") and "https://" not in page
    before = page
    (archive / "colored" / "report.html").unlink()
    assert main(["report", "colored"]) == 0
    assert (archive / "colored" / "report.html").read_text(encoding="utf-8") == before


def test_a_name_that_is_markup_is_shown_as_text(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = make_archive(tmp_path, count=1)
    text = path.read_text(encoding="utf-8").replace('file = "hall_0.ptx"', 'file = "hall_0.ptx"\nname = "<b>&amp;"')
    path.write_text(text, encoding="utf-8")
    assert main(["batch", "batch.toml", "--jobs", "1"]) == 0
    page = (tmp_path / "colored" / "report.html").read_text(encoding="utf-8")
    assert "<b>" not in page


def test_many_scans_are_told_on_several_pages(archive, batch, monkeypatch):
    batch()
    monkeypatch.setattr("reflcolor_addon.report.archive._SCANS_ON_A_PAGE", 2)
    assert main(["report", "colored"]) == 0
    first, second = (archive / "colored" / name for name in ("report.html", "report 2.html"))
    pages = [path.read_text(encoding="utf-8") for path in (first, second)]
    assert [page.count("<tr data-state") for page in pages] == [2, 1]
    assert all('href="report 2.html"' in page and 'href="report.html"' in page for page in pages)
    assert len(table(archive)) == 3
    monkeypatch.undo()
    monkeypatch.chdir(archive)
    assert main(["report", "colored"]) == 0
    assert not second.exists() and "<nav" not in first.read_text(encoding="utf-8")


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
    from reflcolor_addon.batch.archive.done import Done

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


def test_two_batches_share_the_work(archive, batch):
    line, options = process_line("batch", "batch.toml", "--jobs", "1", "--resume")
    both = [subprocess.Popen(line, cwd=archive, stdout=subprocess.PIPE, **options) for _ in range(2)]
    said = b"".join(process.communicate()[0] for process in both).decode()
    assert [process.returncode for process in both] == [0, 0]
    assert said.count(": done in") == 3
    assert "0 done, 3 done before" in batch("--resume")[1]


def test_reports_of_a_batch_name_their_outputs(archive, batch):
    batch()
    report = json.loads((archive / "colored" / "reports" / "hall_0.json").read_text(encoding="utf-8"))
    assert [Path(output["path"]).name for output in report["outputs"]] == [
        "hall_0.png",
        "hall_0.ply",
        "hall_0.jpg",
        "hall_0.json",
    ]
    assert sys.version.split()[0] == report["versions"]["python"]


def test_a_scan_that_cannot_be_read_fails_also_where_photos_are_looked_for(archive, batch):
    (archive / "hall_0.ptx").write_text("no scan\n")
    write_png(archive / "a.png", np.random.default_rng(0).integers(0, 256, (40, 60, 3)).astype(np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_0.ptx"\nphotos = "a.png"\n', encoding="utf-8")
    status, out, err = batch("--keep-going")
    assert status == 1 and "1 failed: hall_0" in err.replace("1 of 1 failed", "1 failed"), out + err
    assert "hall_0.ptx: line 1" in table(archive)["hall_0"]["note"]


def test_a_scan_that_no_photo_shows_any_more_is_told_so(archive, batch):
    batch()
    folder = BatchFolder(Path("colored"))
    folder.remember("items", "hall_1", {"outcome": "unshown", "error": "", "left_out": ["hall_1"]})
    assert main(["report", "colored"]) == 0
    assert table(archive)["hall_1"]["state"] == "unshown"


def test_a_damaged_report_costs_no_other_its_place_on_the_page(archive, batch):
    batch()
    path = archive / "colored" / "reports" / "hall_1.json"
    report = json.loads(path.read_text(encoding="utf-8"))
    report["settings"] = "none"
    path.write_text(json.dumps(report), encoding="utf-8")
    assert main(["report", "colored"]) == 0
    rows = table(archive)
    assert [rows[f"hall_{number}"]["state"] for number in range(3)] == ["done", "failed", "done"]


def test_seeds_of_each_scan_of_a_file_count_for_what_was_done(archive, batch):
    one, two = (random_scan(number, (12, 16)) for number in range(2))
    write_ptx([one, two], archive / "pair.ptx")
    names = [scan.name for scan in read_scans(archive / "pair.ptx")]
    labels = [f"pair+{safe_label(name)}" for name in names]
    for label in labels:
        Seeds([1], [2], [[200, 80, 40]]).save(archive / f"{label}.seeds.json")
    text = HEAD + '[[scan]]\nfile = "pair.ptx"\nseeds = "{scan}.seeds.json"\n'
    (archive / "batch.toml").write_text(text, encoding="utf-8")
    assert batch()[0] == 0
    assert "0 done, 1 done before" in batch("--resume")[1]
    Seeds([1], [2], [[20, 80, 240]]).save(archive / f"{labels[1]}.seeds.json")
    _, out, err = batch("--resume")
    assert "1 done, 0 done before" in out, err


def test_a_plan_comes_whole_out_of_its_document():
    plan = Plan(
        scans=(Path("a.ptx"), Path("b.ptx")),
        outputs=(Output("write", Path("{scan}.png"), IMAGE),),
        settings=Settings.preset("Natural", alpha=5),
        wanted="2",
        name="hall",
        seeds=Path("s.json"),
        hand=Path("h.json"),
        from_color=7,
        photos=(Path("p.jpg"),),
        colors=Path("c.png"),
        outside_files=True,
        reading=ReadOptions(turn_deg=90, step=2, position=(1.0, 2.0, 3.0)),
        texture=512,
        picture=Picture(look="lit", filled=False),
        left_out=("hall+2",),
        skip_unshown=True,
    )
    assert all(getattr(plan, field.name) != field.default for field in fields(plan) if field.default is not MISSING)
    assert from_document(json.loads(json.dumps(as_document(plan)))) == plan


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
