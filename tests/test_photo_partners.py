"""Scans of one place are found by what they measured there, once a photo is known to show one of them."""

import csv

import numpy as np
import pytest
from small_scans import random_scan

from benchmarks.rooms import Room
from reflcolor_addon.batch.archive import candidates, partners, tries
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.registrations import Registrations
from reflcolor_addon.cli.main import main
from reflcolor_addon.files.images import read_image, write_png
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews
from reflcolor_addon.scan.scan import Scan

ASIDE = (0.4, -0.3)


def panorama(azimuth_deg, elevation_deg, reflectance):
    azimuth, elevation = (np.radians(a) for a in np.meshgrid(azimuth_deg, elevation_deg))
    rays = [np.sin(azimuth) * np.cos(elevation), np.cos(azimuth) * np.cos(elevation), np.sin(elevation)]
    valid = np.ones(azimuth.shape, bool)
    return Scan(name="hall", points=4 * np.stack(rays, axis=-1), reflectance=reflectance, valid=valid)


@pytest.mark.parametrize("turn_deg", [0, 180])
def test_the_picture_is_what_a_camera_in_the_scanners_place_would_show(turn_deg):
    azimuth, elevation = np.arange(-180, 180, 1.0), np.arange(40, -41, -1.0)
    around, up = np.meshgrid(azimuth, elevation)
    # Darker to the left and below of where it looks, brighter to the right and above.
    right = (around - turn_deg + 180) % 360 - 180 > 0
    scan = panorama(azimuth, elevation, np.where(right, 2.0, 0.0) + np.where(up > 0, 1.0, 0.0))
    rows, cols = np.nonzero(np.abs((around - turn_deg + 180) % 360 - 180) < 20)
    picture = partners.picture_of(ScanViews(scan), rows, cols)
    height, width = picture.shape[:2]
    assert picture.dtype == np.uint8 and width / height == pytest.approx(1.5, abs=0.02)
    quarters = [picture[y, x, 0] for y in (height // 4, 3 * height // 4) for x in (width // 4, 3 * width // 4)]
    assert np.argsort(quarters).tolist() == [2, 0, 3, 1]
    # 78 degrees are seen: half a picture's width is the tangent of half of that.
    stripe = panorama(azimuth, elevation, np.where(np.abs(around) < 20, 1.0, 0.0))
    rows, cols = np.nonzero(np.abs(around) < 20)
    bright = (partners.picture_of(ScanViews(stripe), rows, cols)[height // 2, :, 0] > 128).mean()
    assert bright == pytest.approx(2 * np.tan(np.radians(20)) / 1.62, abs=0.03)


def test_the_picture_has_nothing_black_where_nothing_was_measured():
    scan = panorama(np.arange(-40, 40, 1.0), np.arange(30, -31, -1.0), np.random.default_rng(0).random((61, 80)))
    scan.valid[20:30, 30:50] = False
    picture = partners.picture_of(ScanViews(scan), *np.nonzero(scan.valid))
    assert picture[picture.shape[0] // 2 - 4, picture.shape[1] // 2, 0] > 60


def test_a_scan_is_found_again_from_another_place_in_its_room_among_other_rooms():
    scans = {"here": Room(1).scan(), "aside": Room(1).scan(place=ASIDE)}
    scans |= {f"other {number}": Room(number).scan() for number in (2, 3, 4)}
    picture = PhotoImage("here", partners.picture_of(ScanViews(scans["here"]), *np.nonzero(scans["here"].valid)))
    scores = {name: partners.look(ScanViews(scan), picture) for name, scan in scans.items() if name != "here"}
    assert partners.partners(scores, dict.fromkeys(scores, 1.0)) == ["aside"]
    bare = random_scan(shape=(4, 5))
    assert partners.look(ScanViews(bare), picture) == 0
    assert partners.look(ScanViews(scans["aside"]), PhotoImage("gray", np.full((60, 90, 3), 9, np.uint8))) == 0


def test_partners_stand_out_from_what_is_usual():
    usual = dict.fromkeys("abcde", 10.0)
    assert partners.partners({"a": 30, "b": 26, "c": 13, "d": 11, "e": 10}, usual) == ["a", "b"]
    assert partners.partners({"a": 12, "b": 11, "c": 10, "d": 9, "e": 9}, usual) == []
    # One with much detail fits everything.
    assert partners.partners({"a": 30, "b": 26, "c": 13, "d": 11, "e": 10}, usual | {"a": 30, "b": 25}) == []
    assert partners.partners({"a": 30.0}, usual) == partners.partners({}, usual) == []
    assert partners.partners({"a": 0.0, "b": 0.0, "c": 0.0}, usual) == []
    # What no photo was looked at for tells nothing, and hides nothing.
    assert partners.partners({"a": 30, "b": 26, "c": 13, "d": 11, "e": 10, "f": 12}, usual) == ["a", "b"]
    assert partners.partners({"a": 30, "b": 26, "c": 13, "d": 11, "e": 10, "f": 9}, usual | {"f": 0.0}) == ["a", "b"]


def test_what_hardly_stands_out_is_no_partner():
    usual = dict.fromkeys("abcde", 10.0)
    assert partners.partners({"a": 14.9, "b": 10, "c": 10, "d": 9, "e": 9}, usual) == []
    assert partners.partners({"a": 15.1, "b": 10, "c": 10, "d": 9, "e": 9}, usual) == ["a"]


def test_scans_from_beside_a_place_are_partners_once_the_scan_from_the_same_spot_is_known():
    scores = {"again": 60, "next": 35, "far": 15, "b": 20, "c": 20, "d": 19, "e": 18}
    usual = dict.fromkeys(scores, 20.0)
    assert partners.partners(scores, usual) == ["again"]
    assert partners.partners(scores, usual, {"again"}) == ["next"]
    # Where nothing else stands out, nothing else is one.
    assert partners.partners(scores | {"next": 21}, usual, {"again"}) == []
    # Scans of the place do not hide another one, however many they are.
    most = {"one": 60, "two": 58, "three": 56, "next": 35, "b": 20, "c": 20}
    assert partners.partners(most, dict.fromkeys(most, 20.0), {"one", "two", "three"}) == ["next"]


def test_pictures_are_kept_by_the_files_and_not_for_files_that_could_not_be_hashed(tmp_path):
    (folder := BatchFolder(tmp_path)).make()
    picture = np.random.default_rng(0).integers(0, 255, (4, 6, 3), np.uint8)
    hashes = {str(tmp_path / "a.ptx"): "1", "b.jpg": "2", "c.jpg": ""}

    class Job:
        path, index = tmp_path / "a.ptx", 0

    registrations = Registrations(folder, hashes)
    name = registrations.keep_picture(Job, "b.jpg", picture)
    assert np.array_equal(read_image(folder.sketch(name)), picture)
    assert registrations.keep_picture(Job, "c.jpg", picture) is None


def test_a_photo_that_was_found_is_tried_on_the_other_scan_of_its_room(tmp_path, monkeypatch):
    rooms = {"a": (1, (0, 0)), "b": (1, ASIDE), "c": (2, (0, 0)), "d": (3, (0, 0))}
    for name, (number, place) in rooms.items():
        write_ptx(Room(number).scan(place=place, name=name), tmp_path / f"{name}.ptx")
    write_png(tmp_path / "photo.png", Room(1).photo(1))
    lines = ('format = "reflcolor-batch"', "version = 1", 'output = "colored"', 'scans = "*.ptx"')
    lines += ('photos = "*.png"', 'write = "png"', "settings = { slic_segments = 60 }")
    (tmp_path / "batch.toml").write_text("\n".join(lines), encoding="utf-8")
    # As in a large archive: one try, and then nothing but partners.
    monkeypatch.setattr(candidates, "ALL_PAIRS", 0)
    for name, value in (("_AT_ONCE", 1), ("MOST_PAIRS", 1.0), ("_WORTH", 2.0)):
        monkeypatch.setattr(tries, name, value)
    assert main(["batch", str(tmp_path / "batch.toml"), "--jobs", "1", "--keep-going"]) == 0
    with (tmp_path / "colored" / "pairs.csv").open(encoding="utf-8", newline="") as file:
        shows = {row["scan"]: row["shows"] for row in csv.DictReader(file)}
    assert shows["b"] == "yes" and shows["a"] in ("yes", "no")
    assert shows["c"] == shows["d"] == "not tried"
