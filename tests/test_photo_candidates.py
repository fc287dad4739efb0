"""Which photos a batch matches with which scans: by their looks, and by when and where they were taken."""

import struct
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from e57_samples import write_e57
from hypothesis import given
from hypothesis import strategies as st
from small_scans import random_scan

from benchmarks.rooms import Room
from reflcolor_addon.batch.archive import two_looks
from reflcolor_addon.batch.archive.candidates import (
    ALL_PAIRS,
    SECOND_LOOKS,
    _Neighbors,
    all_of_them,
    are_few,
    for_second_looks,
    merged,
    ranks,
    telling,
)
from reflcolor_addon.batch.archive.folder import BatchFolder
from reflcolor_addon.batch.archive.looks import FIRST, SECOND, look_at
from reflcolor_addon.files.exif import Moment, moment_of
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.readers.e57_file import acquired_at
from reflcolor_addon.files.readers.options import ReadOptions
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.registration import ScanViews
from reflcolor_addon.matching.registration.sphere_map import SphereMap

NOON = "2024:05:17 12:00:00"
_NOON_S = datetime(2024, 5, 17, 12, tzinfo=UTC).timestamp()


def exif(order, taken=None, place=None):
    """A block of Exif, written by hand after the standard: a main directory, that of the camera, that of GPS."""
    text = (taken or "").encode() + b"\0"
    at = 8 + 2 + 2 * 12 + 4
    camera = struct.pack(order + "H", 1) + struct.pack(order + "HHII", 0x9003, 2, len(text), at + 18)
    camera += bytes(4) + text + bytes(len(text) % 2)
    gps_at, gps = at + len(camera), b""
    if place is not None:
        far = gps_at + 2 + 4 * 12 + 4
        entries = []
        for tag, value, sides in ((1, place[0], "NS"), (3, place[1], "EW")):
            entries.append(struct.pack(order + "HHI4s", tag, 2, 2, sides[value < 0].encode() + bytes(3)))
            entries.append(struct.pack(order + "HHII", tag + 1, 5, 3, far + 12 * (tag - 1)))
            minutes = round(abs(value) % 1 * 60 * 10000)
            gps += struct.pack(order + "6I", int(abs(value)), 1, minutes, 10000, 0, 1)
        gps = struct.pack(order + "H", 4) + b"".join(entries) + bytes(4) + gps
    main = struct.pack(order + "H", 2) + struct.pack(order + "HHII", 0x8769, 4, 1, at)
    main += struct.pack(order + "HHII", 0x8825 if gps else 0x8824, 4, 1, gps_at)
    return {"<": b"II", ">": b"MM"}[order] + struct.pack(order + "HI", 42, 8) + main + bytes(4) + camera + gps


def photo(path, block):
    """A photo with a block of Exif, which OpenCV writes into it."""
    import cv2

    rgb = np.zeros((8, 8, 3), np.uint8)
    done, data = cv2.imencodeWithMetadata(path.suffix, rgb, [cv2.IMAGE_METADATA_EXIF], [np.frombuffer(block, np.uint8)])
    assert done
    path.write_bytes(data.tobytes())
    return path


@pytest.mark.parametrize("suffix", [".jpg", ".png"])
@pytest.mark.parametrize("order", ["<", ">"])
def test_a_photo_tells_when_and_where_it_was_taken(tmp_path, suffix, order):
    moment = moment_of(photo(tmp_path / f"a{suffix}", exif(order, NOON, (-33.5, 151.25))))
    assert moment.seconds == _NOON_S
    assert (moment.latitude, moment.longitude) == pytest.approx((-33.5, 151.25), abs=1e-5)


def test_a_photo_without_a_date_a_place_or_sense_tells_nothing(tmp_path):
    assert moment_of(photo(tmp_path / "a.jpg", exif("<"))) == Moment()
    block = exif("<", NOON, (1.5, 2.5))
    for end in range(0, len(block), 3):
        path = tmp_path / "cut.jpg"
        path.write_bytes(b"\xff\xd8\xff\xe1" + struct.pack(">H", end + 8) + b"Exif\0\0" + block[:end])
        assert isinstance(moment_of(path), Moment)
    assert moment_of(tmp_path / "missing.jpg") == Moment()


def test_a_scan_tells_when_it_was_taken(tmp_path):
    path, fields = tmp_path / "a.e57", {f"cartesian{axis}": np.zeros(1) for axis in "XYZ"}
    write_e57(path, {"fields": fields}, {"fields": fields, "acquisitionStart": {"dateTimeValue": 86400.0}})
    assert acquired_at(path) == datetime(1980, 1, 7, tzinfo=UTC).timestamp()
    write_e57(path, {"fields": fields})
    assert acquired_at(path) is None
    assert acquired_at(tmp_path / "missing.e57") is None


def candidates(*given):
    """For each item the photos that it is among the likelier ones for."""
    found = {photo: dict(own) for photo, own in ranks(*given).items()}
    return {name: [photo for photo, own in found.items() if own[name] >= 0.4] for name in given[0]}


