"""The pipeline that every way of colorizing takes: plan, check, run, write."""

import pickle
import weakref
from pathlib import Path

import pytest
from small_scans import random_scan

from reflcolor_addon import Seeds, Settings, colorize
from reflcolor_addon.batch.check import check_plan
from reflcolor_addon.batch.pipeline import colorize_jobs, run_plan
from reflcolor_addon.batch.plan import IMAGE, SCENE, Output, Plan
from reflcolor_addon.batch.scan_job import ScanJob
from reflcolor_addon.batch.session import Session
from reflcolor_addon.files.images import read_image
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.writers import write_ptx

SEEDS = Seeds([1, 4], [2, 8], [[200, 80, 40], [20, 80, 220]])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder, with a scan and its seeds."""
    monkeypatch.chdir(tmp_path)
    write_ptx(random_scan(shape=(6, 10)), tmp_path / "garage.ptx")
    SEEDS.save(tmp_path / "seeds.json")
    return tmp_path


def test_a_plan_can_be_sent_to_another_process_and_run_there(folder):
    plan = Plan(
        scans=(Path("garage.ptx"),),
        seeds=Path("seeds.json"),
        outputs=(Output("-o", Path("out.png"), IMAGE),),
        settings=Settings(beta=0),
    )
    session = Session()
    run_plan(pickle.loads(pickle.dumps(plan)), session)
    assert session.written == [Path("out.png")]
    (scan,) = read_scans("garage.ptx")
    assert (read_image("out.png") == colorize(scan, SEEDS, Settings(beta=0)).rgb).all()


def test_all_that_is_wrong_with_a_plan_can_be_named_at_once(folder):
    plan = Plan(
        scans=(Path("garage.ptx"), Path("./garage.ptx")),
        wanted="2",
        seeds=Path("missing.json"),
        outputs=(
            Output("-o", Path("garage.ptx"), IMAGE),
            Output("-o", Path("no_folder") / "{scan}.png", IMAGE),
            Output("-o", Path("out.blend"), SCENE),
        ),
    )
    faults = []
    check_plan(plan, refuse=faults.append)
    expected = (
        "garage.ptx: is given twice",
        "--scan 2: chooses a scan of one file",
        "-o out.blend needs Blender",
        "-o garage.ptx: each of several scans has its own",
        "--seeds missing.json: each of several scans has its own",
        "missing.json: no such file",
        "-o garage.ptx: is an input",
        "no_folder/{scan}.png: cannot be written: there is no folder no_folder",
    )
    assert [message for message, part in zip(map(str, faults), expected, strict=True) if part not in message] == []


def test_jobs_are_colorized_in_turn_and_no_scan_is_kept():
    met, said = [], []

    def scan(seed):
        made = random_scan(seed, (6, 10))
        assert all(earlier() is None for earlier in met)
        met.append(weakref.ref(made))
        return made

    jobs = [ScanJob(name=f"scan {seed}", scan=lambda seed=seed: scan(seed), seeds=SEEDS) for seed in (1, 2)]
    colorize_jobs(jobs, Settings(), progress=lambda fraction, text: said.append((fraction, text)))
    assert [job.scan for job in jobs] == [None, None]
    for seed, job in zip((1, 2), jobs, strict=True):
        assert (job.colorization.rgb == colorize(random_scan(seed, (6, 10)), SEEDS).rgb).all()
    fractions = [fraction for fraction, _ in said]
    assert fractions == sorted(fractions) and {text.split(":")[0] for _, text in said} == {"scan 1", "scan 2"}
