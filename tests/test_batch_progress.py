"""How far a batch is, how long it will still take, and how that is told."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from reflcolor_addon.batch.archive import progress_lines
from reflcolor_addon.batch.archive.context import Context
from reflcolor_addon.batch.archive.costs import Costs
from reflcolor_addon.batch.archive.estimate import expected
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.looks import FIRST, look_at
from reflcolor_addon.batch.archive.options import Options
from reflcolor_addon.batch.archive.registrations import Registrations
from reflcolor_addon.batch.archive.workers import Task
from reflcolor_addon.batch.session import Session
from reflcolor_addon.cli.verbs.batch import _plain_lines
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.readers.options import ReadOptions
from reflcolor_addon.matching.registration.registration import Registration


def test_what_was_known_before_tells_nothing_of_the_time_left(monkeypatch):
    clock, said = [100.0], []
    monkeypatch.setattr(progress_lines, "time", SimpleNamespace(monotonic=lambda: clock[0]))
    outcomes = {"known": ({"found": {"worked": 0.0}}, 0.0), "new": ({"found": {"worked": 1.0}}, 10.0)}

    class Workers:
        def work(self, tasks, finished, show, begin):
            for task in list(tasks)[:-1]:
                outcome, seconds = outcomes[task.name.split()[0]]
                clock[0] += seconds
                finished(task, outcome)
            show([])

    class OfABatch(Context):
        def __init__(self):
            self.workers, self.whole = Workers(), progress_lines.WholeProgress({"look": 5.0}, 1)
            self.session = SimpleNamespace(progress=lambda fraction, text: said.append((fraction, text)))

    tasks = [Task(name=name, request={}) for name in ("known 1", "known 2", "known 3", "new 1", "new 2")]
    OfABatch().work("look", tasks, lambda task, outcome: None, "Looked at")
    assert said[0] == (0.5, "Looked at 4 of 5; 9 s left")


def test_progress_is_that_of_the_whole_batch(monkeypatch):
    clock = [0.0]
    monkeypatch.setattr(progress_lines, "time", SimpleNamespace(monotonic=lambda: clock[0]))
    whole = progress_lines.WholeProgress({"look": 10.0, "match": 70.0, "color": 20.0}, 2)
    assert (whole.share(), whole.text()) == (0.0, "50 s left")
    told = []

    def step(stage, cost, seconds, **how):
        whole.begin(stage, cost, **how)
        clock[0] += seconds / 2
        told.append((round(whole.share(cost / 2), 2), whole.text(cost / 2)))
        clock[0] += seconds / 2
        whole.add(cost)
        told.append((round(whole.share(), 2), whole.text()))
        whole.pause()
        # Reading files between two steps tells nothing of how fast these are.
        clock[0] += 1000

    step("look", 10.0, 5.0)
    # It takes twice as long as was expected.
    step("match", 20.0, 20.0)
    step("match", 20.0, 20.0)
    # No more pairs are tried, though more were expected, and coloring has more to do than was expected.
    step("color", 50.0, 50.0, only=True)
    assert told == [
        (0.05, "48 s left"),
        (0.1, "45 s left"),
        (0.2, "56 s left"),
        (0.3, "55 s left"),
        (0.4, "50 s left"),
        (0.5, "43 s left"),
        (0.75, "23 s left"),
        (1.0, "1 s left"),
    ]


def test_the_share_that_is_done_never_falls():
    whole = progress_lines.WholeProgress({"look": 10.0, "color": 10.0}, 1)
    whole.begin("look", 10.0)
    whole.add(10.0)
    assert whole.share() == 0.5
    whole.begin("color", 90.0, only=True)
    assert whole.share() == 0.5
    whole.add(80.0)
    assert 0.5 < whole.share() < 1.0
    whole.end()
    assert whole.share() == 1.0


def test_what_an_earlier_run_has_done_is_not_expected_again():
    whole = progress_lines.WholeProgress({"look": 10.0, "match": 40.0}, 1)
    whole.begin("look", 10.0)
    whole.add(10.0)
    assert whole.share() == 0.2
    whole.expect_less("match", 30.0)
    assert whole.share() == 0.5


def test_of_a_batch_that_had_nothing_to_do_all_is_done():
    whole = progress_lines.WholeProgress({}, 1)
    assert whole.share() == 1.0


def expected_of(scans, **options):
    """What is expected of a batch of so many scans of a megapixel and 40 photos."""
    items = [
        SimpleNamespace(offered=True, plan=SimpleNamespace(scans=[Path(f"{k}.ptx")], outputs=[], seeds=None, photos=[]))
        for k in range(scans)
    ]
    manifest = SimpleNamespace(items=items, photos=[Path(f"{k}.jpg") for k in range(40)])
    costs = Costs(scans={item.plan.scans[0]: 1_000_000 for item in items})
    return expected(manifest, Options(workers=1, memory=1 << 30, **options), costs)


@pytest.mark.parametrize("stages", [("look",), ("match",), ("look", "match", "color", "render")])
def test_what_is_expected_is_what_the_stages_need(stages):
    found = expected_of(30, stages=stages)
    # Only a share of all pairs is matched.
    matches = {} if stages == ("look",) else {"match": 30 * 0.1 * 40 + 10 * 0.105 * 30 * 40}
    colors = {"color": 30 * 9.5, "render": 0.0} if "color" in stages else {}
    looks = 0.25 * 30 * 40 * (1 if stages == ("look",) else 2) + (0 if stages == ("look",) else 0.01 * 40 * 20)
    assert found == pytest.approx({"look": looks, **matches, **colors})


def test_a_photo_is_expected_to_be_matched_with_nine_scans_at_most_and_with_one_at_least():
    matched = {scans: expected_of(scans)["match"] - 0.1 * 40 * scans for scans in (9, 86, 300)}
    assert matched == pytest.approx(dict.fromkeys((86, 300), 10 * 40 * 9) | {9: 10 * 40})
    # A part of a batch cannot wait for what others find, and tries two.
    assert expected_of(12, first=1, last=6)["match"] == pytest.approx(6 * (0.1 * 40 + 10 * 40 * 2 / 12))


def test_progress_is_told_in_lines_where_there_is_no_terminal():
    said, clock = [], [0.0]
    show = _plain_lines(Session(say=said.append), now=lambda: clock[0])
    for seconds, fraction in ((1, 0.1), (6, 0.15), (9, 0.3), (12, 0.35), (20, 0.38), (30, 1.0), (31, 0.0), (40, 0.2)):
        clock[0] = seconds
        show(fraction, "at work")
    assert said == [" 15%  at work", " 35%  at work", "100%  at work", " 20%  at work"]


def test_where_a_tenth_takes_long_a_percent_is_told_at_most_once_a_minute():
    said, clock = [], [0.0]
    show = _plain_lines(Session(say=said.append), now=lambda: clock[0])
    for seconds, fraction in ((30, 0.01), (59, 0.02), (61, 0.025), (90, 0.04), (130, 0.05), (200, 0.059), (900, 0.06)):
        clock[0] = seconds
        show(fraction, "at work")
    assert said == ["  2%  at work", "  5%  at work", "  6%  at work"]


def test_progress_for_an_engine_of_a_render_farm(archive, batch):
    status, out, _ = batch("--openjd")
    told = [int(line.split()[1]) for line in out.splitlines() if line.startswith("openjd_progress:")]
    assert status == 0 and told[-1] == 100 and told == sorted(set(told))
    (archive / "hall_2.ptx").write_text("no scan\n")
    status, out, _ = batch("--openjd", "--keep-going")
    assert status == 1 and "openjd_fail: batch.toml: 1 of 3 failed: hall_2" in out


def test_looks_and_matches_that_were_kept_count_as_no_work(archive):
    write_png(archive / "a.png", np.random.default_rng(0).integers(0, 256, (40, 60, 3)).astype(np.uint8))
    (folder := BatchFolder(archive / "colored")).make()
    files = [archive / "hall_0.ptx", archive / "a.png"]
    request = {"folder": str(folder.root), "scans": [str(files[0])], "photos": [str(files[1])], "look": FIRST}
    request |= {"hashes": {str(path): path.name for path in files}, "reading": ReadOptions().as_dict()}
    worked = [
        look_at(request, progress=lambda *_: None, cancelled=lambda: False)["worked"],
        look_at(request, progress=lambda *_: None, cancelled=lambda: False)["worked"],
    ]
    assert worked == [1.0, 0.0]
    registrations, job = Registrations(folder, request["hashes"]), SimpleNamespace(path=files[0], index=1)
    for _ in range(2):
        registrations(job, files[1], Registration.nothing)
    assert registrations.recalled == 1