def test_scans_are_ranked_by_how_much_a_photo_looks_like_them_and_the_likeliest_are_looked_at_again():
    scores = {f"scan {number:02}": {"a": 10.0 + number, "b": 1.0, "c": 1.0} for number in range(SECOND_LOOKS + 8)}
    ranked = ranks(scores)
    assert [name for name, _ in ranked["a"]] == list(scores)[::-1]
    again = for_second_looks(ranked)
    assert [name for name in scores if "a" in again.get(name, ())] == list(scores)[8:]


def test_at_second_looks_a_scan_with_much_detail_keeps_some_of_its_lead():
    scores = {"detailed": {"a": 50.0, "b": 52.0}, "plain": {"a": 40.0, "b": 9.0}, "bare": {"a": 4.0, "b": 4.0}}
    assert [name for name, _ in ranks(scores, second=True)["a"]] == ["detailed", "plain", "bare"]
    assert ranks(scores)["a"][-1][0] == "detailed"


def test_what_both_looks_speak_for_and_what_the_first_one_does_are_tried_in_turn():
    # After the second look the first one counts by its fourth root: 1, 0.8 and 0.4.
    first = {"a": [("hall", 1.0), ("attic", 0.8**4), ("yard", 0.4), ("cellar", 0.4**4)]}
    second = {"a": [("cellar", 1.0), ("attic", 0.6), ("hall", 0.1)]}
    found = merged(first, second)["a"]
    assert [name for name, _ in found] == ["attic", "hall", "cellar", "yard"]
    assert [share for _, share in found] == pytest.approx([1.0, 0.4 / 0.48, 0.1 / 0.48, 0.0])


def test_a_part_of_an_archive_takes_photos_that_its_own_looks_speak_for():
    first = {"a": [(f"scan {number}", 1.0 - 0.01 * number) for number in range(6)]}
    strengths = {"scan 0": {"a": 1.0}, "scan 3": {"a": 40.0}, "scan 4": {"a": 2.0}}
    assert telling(first, strengths) == {"scan 0": ["a"], "scan 3": ["a"]}


def test_a_scan_with_much_detail_does_not_take_all_photos():
    scores = {"detailed": {"a": 50.0, "b": 52.0, "c": 48.0}, "plain": {"a": 1.0, "b": 1.0, "c": 9.0}}
    assert "c" in candidates(scores)["plain"]
    assert "c" not in candidates(scores)["detailed"]


def test_in_a_small_archive_every_photo_is_tried_what_looks_best_first():
    assert are_few(12, 20)
    assert are_few(1, ALL_PAIRS)
    assert not are_few(30, 40)
    scores = {"hall": {"a": 1.0, "b": 9.0, "c": 0.0}, "cellar": {"a": 9.0, "b": 0.0, "c": 0.0}}
    assert all_of_them(ranks(scores)) == {"hall": ["b", "a", "c"], "cellar": ["a", "b", "c"]}


# By its looks alone, "b" goes to the cellar.
_UNSURE = {"hall": {"a": 9.0, "b": 1.0, "c": 1.0}, "cellar": {"a": 1.0, "b": 3.0, "c": 1.0}}


def test_photos_taken_together_go_to_the_same_scan():
    assert "b" not in candidates(_UNSURE)["hall"]
    for moments in (
        {"a": Moment(seconds=0.0), "b": Moment(seconds=50.0)},
        {"a": Moment(latitude=50.0, longitude=8.0), "b": Moment(latitude=50.00005, longitude=8.0)},
    ):
        assert "b" in candidates(_UNSURE, moments)["hall"]
    for moments in (
        {"a": Moment(seconds=0.0), "b": Moment(seconds=5000.0)},
        {"a": Moment(latitude=50.0, longitude=8.0), "b": Moment(latitude=50.1, longitude=8.0)},
        {"a": Moment(), "b": Moment()},
    ):
        assert candidates(_UNSURE, moments) == candidates(_UNSURE)


def test_photos_that_overlap_go_to_the_same_scan():
    found = {photo: dict(own) for photo, own in ranks(_UNSURE, overlaps={"b": {"a", "not looked at"}}).items()}
    assert found["b"]["hall"] >= 0.4 > dict(ranks(_UNSURE)["b"])["hall"]
    assert found["a"] == dict(ranks(_UNSURE)["a"])


def test_a_scan_of_the_photos_day_comes_first():
    scores = {"hall": {"a": 3.0, "b": 1.0, "c": 1.0}, "cellar": {"a": 3.5, "b": 1.0, "c": 1.0}}
    taken, day = {"a": Moment(seconds=0.0)}, 86400.0
    assert "a" not in candidates(scores, taken, {"hall": 0.0, "cellar": 0.0})["hall"]
    assert "a" in candidates(scores, taken, {"hall": 0.0, "cellar": 30 * day})["hall"]


