"""Where colors are from: the outline of a report, and the verb that prints it."""

import json

import numpy as np
import pytest
from command_line import COLORIZE, assert_refused, blender_tasks
from hypothesis import given
from hypothesis import strategies as st
from small_scans import random_scan

from reflcolor_addon import ReflcolorError, Seeds, Settings, colorize
from reflcolor_addon.report.provenance import outline, parse_provenance
from reflcolor_addon.report.report import build_report, scan_entry, stamped

NOT_SEEN = {"role": "photo", "path": "b.jpg", "bytes": None, "sha256": None}


@pytest.fixture
def report():
    """A report on five seeds of four sources."""
    scan = random_scan()
    seeds = Seeds(
        [0, 1, 2, 3, 4],
        [0, 1, 2, 3, 4],
        np.full((5, 3), 90),
        photos=[None, "a.jpg", "a.jpg", "a.jpg", "b.jpg"],
        photo_xy=[(np.nan, np.nan), (1, 1), (2, 2), (3, 3), (4, 4)],
        reason=[None, "hand", None, "pose", "appearance"],
    )
    entry = {"role": "scan", "path": "w.ptx", "bytes": 3, "sha256": "ab" * 32}
    made = build_report(
        scan_entry(scan, 1), colorize(scan, seeds), Settings(), given_seeds=seeds, inputs=[entry, NOT_SEEN], blender="5"
    )
    return stamped(made)


def test_evidence_is_counted_by_its_source(report):
    found = outline(report)
    assert found.sources == {"photo": 2, "hand": 1, "pose": 1, "appearance": 1}
    assert (found.inferred, found.unreached) == (55, 0)


def test_two_seeds_on_a_pixel_are_one_pixel_of_evidence(report):
    report["seeds"][1] |= {"row": 0, "col": 0}
    assert outline(report).inferred == 56


def test_inputs_time_and_versions_are_told(report):
    found = outline(report)
    assert found.inputs == (("scan", "w.ptx", "ab" * 32), ("photo", "b.jpg", None))
    assert found.created == report["created"]
    assert found.versions == {"reflcolor": report["versions"]["reflcolor"], "blender": "5"}


def test_a_report_survives_as_text(report):
    assert parse_provenance(json.dumps(report)) == report


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is not JSON"),
        ("[" * 100_000, "is not JSON"),
        ("[]", "is not of the format"),
        ('{"format": "reflcolor-report", "version": 99}', "is not of the format"),
    ],
)
def test_what_is_no_report_is_one_line(text, message):
    with pytest.raises(ReflcolorError, match=message):
        parse_provenance(text)


@given(st.sampled_from(["seeds", "inputs", "result", "versions"]), st.sampled_from([None, 3, [1], [{}], {}]))
def test_a_spoiled_report_is_one_line(name, value):
    spoiled = {
        "format": "reflcolor-report", "version": 1, "seeds": [], "inputs": [],
        "result": {"colored": 0, "unreached": 0}, "versions": {"reflcolor": "1", "blender": None},
    } | {name: value}  # fmt: skip
    if (name, value) in (("seeds", {}), ("inputs", {})):
        return
    with pytest.raises(ReflcolorError, match="incomplete"):
        outline(spoiled)


# The verb


@pytest.fixture
def printed(run_cli, cli_folder):
    """A function that runs `provenance x.blend` over objects of that name and provenance."""
    (cli_folder / "x.blend").write_bytes(b"scene")

    def run(objects, *arguments):
        tasks = blender_tasks(read_provenance=lambda _path: list(objects.items()))
        return run_cli("provenance", "x.blend", *arguments, blender=tasks)

    return run


def test_the_verb_prints_as_json_every_scan_and_warns_of_those_without(printed, report):
    status, out, err = printed({"wall": json.dumps(report), "old": None}, "--json")
    document = json.loads(out)
    assert status == 0
    assert (document["format"], document["version"], document["file"]) == ("reflcolor-provenance", 1, "x.blend")
    assert document["objects"] == [{"name": "wall", "provenance": report}, {"name": "old", "provenance": None}]
    assert err.startswith("warning: old has no provenance") and err.count("\n") == 1


def test_the_verb_prints_one_object_where_it_is_named(printed, report):
    _, out, err = printed({"wall": json.dumps(report), "old": None}, "--object", "wall", "--json")
    assert [entry["name"] for entry in json.loads(out)["objects"]] == ["wall"] and err == ""


def test_without_json_it_can_be_read_at_a_glance(printed, report):
    report["photos"] = [{"name": "b.jpg", "verified": True, "reason": "pose", "note": "verified: 90 % agree"}]
    status, out, err = printed({"wall": json.dumps(report), "roof": json.dumps(report), "old": None})
    assert status == 0 and err.startswith("warning: old has no provenance")
    wall, roof = out.rstrip("\n").split("\n\n")
    head, *lines = wall.splitlines()
    assert head == "wall" and roof.splitlines() == ["roof", *lines]
    said = [line.strip() for line in lines]
    for line in (
        "scan          small, scan 1 of its file",
        "6 rows x 10 columns, 60 returns",
        "result        60 pixels colored, 0 left gray",
        "seeds         2 photo: picked in a photo",
        "1 pose: found by a photo's camera",
        "photos        b.jpg: verified: 90 % agree",
        "settings      alpha 6.0",
        "nearest all",
        f"versions      reflcolor {report['versions']['reflcolor']}",
        "inputs        scan w.ptx, 3 bytes",
        f"SHA-256 {'ab' * 32}",
        "photo b.jpg",
        "SHA-256 not kept",
    ):
        assert line in said
    low, high = report["normalization"]["range_m"]
    assert f"range {low:.6g} to {high:.6g} m" in said


@pytest.mark.parametrize("name", ["scan", "settings", "photos", "normalization", "warnings"])
@pytest.mark.parametrize("value", [None, 3, [1], [{}], {}])
def test_a_spoiled_report_is_one_line_or_less_of_a_summary(printed, report, name, value):
    outcome = printed({"wall": json.dumps(report | {name: value})})
    if outcome[0]:
        assert_refused(outcome, 1, "x.blend: wall: the provenance is incomplete")


@pytest.mark.parametrize(
    ("objects", "arguments", "status", "message"),
    [
        ({}, (), 1, "x.blend: holds no scan"),
        ({"old": None}, (), 1, "x.blend: old has no provenance: it was not colorized, or before"),
        ({"old": None}, ("--object", "new"), 2, "--object new: not one of the scans old"),
        ({"old": "{}"}, (), 1, "x.blend: old: the provenance is not of the format"),
    ],
)
def test_what_the_verb_cannot_print_is_one_line(printed, objects, arguments, status, message):
    assert_refused(printed(objects, *arguments), status, message)


def test_the_verb_needs_blender_and_a_file(run_cli, cli_folder):
    assert_refused(run_cli("provenance", "x.blend"), 2, "needs Blender")
    assert_refused(run_cli("provenance", "x.blend", blender=blender_tasks()), 1, "x.blend: no such file")


def test_what_colorize_reports_is_what_the_verb_would_print(run_cli, cli_folder):
    kept = []
    tasks = blender_tasks(
        write_scene=lambda results, paths, *_: kept.extend(job.report for job in results) or paths[0].touch()
    )
    assert run_cli(*COLORIZE, "-o", "a.blend", "--report", "r.json", blender=tasks)[0] == 0
    found = outline(parse_provenance(json.dumps(kept[0])))
    assert found.sources == {"hand": 2} and found.created
    assert [role for role, _, _ in found.inputs] == ["scan", "seeds"]
