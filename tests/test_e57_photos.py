"""Photos inside E57 files: listed, extracted, and placed where the file says if that place can be verified."""

import json

import cv2
import numpy as np
import painted_room
import pytest
from e57_samples import write_e57

from reflcolor_addon.cli.main import main
from reflcolor_addon.errors import ImageError
from reflcolor_addon.files.photo import Place
from reflcolor_addon.files.photo_files import photos_of
from reflcolor_addon.files.readers.e57_photos import photos_inside, read_photos
from reflcolor_addon.matching.models import Camera
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration import location
from reflcolor_addon.matching.registration.registration import Registration, ScanViews

PICTURE = np.random.default_rng(0).integers(0, 256, (40, 60, 3), np.uint8)
TURN = {"w": 0.5, "x": 0.5, "y": 0.5, "z": 0.5}
"""X to Y, Y to Z, Z to X."""

POSE = {"rotation": TURN, "translation": {"x": 1.0, "y": 2.0, "z": 3.0}}
GRID = {"rowIndex": np.repeat(np.arange(3), 4), "columnIndex": np.tile(np.arange(4), 3)}


def encoded(rgb, suffix=".png"):
    return cv2.imencode(suffix, rgb[..., ::-1])[1].tobytes()


def picture(tag, *, name="room", rgb=PICTURE, blob="pngImage", pose=POSE, **numbers):
    size = {"imageWidth": rgb.shape[1], "imageHeight": rgb.shape[0]}
    image = {"guid": "{1}", "name": name, tag: {blob: encoded(rgb), **size, **numbers}}
    return image | ({} if pose is None else {"pose": pose})


def pinhole(**given):
    return picture("pinholeRepresentation", focalLength=0.035, pixelWidth=0.001, pixelHeight=0.001, **given)


@pytest.fixture
def made(tmp_path):
    """A function that writes an E57 of one small scan and photos."""

    def make(*images):
        angle = np.radians(GRID["columnIndex"] * 2.0)
        rise = np.radians(10 - GRID["rowIndex"] * 2.0)
        points = {"cartesianX": np.cos(angle), "cartesianY": -np.sin(angle), "cartesianZ": np.tan(rise)}
        fields = points | {"intensity": np.linspace(0, 1, 12)} | GRID
        write_e57(tmp_path / "room.e57", {"fields": fields}, images=images)
        return tmp_path / "room.e57"

    return make


def test_every_kind_of_photo_is_listed(made):
    listed = photos_inside(
        made(pinhole(), picture("visualReferenceRepresentation", pose=None), picture("cylindricalRepresentation"))
    )
    assert [(photo.kind, photo.size, photo.usable) for photo in listed] == [
        ("pinhole", (60, 40), True),
        ("visual reference", (60, 40), True),
        ("cylindrical", (60, 40), False),
    ]
    assert len({photo.name for photo in listed}) == 3
    np.testing.assert_allclose(listed[0].pose[:3, 3], (1, 2, 3))
    assert listed[1].pose is None


def test_info_lists_them(made, capsys):
    path = made(pinhole(), picture("visualReferenceRepresentation", name="door", pose=None))
    assert main(["info", str(path)]) == 0
    told = capsys.readouterr().out
    assert f"2 photos inside; take colors from them by --photo {path}" in told
    assert "room door: visual reference, 60 x 40 pixels, no pose" in told
    assert main(["info", str(path), "--json"]) == 0
    assert [photo["kind"] for photo in json.loads(capsys.readouterr().out)["photos"]] == ["pinhole", "visual reference"]


def test_a_photo_comes_out_as_it_was_put_in_and_knows_its_camera(made):
    # Long enough to lie across pages of the file.
    (photo,) = photos_of(made(pinhole()))
    np.testing.assert_array_equal(photo.rgb, PICTURE)
    # A camera of E57 looks along -Z, with X to the right and Y up.
    turn = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
    np.testing.assert_allclose(photo.place.rotation, (turn @ np.diag([1, -1, -1])).T, atol=1e-12)
    np.testing.assert_array_equal(photo.place.center, (1, 2, 3))
    assert photo.place.focal_px == pytest.approx(35)


@pytest.mark.parametrize("wrong", [{"focalLength": 0.0}, {"imageWidth": 30}], ids=["no focal length", "another image"])
def test_a_camera_that_makes_no_sense_is_none(made, wrong):
    image = pinhole()
    image["pinholeRepresentation"] |= wrong
    (photo,) = photos_of(made(image))
    assert photo.place is None


