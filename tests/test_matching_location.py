"""One photo on several scans of a site: it has one camera."""

from dataclasses import replace

import numpy as np
import painted_room
import pytest

from reflcolor_addon import Seeds
from reflcolor_addon.matching.opened_photos import opened_photos
from reflcolor_addon.matching.registration import location
from reflcolor_addon.matching.registration.registration import Registration, ScanViews

CAMERA = painted_room.camera((0.5, 0.3, 0.2), yaw_deg=6)


def pose(yaw_deg, x, y):
    turn = np.radians(yaw_deg)
    matrix = np.eye(4)
    matrix[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    matrix[:2, 3] = x, y
    return matrix


@pytest.fixture(scope="module")
def scans():
    return [painted_room.scan(name="first"), painted_room.scan(name="second", center=(1.0, 0.4, 0.0), yaw_deg=-10)]


@pytest.fixture(scope="module")
def views(scans):
    return [ScanViews(scan) for scan in scans]


@pytest.fixture(scope="module")
def photo():
    return opened_photos([painted_room.photo(CAMERA)])[0]


def in_frame_of(scan):
    """The true camera in the frame of a scan."""
    return location._carried(CAMERA, np.eye(4), scan.pose)


@pytest.fixture(scope="module")
def proof(scans, views, photo):
    """What speaks for the true camera."""
    return location.confirmed(views[0], photo, in_frame_of(scans[0])).evidence


def registration(model, proof, rank):
    """A registration whose evidence is of that rank."""
    return Registration(model, replace(proof, needed=proof.rank * proof.needed / rank), "search")


def registered(monkeypatch, models):
    """Have scans register to given ``Registration``s, and note which were searched."""
    searched = []

    def register(views, photo, *, step):
        searched.append(views.scan.name)
        return models[views.scan.name]

    monkeypatch.setattr(location, "register", register)
    return searched


def located(scans, views, photo):
    return location.located(scans, views, [None] * len(scans), photo, lambda text: None)


def test_a_camera_known_on_one_scan_is_carried_to_the_other(monkeypatch, scans, views, photo, proof):
    known = registration(CAMERA, proof, 5.0)
    searched = registered(monkeypatch, {"first": known})
    _, second = located(scans, views, photo)
    assert searched == ["first"]
    assert second.verified
    center = second.registration.model.center
    np.testing.assert_allclose(scans[1].pose[:3, :3] @ center + scans[1].pose[:3, 3], CAMERA.center, atol=0.05)


@pytest.mark.parametrize("order", [slice(None), slice(None, None, -1)])
def test_a_weak_camera_gives_way_to_the_surest(monkeypatch, scans, views, photo, proof, order):
    wrong = replace(in_frame_of(scans[1]), rotation=painted_room.camera(yaw_deg=60).rotation)
    strong = registration(CAMERA, proof, 5.0)
    weak = registration(wrong, proof, 1.2)
    registered(monkeypatch, {"first": strong, "second": weak})
    found = dict(zip(["first", "second"][order], located(scans[order], views[order], photo), strict=True))
    assert found["first"].registration.model is CAMERA
    assert found["second"].verified
    assert np.abs(found["second"].registration.model.rotation - in_frame_of(scans[1]).rotation).max() < 0.02


def test_a_weak_camera_that_nothing_confirms_is_dropped(monkeypatch, scans, views, photo, proof):
    moved = [scans[0], replace(scans[1], pose=pose(90, 40, 0))]
    strong = registration(CAMERA, proof, 5.0)
    weak = registration(in_frame_of(scans[1]), proof, 1.2)
    registered(monkeypatch, {"first": strong, "second": weak})
    first, second = located(moved, views, photo)
    assert first.verified
    assert not second.verified
    assert second.note == "shows first; too little of second to take colors from"


def test_what_is_wrong_with_picked_pairs_is_told_though_another_scan_places_the_photo(
    monkeypatch, scans, views, photo, proof
):
    wrong = replace(in_frame_of(scans[1]), rotation=painted_room.camera(yaw_deg=60).rotation)
    registered(monkeypatch, {"first": registration(CAMERA, proof, 5.0), "second": registration(wrong, proof, 1.2)})
    hand = Seeds([40, 80], [40, 80], [[1, 2, 3]] * 2, photos=("photo 1",) * 2, photo_xy=[[5, 5], [50, 50]])
    second, _ = location.located(scans[::-1], views[::-1], [hand, None], photo, lambda text: None)
    assert second.verified
    assert second.warnings == ("photo 1: 2 pairs picked by hand do not place it, at least 4 do",)


def test_where_poses_are_wrong_each_scan_that_is_beyond_doubt_counts(monkeypatch, scans, views, photo, proof):
    moved = [scans[0], replace(scans[1], pose=pose(90, 40, 0))]
    models = {scan.name: registration(in_frame_of(scan), proof, 5.0) for scan in scans}
    registered(monkeypatch, models)
    assert [found.verified for found in located(moved, views, photo)] == [True, True]


def test_without_poses_each_scan_is_searched(monkeypatch, scans, views, photo, proof):
    unposed = [replace(scan, pose=np.eye(4)) for scan in scans]
    models = {scan.name: registration(in_frame_of(scan), proof, 1.5) for scan in scans}
    searched = registered(monkeypatch, models)
    assert all(found.verified for found in located(unposed, views, photo))
    assert searched == ["first", "second"]
