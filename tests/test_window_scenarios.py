"""A window scenario passes only if it ran to its end, checked something and left no error in Blender's log."""

import json

import pytest
import window_blender
from window_blender import BlenderMissing, Ended, find_blender, run
from window_scenarios import ROOT, read_outcomes, scenario_files

GOOD = {"problem": "", "checks": 3, "expected_errors": [], "pictures": []}


def outcome_of(tmp_path, told, log="", ended=None):
    """The outcome of one scenario, from what Blender would have written."""
    events = [{"event": "begin", "name": "scenario_a"}]
    if told is not None:
        events.append({"event": "end", "name": "scenario_a"} | told)
    (tmp_path / "results").write_text("".join(json.dumps(event) + "\n" for event in events))
    (tmp_path / "log").write_text(f"window-test: begin scenario_a\n{log}")
    outcome = read_outcomes(["scenario_a"], tmp_path / "results", tmp_path / "log")["scenario_a"]
    outcome.ended, outcome.log_path, outcome.last = ended or Ended(0), ROOT / "log", True
    return outcome


def test_a_scenario_that_ran_and_checked_passes(tmp_path):
    assert outcome_of(tmp_path, GOOD, "Info: Imported cones\nWarning: seed 3: moved\n").fault() == ""


@pytest.mark.parametrize(
    ("told", "log", "ended", "fault"),
    [
        (None, "", Ended(-11), "status -11 during this scenario"),
        (None, "", Ended(-15, timed_out=True), "time limit during this scenario"),
        (GOOD | {"problem": "AssertionError: no seeds"}, "", None, "no seeds"),
        (GOOD | {"checks": 0}, "", None, "checked nothing"),
        (GOOD, "Traceback (most recent call last):\n", None, "errors in the log"),
        (GOOD, "KeyError: 'x'\n", None, "KeyError"),
        (GOOD, "01:02.3  bpy.rna  | ERROR Python script error\n", None, "script error"),
        (GOOD, "DeprecationWarning: old\n", None, "DeprecationWarning"),
        (GOOD, "Error: no such seed\n", None, "no such seed"),
        (GOOD, "", Ended(139), "did not quit by itself"),
    ],
)
def test_what_makes_a_scenario_fail(tmp_path, told, log, ended, fault):
    assert fault in outcome_of(tmp_path, told, log, ended).fault()


def test_an_expected_error_is_no_fault(tmp_path):
    told = GOOD | {"expected_errors": [r"^Error: no such seed"]}
    assert outcome_of(tmp_path, told, "Error: no such seed 4\n").fault() == ""
    assert outcome_of(tmp_path, told, "Error: something else\n").fault()


def test_a_scenario_that_never_began_fails(tmp_path):
    (tmp_path / "results").write_text("")
    (tmp_path / "log").write_text("")
    outcome = read_outcomes(["scenario_a"], tmp_path / "results", tmp_path / "log")["scenario_a"]
    outcome.ended, outcome.log_path = Ended(1), ROOT / "log"
    assert "before this scenario" in outcome.fault()


def test_every_file_holds_scenarios():
    files = scenario_files()
    assert len(files) > 4 and all(file.names for file in files.values())


def test_a_hang_is_ended():
    assert run(["sleep", "60"], limit_s=0.2).timed_out


def test_without_a_blender_one_line_says_what_to_set(monkeypatch, tmp_path):
    monkeypatch.delenv("BLENDER", raising=False)
    monkeypatch.setattr(window_blender, "TOOLS", tmp_path)
    with pytest.raises(BlenderMissing, match=r"^set BLENDER=/path/to/blender.*$"):
        find_blender()


def test_a_blender_that_is_not_there_is_named(monkeypatch):
    monkeypatch.setenv("BLENDER", "/nowhere/blender")
    with pytest.raises(BlenderMissing, match="BLENDER=/nowhere/blender is no program"):
        find_blender()
