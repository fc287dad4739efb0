"""Work in a thread of its own, and what it found, written piece by piece in the window."""

import importlib
from types import SimpleNamespace

import pytest
from blender_session import EXTENSION
from small_scans import random_scan
from test_blender_import import write_small_ptx


@pytest.fixture
def seeded(blender, tmp_path):
    """bpy with a scan and a seed on it."""
    blender.ops.reflcolor.import_scan(filepath=str(write_small_ptx(tmp_path / "wall.ptx", random_scan(3))))
    blender.ops.reflcolor.add_seed(row=1, col=3, color=(0.8, 0.3, 0.2))
    return blender


def test_work_in_a_thread_begins_at_its_first_turn_and_can_be_given_up_before(installed_blender):
    jobs = importlib.import_module(f"{EXTENSION}.operators.window.jobs")
    begun = []
    job, other = (jobs.ThreadJob("Work", lambda progress, cancelled: begun.append(1) or 7) for _ in range(2))
    other.cancel(wait=True)
    assert job.alive and not begun and other.stopping
    job.advance()
    job.cancel(wait=True)
    assert (job.alive, job.result, begun) == (False, 7, [1])


@pytest.mark.parametrize(("undone", "outcome"), [(True, {"CANCELLED"}), (False, {"FINISHED"})])
def test_a_result_that_cannot_be_written_to_its_end_says_so(seeded, monkeypatch, capfd, undone, outcome):
    jobs = importlib.import_module(f"{EXTENSION}.operators.window.jobs")
    ended = []

    def removed_meanwhile():
        yield
        raise ReferenceError("StructRNA of type Object has been removed")

    def written_in_the_window(operator, context):
        operator._job, operator._writing = SimpleNamespace(overtaken=undone), removed_meanwhile()
        return operator._write(context)

    monkeypatch.setattr(jobs.JobOperator, "_end", lambda operator, context: ended.append(True))
    monkeypatch.setattr(jobs.JobOperator, "run_blocking", written_in_the_window)
    assert seeded.ops.reflcolor.colorize() == outcome and ended == [True]
    said = "Warning: Colorize: not all was written, because a scan was undone or removed meanwhile"
    assert said in capfd.readouterr().out
