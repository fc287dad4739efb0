"""What a batch reports: the page, its table, the table of pairs."""

import csv
import json
import sys
from collections import defaultdict
from dataclasses import astuple, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from archives import HEAD, make_archive, table_of
from small_scans import random_scan
from test_photo_claims import CELLAR, HALL

from reflcolor_addon.batch.archive.claims import Claim
from reflcolor_addon.batch.archive.done import Done
from reflcolor_addon.batch.archive.duplicates import Duplicates
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.manifest_file import load_manifest
from reflcolor_addon.batch.archive.match_stage import Matched
from reflcolor_addon.batch.archive.pairs import COLUMNS, read_pairs, write_pairs
from reflcolor_addon.batch.archive.pairs_table import write_table
from reflcolor_addon.batch.archive.verdicts import Verdicts
from reflcolor_addon.batch.session import Session
from reflcolor_addon.cli.main import main
from reflcolor_addon.errors import UsageError
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.report.archive_entries import photos_of


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
    path.write_text("scan,photo,shows\na,b,not tried\na,c,\na,d,CONTRADICTION\n")
    assert read_pairs(path) == {}
    path.write_text("scan,photo,shows\na,b,yes\na,c,ja\n")
    with pytest.raises(UsageError, match=r"pairs\.csv: line 3: shows 'ja': expected yes or no"):
        read_pairs(path)
    path.write_text("scan\tphoto\tshows\na\tb\tyes\n")
    assert read_pairs(path) == {("a", "b"): True}
    path.write_text("scan,photo\na,b\n")
    with pytest.raises(UsageError, match="line 1: expected the columns " + ", ".join(COLUMNS[:3])):
        read_pairs(path)


def test_everything_wrong_in_a_table_of_pairs_is_named_at_once(tmp_path):
    path, faults = tmp_path / "pairs.csv", []
    path.write_text("scan,photo,shows\na,b,yes\na,c,ja\na,b,no\nd\na,b,yes\n")
    read_pairs(path, faults.append)
    assert [str(fault).removeprefix(f"{path}: ") for fault in faults] == [
        "line 3: shows 'ja': expected yes or no, or nothing where that is not known",
        "line 4: says no of a and b, but line 2 says yes; leave one of them out",
        "line 5: expected a value in each of the columns scan, photo, shows",
    ]


def test_a_no_that_the_batch_wrote_is_nobodys_word(tmp_path):
    rows = [("a", "1.jpg", "no", "0.94", "not verified"), ("a", "2.jpg", "no", "2.31", "verified")]
    rows += [("a", "3.jpg", "no", "", ""), ("a", "4.jpg", "yes", "0.20", "not verified")]
    write_pairs(tmp_path / "pairs.csv", rows)
    text = (tmp_path / "pairs.csv").read_text(encoding="utf-8")
    known = {("a", "2.jpg"): False, ("a", "3.jpg"): False, ("a", "4.jpg"): True}
    assert read_pairs(tmp_path / "pairs.csv") == known
    # As a spreadsheet writes it in some countries.
    (tmp_path / "pairs.csv").write_text(text.replace(",", ";").replace("0.94", "0,94").replace("2.31", "2,31"))
    assert read_pairs(tmp_path / "pairs.csv") == known


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


