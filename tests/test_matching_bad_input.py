"""Photos and settings that are odd: each gives a clear line or a sensible result."""

import cv2
import numpy as np
import painted_room
import pytest

from reflcolor_addon import ImageError, Settings
from reflcolor_addon.matching import draw_matches, match_photos, match_seeds
from reflcolor_addon.matching.opened_photos import opened_photos

AS_PUBLISHED = Settings(matching="paper", slic_segments=60)


@pytest.fixture(scope="module")
def room():
    return painted_room.scan(rows=60, columns=90, step_deg=0.6)


@pytest.fixture(scope="module")
def corner():
    return painted_room.scan(rows=20, columns=30, step_deg=1.8)


@pytest.fixture(scope="module")
def photo():
    return painted_room.photo(painted_room.camera(width=120, height=90))


def test_a_file_that_is_no_photo_is_refused_by_its_name(room, tmp_path):
    path = tmp_path / "broken.jpg"
    path.write_bytes(b"this is no photo")
    with pytest.raises(ImageError, match=r"broken\.jpg"):
        match_seeds(room, [path])


@pytest.mark.parametrize("kind", ["gray", "alpha", "16 bits"])
def test_a_gray_transparent_or_16_bit_file_is_taken_as_its_colors(room, photo, tmp_path, kind):
    path = tmp_path / "photo.png"
    written, expected = {
        "gray": (photo[..., 0], np.repeat(photo[..., :1], 3, axis=-1)),
        "alpha": (np.dstack([photo[..., ::-1], np.full(photo.shape[:2], 90, np.uint8)]), photo),
        "16 bits": (photo[..., ::-1].astype(np.uint16) * 257, photo),
    }[kind]
    assert cv2.imwrite(str(path), written)
    (opened,) = opened_photos([path])
    np.testing.assert_array_equal(opened.rgb, expected)
    assert len(match_seeds(room, [path], AS_PUBLISHED)) > 10


def test_a_black_and_white_photo_is_told(room, photo):
    gray = np.repeat(photo[..., :1], 3, axis=-1)
    matching = match_photos(room, [("old.png", gray), ("new.png", photo)], AS_PUBLISHED)
    assert matching.warnings == ("old.png: is black and white, it gives no colors",)


def test_two_photos_of_one_name_are_told_apart_by_their_folders_and_one_given_twice_is_refused(photo, tmp_path):
    paths = [tmp_path / folder / "photo.png" for folder in "ab"]
    for path in paths:
        path.parent.mkdir()
        assert cv2.imwrite(str(path), photo)
    assert [opened.name for opened in opened_photos(paths)] == ["a/photo.png", "b/photo.png"]
    with pytest.raises(ImageError, match=r"a.photo\.png: another photo has the same name; give each photo once"):
        opened_photos([paths[0], paths[0]])


@pytest.mark.slow
def test_two_hundred_megapixels_are_reduced_and_their_points_counted_in_full(room, photo):
    huge = cv2.resize(photo, (16384, 12288), interpolation=cv2.INTER_NEAREST)
    (opened,) = opened_photos([huge])
    assert opened.rgb.shape == (4500, 6000, 3)
    assert (opened.width, opened.height) == (16384, 12288)
    seeds = match_seeds(room, [huge], AS_PUBLISHED)
    assert seeds.photo_xy.max() > 6000
    assert (seeds.photo_xy < [16384, 12288]).all()
    assert draw_matches(room, [huge], seeds).shape[0] == 720


@pytest.mark.parametrize(("segments", "least", "most"), [(1, 1, 4), (20_000, 100, 600)])
def test_one_segment_or_more_than_pixels_give_seeds(corner, photo, segments, least, most):
    matching = match_photos(corner, [photo], Settings(slic_segments=segments, guess=True))
    assert least <= len(matching.seeds) <= most
    assert corner.valid[matching.seeds.rows, matching.seeds.cols].all()


def test_a_photo_of_sixteen_pixels_a_side_gives_seeds(corner):
    tiny = np.random.default_rng(0).integers(0, 255, (16, 16, 3), np.uint8)
    matching = match_photos(corner, [tiny], Settings(slic_segments=40, guess=True))
    assert not matching.photos[0].verified
    assert len(matching.seeds) > 10


def test_a_scan_of_few_pixels_cannot_be_tested_and_that_is_said(photo):
    scan = painted_room.scan(rows=12, columns=40, step_deg=1.5)
    matching = match_photos(scan, [photo], Settings(slic_segments=40))
    (report,) = matching.photos
    assert not report.verified
    assert not report.tested
    assert report.note.startswith("cannot be tested: the scan has ")
    assert any(
        warning.startswith("room: photo 1 cannot be tested (the scan has ") and "pairs by hand" in warning
        for warning in matching.warnings
    )


def test_a_photo_of_one_tone_cannot_be_tested(room):
    (report,) = match_photos(room, [np.full((90, 120, 3), 130, np.uint8)], Settings(slic_segments=40)).photos
    assert not report.tested
    assert report.note == "cannot be tested: the photo is of one tone"
