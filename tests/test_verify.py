"""The verb ``verify``: which outputs of a run are whole and belong together."""

import json
import shutil

import pytest
from command_line import COLORIZE, assert_refused, save_seeds

RUN = (*COLORIZE, "-o", "out.png", "-o", "more/second.png", "--report", "r.json")


@pytest.fixture
def results(run_cli, cli_folder):
    (cli_folder / "more").mkdir()
    assert run_cli(*RUN)[0] == 0
    return cli_folder


def test_a_finished_run_is_whole(run_cli, results):
    assert run_cli("verify", "r.json") == (0, "whole    out.png\nwhole    more/second.png\n", "")


def test_a_folder_of_results_can_be_moved(run_cli, results, monkeypatch):
    moved = results / "archive"
    moved.mkdir()
    for name in ("out.png", "more", "r.json"):
        shutil.move(results / name, moved / name)
    assert run_cli("verify", "archive/r.json")[0] == 0


def test_a_run_that_died_between_two_outputs_is_told(run_cli, results, monkeypatch):
    from reflcolor_addon.batch import write as batch_write

    write = batch_write.write_png

    def dies(path, rgb):
        if path.name == "second.png":
            raise KeyboardInterrupt
        write(path, rgb)

    save_seeds(results, {"row": 0, "col": 0, "rgb": [9, 200, 9]})
    monkeypatch.setattr(batch_write, "write_png", dies)
    assert run_cli(*RUN)[0] == 130
    status, out, err = run_cli("verify", "r.json")
    changed = "changed  out.png: it is whole, but was written by another run or changed since\n"
    assert (status, out) == (1, f"{changed}whole    more/second.png\n")
    assert err == "error: r.json: 1 of 2 outputs are not as the run wrote them\n"


def test_what_is_cut_short_or_gone_is_told(run_cli, results):
    (results / "out.png").write_bytes((results / "out.png").read_bytes()[:-5])
    (results / "more" / "second.png").unlink()
    status, out, _ = run_cli("verify", "r.json", "--json")
    assert status == 1
    (report,) = json.loads(out)["reports"]
    assert report == {
        "file": "r.json",
        "outputs": [
            {"path": "out.png", "state": "changed", "note": "it is cut short"},
            {"path": "more/second.png", "state": "missing", "note": "there is no such file"},
        ],
    }


def test_an_output_whose_name_is_too_long_for_a_file_is_missing(run_cli, results):
    report = json.loads((results / "r.json").read_text(encoding="utf-8"))
    report["outputs"][0] |= dict.fromkeys(("path", "from_report"), "a" * 4000)
    (results / "r.json").write_text(json.dumps(report))
    status, out, _ = run_cli("verify", "r.json")
    assert (status, out.startswith("missing  aaaa")) == (1, True)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (lambda report: report | {"outputs": [{"option": "-o", "path": "out.png"}]}, "does not hold the hashes"),
        (lambda report: report | {"version": 99}, 'not of the format "reflcolor-report"'),
        (lambda report: [], "not of the format"),
    ],
)
def test_what_is_no_report_with_hashes_is_refused(run_cli, results, change, part):
    report = json.loads((results / "r.json").read_text(encoding="utf-8"))
    (results / "r.json").write_text(json.dumps(change(report)))
    assert_refused(run_cli("verify", "r.json"), 1, "r.json: ", part)


def test_a_report_that_cannot_be_read_is_refused(run_cli, cli_folder):
    assert_refused(run_cli("verify", "gone.json"), 1, "gone.json: no such file")
    assert_refused(run_cli("verify", "garage.ptx"), 1, "garage.ptx: ", "expected a report in JSON")
    (cli_folder / "r.json").write_bytes(b"\xff\xfe")
    assert_refused(run_cli("verify", "r.json"), 1, "r.json: expected a report in JSON, found bytes that are not text")