def test_a_scan_without_colors_has_its_reflectance_and_the_photos_that_were_tried(archive, batch):
    for number, name in enumerate(("a.png", "b.png")):
        write_png(archive / name, np.random.default_rng(number).integers(0, 256, (40, 60, 3)).astype(np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_0.ptx"\nphotos = "?.png"\n', encoding="utf-8")
    assert batch()[0] == 0
    page = (archive / "colored" / "report.html").read_text(encoding="utf-8")
    scans, photos = page.split('<section id="photos">')
    assert scans.count("data:image/jpeg;base64,") == 1 and 'aria-label="hall_0, before"' in scans
    assert photos.count("data:image/jpeg;base64,") == 2
    assert 'aria-label="hall_0, after"' not in page
    assert page.count("(evidence ") == 2 and "a.png: " in page and "b.png: " in page
    assert page.count("four to six pairs") == 1
    assert '<a href="pairs.csv">' in photos and table_of(archive)["hall_0"]["photos"] == "2"
    log = archive / "colored" / "logs" / "hall_0.log"
    assert log.read_text(encoding="utf-8").count("four to six pairs") == 1
    # What is tried later is told, too, although nothing else is to be done for the scan.
    write_png(archive / "c.png", np.random.default_rng(2).integers(0, 256, (40, 60, 3)).astype(np.uint8))
    status, out, _ = batch("--resume")
    assert status == 0 and "wrote colored/pairs.csv" in out and "(scan" not in out
    lines = log.read_text(encoding="utf-8").splitlines()
    assert sorted(line[:6] for line in lines[:3]) == ["a.png:", "b.png:", "c.png:"] and "(evidence " in lines[0]


def test_a_scan_that_failed_after_it_was_read_and_a_duplicate_have_a_picture(archive, batch):
    flat = random_scan(shape=(12, 16))
    write_ptx(replace(flat, reflectance=np.full_like(flat.reflectance, 0.5)), archive / "hall_0.ptx")
    (archive / "hall_2.ptx").write_bytes((archive / "hall_1.ptx").read_bytes())
    seeds = '[[scan]]\nfile = "hall_{}.ptx"\nseeds = "hall_1.seeds.json"\n'
    (archive / "batch.toml").write_text(HEAD + "".join(map(seeds.format, range(3))), encoding="utf-8")
    assert batch("--keep-going")[0] == 1
    rows = table_of(archive)
    assert [rows[f"hall_{number}"]["state"] for number in range(3)] == ["failed", "done", "duplicate"]
    page = (archive / "colored" / "report.html").read_text(encoding="utf-8")
    assert page.count("data:image/jpeg;base64,") == 3
    assert 'aria-label="hall_0, after"' not in page and 'aria-label="hall_2, after"' in page


@pytest.fixture
def contradiction(archive):
    """A batch whose one photo was verified on two scans of different places."""
    behind = {"hall_0": astuple(HALL), "hall_1": astuple(CELLAR)}
    found = {"verified": True, "tested": True, "evidence": 2.0, "note": "verified: 9 of 10 parts", "camera": None}
    found |= {"repeats": False, "brightness": None, "picture": None, "by_others": False}
    path = str(archive / "a.png")
    matched = Matched(pairs=defaultdict(dict), decided=True)
    claims = []
    for name, strength in (("hall_0", 60.0), ("hall_1", 20.0)):
        pair = found | {"scan": name, "strength": strength, "reflectance": behind[name]}
        matched.pairs[name][path] = [pair]
        claims.append(Claim.of(name, "a.png", [pair]))
    matched.verdicts |= Verdicts({path: claims}).by_photo()
    return matched


def context_of(path):
    """What `write_table` needs of a run over the batch of a manifest."""
    manifest = load_manifest(path, pytest.fail)
    manifest.folder.make()
    return SimpleNamespace(
        manifest=manifest,
        folder=manifest.folder,
        same=Duplicates(),
        done=Done(manifest.folder, None),
        problems={},
        session=Session(),
    )


def test_a_photo_of_two_places_is_a_contradiction_in_the_table_of_pairs(archive, batch, contradiction):
    write_png(archive / "a.png", np.zeros((40, 60, 3), np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_[01].ptx"\nphotos = "a.png"\n', encoding="utf-8")
    context = context_of(archive / "batch.toml")
    write_table(context, contradiction)
    with (archive / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["scan"]: row for row in csv.DictReader(file)}
    assert (rows["hall_0"]["shows"], rows["hall_1"]["shows"]) == ("yes", "contradiction")
    assert "clearly better" in rows["hall_0"]["note"] and "it shows hall_0" in rows["hall_1"]["note"]
    # Fed back as it is, it decides nothing that was not decided before.
    assert read_pairs(archive / "colored" / "pairs.csv") == {("hall_0", "a.png"): True}
    write_table(context, replace(contradiction, decided=False))
    assert read_pairs(archive / "colored" / "pairs.csv") == {}
    assert "not compared with what other photos and scans show yet" in (archive / "colored" / "pairs.csv").read_text()


def test_what_an_earlier_run_has_matched_is_told_in_the_table_of_pairs_and_decides_nothing(archive, contradiction):
    for name in "abc":
        write_png(archive / f"{name}.png", np.zeros((40, 60, 3), np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_0.ptx"\nphotos = "?.png"\n', encoding="utf-8")
    context = context_of(archive / "batch.toml")
    verified = {"verified": True, "tested": True, "evidence": 1.81, "note": "verified: 31 of 58"}
    not_verified = {"verified": False, "tested": True, "evidence": 0.2, "note": "not verified: 3 of 58"}
    earlier = {"hall_0": {str(archive / "b.png"): [not_verified, verified], str(archive / "c.png"): [not_verified]}}
    write_table(context, replace(contradiction, earlier=earlier))
    with (archive / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["photo"]: (row["shows"], row["evidence"], row["note"]) for row in csv.DictReader(file)}
    told = "found in an earlier run, and not needed in this one"
    assert rows["b.png"] == ("", "1.81", f"verified: 31 of 58; {told}; write yes to use it")
    assert rows["c.png"] == ("no", "0.20", f"not verified: 3 of 58; {told}")
    assert read_pairs(archive / "colored" / "pairs.csv").keys() == {("hall_0", "a.png")}


def test_what_a_person_said_of_a_pair_stays_in_the_table_of_pairs(archive, batch):
    write_png(archive / "a.png", np.zeros((40, 60, 3), np.uint8))
    write_pairs(archive / "mine.csv", [("hall_1", "a.png", "no", "", "")])
    head = HEAD + 'pairs = "mine.csv"\n'
    (archive / "batch.toml").write_text(head + 'scans = "hall_[01].ptx"\nphotos = "a.png"\n', encoding="utf-8")
    status, out, _ = batch("--stage", "color")
    assert status == 0 and "hall_1: no photo was tried on it; pairs.csv says why" in out
    with (archive / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["scan"]: (row["shows"], row["note"]) for row in csv.DictReader(file)}
    assert rows["hall_0"][0] == "cannot be tested"
    assert rows["hall_1"] == ("no", "as mine.csv says")


def test_a_pair_that_is_refused_later_is_gone_from_the_table_and_the_report(archive, batch):
    write_png(archive / "a.png", np.zeros((40, 60, 3), np.uint8))
    text = HEAD + 'scans = "hall_[01].ptx"\nphotos = "a.png"\n'
    (archive / "batch.toml").write_text(text, encoding="utf-8")
    assert batch()[0] == 0
    write_pairs(archive / "mine.csv", [("hall_1", "a.png", "no", "", "")])
    (archive / "batch.toml").write_text(text + 'pairs = "mine.csv"\n', encoding="utf-8")
    status, out, _ = batch("--resume")
    assert status == 0 and "2 without a certain photo" in out
    with (archive / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["scan"]: (row["shows"], row["note"]) for row in csv.DictReader(file)}
    assert rows["hall_0"][0] == "cannot be tested" and rows["hall_1"] == ("no", "as mine.csv says")
    assert [table_of(archive)[f"hall_{number}"]["photos"] for number in range(2)] == ["1", ""]


def test_scans_whose_photo_seems_to_show_two_places_are_warned_of(archive, batch, contradiction):
    batch()
    folder = BatchFolder(archive / "colored")
    for name in ("hall_0", "hall_1"):
        photos = [pair | {"photo": "a.png"} for pair in contradiction.told(name)]
        folder.remember("items", name, {"outcome": "done", "error": "", "left_out": [], "photos": photos})
    assert main(["report", "colored"]) == 0
    rows = table_of(archive)
    assert rows["hall_2"]["warnings"] == "0"
    assert rows["hall_0"]["warnings"] == rows["hall_1"]["warnings"] == "1"
    assert "a.png: gives no colors here: it shows hall_0" in rows["hall_1"]["note"]
    assert "<p>Contradictions</p>" in (archive / "colored" / "report.html").read_text("utf-8")


def test_the_report_says_which_photo_shows_which_scan(archive, contradiction):
    folder = BatchFolder(archive / "colored")
    folder.make()
    for name in ("hall_0", "hall_1"):
        photos = [pair | {"photo": "a.png"} for pair in contradiction.told(name)]
        folder.remember("items", name, {"outcome": "done", "error": "", "left_out": [], "photos": photos})
    folder.remember("", "scans", {"scans": {}, "photos": ["a.png", "b <b>.png"]})
    first, second = photos_of(archive / "colored")
    assert (first["photo"], first["shows"], first["evidence"]) == ("a.png", ["hall_0"], "2.00")
    assert "hall_1: gives no colors here: it shows hall_0" in first["note"]
    assert (second["shows"], second["evidence"]) == ([], "")
    assert second["note"] == "no match is recorded here; pairs.csv says why"
    assert main(["report", "colored"]) == 0
    page = (archive / "colored" / "report.html").read_text(encoding="utf-8")
    table = page[page.index('<section id="photos">') :]
    assert "<img" not in table
    small = np.full((300, 400, 3), 90, np.uint8)
    write_png(folder.sketch("abc"), small)
    folder.remember("", "photos", {"small": {"a.png": "abc.png", "b <b>.png": "../../../gone.png"}})
    assert main(["report", "colored"]) == 0
    page = (archive / "colored" / "report.html").read_text(encoding="utf-8")
    table = page[page.index('<section id="photos">') :]
    assert table.count('<img alt="" width="128" height="96" src="data:image/jpeg;base64,') == table.count("<img") == 1
    assert "1 of 2 show a scan for certain" in table and "b &lt;b&gt;.png" in table and 'href="#photos"' in page


def test_a_damaged_scan_that_no_photo_shows_is_warned_of(archive, batch):
    scan = (archive / "hall_0.ptx").read_text(encoding="utf-8").splitlines()
    (archive / "hall_0.ptx").write_text("\n".join(scan[:-30]) + "\n", encoding="utf-8")
    write_png(archive / "a.png", np.zeros((40, 60, 3), np.uint8))
    (archive / "batch.toml").write_text(HEAD + 'scans = "hall_0.ptx"\nphotos = "a.png"\n', encoding="utf-8")
    status, out, _ = batch()
    assert status == 0 and "does not show it for certain, 1 warning (see the report)" in out
    row = table_of(archive)["hall_0"]
    assert row["state"] == "unshown" and row["warnings"] == "1" and "cut short" in row["note"]
    batch("--resume")
    assert table_of(archive)["hall_0"] == row


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
    assert len(table_of(archive)) == 3
    monkeypatch.undo()
    monkeypatch.chdir(archive)
    assert main(["report", "colored"]) == 0
    assert not second.exists() and "<nav" not in first.read_text(encoding="utf-8")


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


def test_a_damaged_report_costs_no_other_its_place_on_the_page(archive, batch):
    batch()
    path = archive / "colored" / "reports" / "hall_1.json"
    report = json.loads(path.read_text(encoding="utf-8"))
    report["settings"] = "none"
    path.write_text(json.dumps(report), encoding="utf-8")
    assert main(["report", "colored"]) == 0
    rows = table_of(archive)
    assert [rows[f"hall_{number}"]["state"] for number in range(3)] == ["done", "failed", "done"]


def test_pages_of_an_earlier_report_go_and_nothing_else(archive, batch):
    batch()
    folder = archive / "colored"
    for name in ("report 2.html", "report 31.html", "report final.html", "report 2 old.html"):
        (folder / name).write_text("mine or not")
    assert main(["report", "colored"]) == 0
    assert {path.name for path in folder.glob("report *.html")} == {"report final.html", "report 2 old.html"}