def test_a_spherical_photo_becomes_pictures_of_a_right_angle(made):
    # The direction of every pixel is its color.
    azimuth = np.pi - (np.arange(400) + 0.5) * (2 * np.pi / 400)
    elevation = (np.pi / 2 - (np.arange(200) + 0.5) * (np.pi / 200))[:, None]
    ray = [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation) + 0 * azimuth]
    sphere = np.round((np.stack(ray, axis=-1) + 1) * 127.5).astype(np.uint8)
    steps = {"pixelWidth": 2 * np.pi / 400, "pixelHeight": np.pi / 200}
    photos = photos_of(made(picture("sphericalRepresentation", rgb=sphere, **steps)))
    assert [photo.name.split()[-1] for photo in photos] == ["front", "left", "back", "right", "up", "down"]
    turn = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
    for photo in photos:
        height, width = photo.rgb.shape[:2]
        x, y = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
        ray = np.stack([x, y, np.full(x.shape, photo.place.focal_px)], axis=-1) @ photo.place.rotation
        ray = ray / np.linalg.norm(ray, axis=-1, keepdims=True)
        # Rays of the place are the world's, colors are the camera's.
        away = np.abs((ray @ turn + 1) * 127.5 - photo.rgb)
        assert np.median(away) < 1 and np.percentile(away, 99) < 6


def test_what_is_no_image_is_left_out_and_told(made):
    broken = pinhole(name="broken")
    broken["pinholeRepresentation"]["pngImage"] = bytes(100)
    warnings = []
    assert len(photos_of(made(broken, pinhole()), warnings)) == 1
    assert "its photo room broken is left out" in warnings[0] and "\n" not in warnings[0]
    with pytest.raises(ImageError, match="holds no photo that can be used"):
        photos_of(made(broken))


def test_a_damaged_page_of_a_photo_is_told(made):
    noise = np.random.default_rng(1).integers(0, 256, (100, 100, 3), np.uint8)
    path = made(pinhole(rgb=noise))
    data = bytearray(path.read_bytes())
    start = data.index(b"\x89PNG")
    data[start + 5000] ^= 255
    path.write_bytes(data)
    warnings = []
    with pytest.raises(ImageError):
        photos_of(path, warnings)
    assert "a checksum does not match" in warnings[0]


def test_no_photo_and_no_seeds_points_to_those_inside(made, capsys):
    path = made(pinhole())
    assert main(["colorize", str(path), "-o", str(path.with_suffix(".png"))]) != 0
    assert f"room.e57 holds 1 of its own: --photo {path}" in capsys.readouterr().err


def test_a_place_in_the_frame_of_a_scanner():
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]], (5, 6, 7)
    place = Place(rotation=np.array([[0.0, 1, 0], [0, 0, -1], [-1, 0, 0]]), center=np.array([1.0, 2, 3]), focal_px=50)
    turn, center = place.seen_from(pose)
    point = np.array([0.3, -2.0, 0.7])
    world = pose[:3, :3] @ point + pose[:3, 3]
    np.testing.assert_allclose(turn @ (point - center), place.rotation @ (world - place.center), atol=1e-12)


@pytest.fixture(scope="module")
def stated():
    """A room, a photo of it, and the place of that photo in the world, a little off."""
    room = painted_room.scan(80, 120, 0.55, center=(0.3, -0.2, 0.1), yaw_deg=20.0)
    own = painted_room.camera((0.2, 0.1, 0.0), yaw_deg=4.0)
    off = painted_room.camera((0.25, 0.05, 0.05), yaw_deg=5.0)
    turn, place = room.pose[:3, :3], room.pose[:3, 3]
    return room, own, Place(rotation=off.rotation @ turn.T, center=turn @ off.center + place, focal_px=off.focal_px)


def test_a_place_that_is_nearly_right_is_a_start_that_is_tested(stated, monkeypatch):
    room, own, place = stated
    # Nothing is searched: the place of the file is enough.
    monkeypatch.setattr(location, "register", lambda *_, **__: pytest.fail("searched"))
    picture = painted_room.photo(Camera(*own_in_world(room, own)))
    found = located_on(room, PhotoImage("room", picture, place))
    assert found.verified and found.reason == "pose"
    np.testing.assert_allclose(found.registration.model.center, own.center, atol=0.03)


def test_a_place_is_not_believed_where_the_photo_shows_something_else(stated, monkeypatch):
    room, own, place = stated
    searched = []

    def register(*_, **__):
        searched.append(True)
        return Registration.nothing()

    monkeypatch.setattr(location, "register", register)
    blocks = np.random.default_rng(3).integers(0, 256, (23, 31, 3), np.uint8)
    picture = cv2.resize(blocks, (own.width, own.height), interpolation=cv2.INTER_NEAREST)
    assert not located_on(room, PhotoImage("something else", picture, place)).verified
    assert searched


def located_on(room, photo):
    (found,) = location.located([room], [ScanViews(room)], [None], photo, lambda text: None)
    return found


def own_in_world(room, own):
    turn, place = room.pose[:3, :3], room.pose[:3, 3]
    return own.rotation @ turn.T, turn @ own.center + place, own.focal_px, own.distortion, own.width, own.height


def test_a_cylindrical_photo_is_left_out_with_a_way_out(made):
    warnings = []
    read_photos(made(pinhole(), picture("cylindricalRepresentation", name="hall")), warnings)
    (told,) = map(str, warnings)
    assert "hall is left out: it is cylindrical; photos are compared" in told and "--photo" in told and "\n" not in told
