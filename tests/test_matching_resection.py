"""A photo that cannot be placed by itself is placed by what it has in common with another one."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.rooms import Room
from reflcolor_addon import Seeds, match_photos
from reflcolor_addon.matching.models import GridHomography
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration import location
from reflcolor_addon.matching.registration.registration import Registration, ScanViews
from reflcolor_addon.matching.registration.resection import overlapping, placed_by, resected
from reflcolor_addon.matching.registration.stored import as_document, from_document
from reflcolor_addon.settings import Settings

# Of this room the second photo shows a part that repeats itself: by itself it is not verified.
ROOM, KNOWN, SOUGHT = Room(11024), 37, 14


@pytest.fixture(scope="module")
def scan():
    return ROOM.scan()


@pytest.fixture(scope="module")
def views(scan):
    return ScanViews(scan)


@pytest.fixture(scope="module")
def placed(views):
    """The registration of the photo that is sought by the other one."""
    return placed_by(views, photo(SOUGHT), [(photo(KNOWN), ROOM.camera(KNOWN))])


def photo(number, room=ROOM, size=(240, 180)):
    return PhotoImage(f"{number}.jpg", room.photo(number, *size))


def away(camera, scan, number):
    """How far off a camera puts what a photo shows, the median as a share of its width."""
    right = ROOM.camera(number, camera.width, camera.height)
    points = scan.points[scan.valid]
    xy, depth = right.project(points)
    seen = (depth > 0) & (xy >= 0).all(axis=1) & (xy < [right.width, right.height]).all(axis=1)
    return np.median(np.hypot(*(camera.project(points[seen])[0] - xy[seen]).T)) / right.width


def test_the_camera_follows_from_what_both_photos_show(scan):
    camera, count = resected(scan, photo(SOUGHT), photo(KNOWN), ROOM.camera(KNOWN))
    assert count > 100 and away(camera, scan, SOUGHT) < 0.005


def test_photos_of_other_sizes_serve_as_well(scan):
    camera, count = resected(scan, photo(SOUGHT, size=(480, 360)), photo(KNOWN), ROOM.camera(KNOWN))
    assert (camera.width, camera.height) == (480, 360)
    assert count > 50 and away(camera, scan, SOUGHT) < 0.01


def test_photos_of_different_rooms_have_no_camera_in_common(scan):
    assert resected(scan, photo(1, Room(2)), photo(KNOWN), ROOM.camera(KNOWN)) == (None, 0)
    gray = PhotoImage("gray", np.full((180, 240, 3), 90, np.uint8))
    assert resected(scan, gray, photo(KNOWN), ROOM.camera(KNOWN)) == (None, 0)


def test_a_model_that_sees_nothing_of_the_scan_places_nothing(scan):
    elsewhere = replace(ROOM.camera(KNOWN), rotation=np.diag([-1.0, 1, -1]) @ ROOM.camera(KNOWN).rotation)
    assert resected(scan, photo(SOUGHT), photo(KNOWN), elsewhere) == (None, 0)
    narrow = replace(scan, valid=scan.valid & (np.arange(scan.shape[1]) < 3))
    assert resected(narrow, photo(SOUGHT), photo(KNOWN), ROOM.camera(KNOWN)) == (None, 0)


def test_places_in_a_line_give_no_camera(scan):
    line = replace(scan, points=scan.points * np.where(scan.valid, 1, 0)[..., None] * [1e-9, 1.0, 1e-9])
    camera, count = resected(line, photo(SOUGHT), photo(KNOWN), GridHomography(np.eye(3), scan.shape, 240, 180))
    assert camera is None and count == 0


def test_overlapping_photos_come_first_that_agree_best():
    others = [photo(1, Room(2)), photo(15), photo(KNOWN)]
    near = overlapping(photo(SOUGHT), others)
    assert sorted(near) == [1, 2]
    assert overlapping(photo(SOUGHT), []) == []


def test_it_must_pass_the_test_of_a_camera_that_was_searched_for(scan, views, placed):
    assert placed.accepted and placed.beside == f"{KNOWN}.jpg" and placed.evidence.needed >= 7
    assert away(placed.model, scan, SOUGHT) < 0.005
    # The other photo's camera is turned by 5 degrees: so is what follows from it.
    turn = np.radians(5.0)
    turned = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    wrong = replace(ROOM.camera(KNOWN), rotation=turned @ ROOM.camera(KNOWN).rotation)
    # With the right one after it, it is placed all the same.
    both = placed_by(views, photo(SOUGHT), [(photo(KNOWN), wrong), (photo(KNOWN), ROOM.camera(KNOWN))])
    assert away(both.model, scan, SOUGHT) < 0.005


def test_it_is_stored_with_the_name_of_the_other_photo(placed):
    again = from_document(as_document(placed))
    assert again.beside == f"{KNOWN}.jpg" and again.accepted


def test_what_is_accepted_is_preferred_whatever_its_rank(placed):
    accepted = placed
    refused = replace(accepted, evidence=replace(accepted.evidence, deviations=1000.0, elsewhere=1.0))
    assert not refused.accepted and refused.better_than(accepted)
    assert accepted.preferable_to(refused) and not refused.preferable_to(accepted)
    assert not Registration.nothing().preferable_to(refused) and accepted.preferable_to(Registration.nothing())


def test_pairs_picked_in_one_photo_place_another_one_too(scan, monkeypatch):
    # By itself it is searched for in vain, which takes long.
    monkeypatch.setattr(location, "register", lambda views, photo, *, step: Registration.nothing())
    camera = ROOM.camera(KNOWN)
    rows, cols = np.nonzero(scan.valid)
    xy, depth = camera.project(scan.points[rows, cols])
    inside = np.flatnonzero((depth > 0) & (xy > 20).all(axis=1) & (xy < [220, 160]).all(axis=1))
    chosen = inside[np.linspace(0, len(inside) - 1, 8).astype(int)]
    hand = Seeds(
        rows=rows[chosen],
        cols=cols[chosen],
        rgb=np.full((8, 3), 100, np.uint8),
        photos=("known",) * 8,
        photo_xy=xy[chosen],
        confidence=np.ones(8),
        reason=("hand",) * 8,
    )
    photos = [("sought", ROOM.photo(SOUGHT)), ("known", ROOM.photo(KNOWN))]
    matching = match_photos(scan, photos, Settings(slic_segments=60), hand=hand)
    found = {own.name: own for own in matching.photos}
    assert found["known"].verified and found["known"].reason == "hand"
    assert found["sought"].verified and found["sought"].reason == "pose"
    assert "known" in str(found["sought"].note)
    assert away(found["sought"].model, scan, SOUGHT) < 0.01
    assert not any("sought" in str(warning) for warning in matching.warnings)