def taken_together(one, other):
    """By the times where both have one, else by their places: 60 seconds, 10 meters."""
    if one.seconds is not None and other.seconds is not None:
        return abs(one.seconds - other.seconds) <= 60
    if None in (one.latitude, one.longitude, other.latitude, other.longitude):
        return False
    north = (one.latitude - other.latitude) * 111_195
    east = (one.longitude - other.longitude) * 111_195 * np.cos(np.radians(one.latitude))
    return np.hypot(north, east) <= 10


places = st.none() | st.tuples(st.integers(0, 6), st.integers(0, 6))


@given(st.lists(st.tuples(st.none() | st.integers(0, 9), places), max_size=12))
def test_neighbors_are_those_that_comparing_each_with_each_finds(given_moments):
    moments = {}
    for number, (time, place) in enumerate(given_moments):
        latitude, longitude = (None, None) if place is None else (45 + 4.1e-5 * place[0], 8 + 4.1e-5 * place[1])
        seconds = None if time is None else 17.0 * time
        moments[f"{number:02}"] = Moment(seconds=seconds, latitude=latitude, longitude=longitude)
    neighbors = _Neighbors(moments)
    for photo, own in moments.items():
        expected = [other for other, its in moments.items() if other != photo and taken_together(own, its)]
        assert neighbors.of(photo) == expected


def test_a_second_look_takes_up_the_directions_of_the_first_one(tmp_path, monkeypatch):
    scan = random_scan(shape=(40, 60))
    write_ptx(scan, tmp_path / "a.ptx")
    gray = np.uint8(255 * (scan.reflectance - scan.reflectance.min()) / np.ptp(scan.reflectance))
    write_png(tmp_path / "a.png", np.kron(gray, np.ones((4, 4), np.uint8))[..., None].repeat(3, axis=2))
    (folder := BatchFolder(tmp_path / "colored")).make()
    files = [str(tmp_path / name) for name in ("a.ptx", "a.png")]
    request = {"folder": str(folder.root), "scans": files[:1], "photos": files[1:], "reading": ReadOptions().as_dict()}

    def looked(which, **hashes):
        whole = request | {"hashes": dict(zip(files, ("scan", "photo"), strict=True)) | hashes, "look": which}
        return look_at(whole, progress=lambda *_: None, cancelled=lambda: False)["scores"][files[1]]

    anew = looked(SECOND, **{files[1]: ""})
    assert looked(FIRST) > 0
    # Searched for anew, they would not be found.
    monkeypatch.setattr(two_looks, "Search", None)
    assert looked(SECOND) == anew


def test_a_first_look_takes_no_longer_where_a_scan_has_smaller_pixels(monkeypatch):
    # A first look correlates maps; how long that takes depends on their size.
    room, sizes, correlated = Room(1, "stones"), [], SphereMap._correlation

    def counted(self, spectra, *more):
        found = correlated(self, spectra, *more)
        sizes.append(found.size)
        return found

    monkeypatch.setattr(SphereMap, "_correlation", counted)
    # What is in the middle of the scan, enlarged: 36 degrees, 4 below the horizon.
    middle, looks = np.uint8(255 * np.clip(room.scan().reflectance[10:70, 35:95], 0, 1)), []
    photo = PhotoImage("photo", np.kron(middle, np.ones((4, 4), np.uint8))[..., None].repeat(3, axis=2))
    for finer in (1, 2):
        views = ScanViews(room.scan(80 * finer, 130 * finer, 0.6 / finer))
        sizes.clear()
        _, directions = two_looks.first_look(views, photo)
        looks.append(sum(sizes))
        # Score, focal length, yaw, pitch, roll, place.
        assert min(np.abs(np.subtract(found[1:5], [1.5, 0.0, -4.0, 0.0])).max() for found in directions) < 2
    assert looks[1] < 1.2 * looks[0]


@pytest.mark.parametrize(("wide", "step", "expected"), [(78, 0.6, 1), (78, 0.1, 2), (20, 0.05, 2), (20, 0.3, 1)])
def test_a_narrow_scan_is_looked_at_with_enough_pixels(wide, step, expected):
    columns = round(wide / step)
    views = ScanViews(Room(1).scan(columns // 2, columns, step))
    assert two_looks.coarseness(views) == expected
    assert wide / (views.step_deg * expected) >= min(0.99 * wide / step, 85)


def test_of_a_scan_of_few_rows_enough_are_left_to_look_at():
    whole = Room(1).scan(384, 520, 0.15)
    # Every third row and more, as a spinning lidar has few.
    for every, expected in ((1, 2), (3, 2), (4, 1), (12, 1)):
        kept = {key: getattr(whole, key)[::every] for key in ("points", "reflectance", "valid")}
        assert two_looks.coarseness(ScanViews(replace(whole, **kept, color=None))) == expected


def test_where_second_looks_find_next_to_nothing_for_most_photos_the_strongest_scan_comes_first():
    # Scans of little detail find nothing for most photos, and then little for one that they do not show.
    strengths = {"shown": {"a": 15.0, "b": 2.0, "c": 1.0}, "bare": {"a": 1.0, "b": 0.0, "c": 0.0}}
    assert [name for name, _ in ranks(strengths, second=True)["a"]] == ["shown", "bare"]
