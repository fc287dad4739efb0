"""Seeds from photos: what is verified, what is not, and what a person picked."""

from dataclasses import replace

import cv2
import numpy as np
import painted_room
import pytest

from reflcolor_addon import Cancelled, ImageError, Scan, Seeds, SeedsError, Settings, threads
from reflcolor_addon.matching import draw_matches, match_photos, match_seeds, match_site, site
from reflcolor_addon.matching.registration import location, registration
from reflcolor_addon.matching.registration.registration import Registration

FEW = Settings(slic_segments=150)


@pytest.fixture(scope="module")
def room():
    return painted_room.scan()


@pytest.fixture(scope="module")
def turned():
    return painted_room.photo(painted_room.camera(yaw_deg=12, pitch_deg=-9, focal=1.0))


@pytest.fixture(scope="module")
def noise():
    coarse = np.random.default_rng(5).uniform(0, 255, (12, 16, 3)).astype(np.uint8)
    return cv2.resize(coarse, (480, 360), interpolation=cv2.INTER_CUBIC)


@pytest.fixture(scope="module")
def matching(room, turned):
    return match_photos(room, [turned], FEW)


@pytest.fixture(scope="module")
def refused(room, noise):
    """What a photo of something else gives, with two pairs picked by hand, and the progress on the way."""
    hand = Seeds([40, 80], [40, 80], [[1, 2, 3]] * 2, photos=("photo 1",) * 2, photo_xy=[[5, 5], [50, 50]])
    fractions = []
    few = replace(FEW, guess=True)
    found = match_photos(room, [noise], few, hand=hand, progress=lambda fraction, text: fractions.append(fraction))
    return found, fractions


def chroma_error(seeds, scan):
    return np.abs(seeds.rgb.astype(int) - scan.color[seeds.rows, seeds.cols]).max(axis=1)


def test_a_photo_turned_on_the_spot_is_verified_and_its_seeds_have_the_true_color(matching, room):
    (report,) = matching.photos
    assert report.verified, report.note
    assert report.evidence >= 1
    assert matching.warnings == ()
    posed = np.array([reason in ("pose", "homography") for reason in matching.seeds.reason])
    assert posed.sum() > 50
    # A few lie at the border between two patches of paint.
    assert (chroma_error(matching.seeds, room)[posed] < 40).mean() > 0.85
    assert (matching.seeds.confidence[posed] > 0.4).all()


def test_every_pixel_that_the_photo_saw_has_its_true_color(matching, room):
    observed = matching.observed
    assert observed.seen.sum() > 0.5 * room.valid.sum()
    error = np.abs(observed.rgb.astype(int) - room.color).max(axis=-1)[observed.seen]
    # Off by much only at the borders between patches.
    assert np.median(error) <= 3 and (error < 40).mean() > 0.85
    assert not observed.seen[~room.valid].any()


def test_a_photo_that_is_not_verified_gives_no_observed_color(refused):
    matching, _ = refused
    assert matching.observed is None


def test_for_a_photo_that_is_not_verified_no_superpixels_are_computed(room, monkeypatch):
    monkeypatch.setattr(site, "scan_superpixels", None)
    of_one_tone = np.full((48, 64, 3), 90, np.uint8)
    assert len(match_seeds(room, [of_one_tone], FEW)) == 0


def test_seeds_lie_on_pixels_with_a_return_one_per_superpixel(matching, room):
    seeds = matching.seeds
    assert room.valid[seeds.rows, seeds.cols].all()
    assert len(set(zip(seeds.rows.tolist(), seeds.cols.tolist(), strict=True))) == len(seeds)
    assert len(seeds) <= 2 * FEW.slic_segments


@pytest.mark.slow
def test_the_same_input_gives_the_same_seeds_whatever_the_thread_count(monkeypatch, matching, room, turned):
    of_opencv = cv2.getNumThreads()
    other = 1 if threads.thread_count() > 1 else 2
    monkeypatch.setattr(threads, "thread_count", lambda: other)
    try:
        cv2.setNumThreads(1)
        again = match_seeds(room, [turned], FEW)
    finally:
        cv2.setNumThreads(of_opencv)
    for field in ("rows", "cols", "rgb", "photo_xy", "confidence"):
        np.testing.assert_array_equal(getattr(again, field), getattr(matching.seeds, field))
    assert again.reason == matching.seeds.reason


def test_an_unrelated_photo_is_refused_said_so_and_no_worse_than_its_mean_color(refused, noise):
    matching, _ = refused
    assert not matching.photos[0].verified
    assert 0 <= matching.photos[0].evidence < 1
    assert any("could not be verified" in warning for warning in matching.warnings)
    mean = noise.reshape(-1, 3).mean(axis=0)
    found = matching.seeds.rgb[np.array(matching.seeds.reason) == "appearance"]
    assert np.median(np.abs(found - mean).max(axis=1)) <= 12
    assert len(found) > 50


@pytest.mark.slow
def test_an_unrelated_photo_gives_no_seeds_unless_guesses_are_wanted(room, noise):
    hand = Seeds([40], [40], [[1, 2, 3]])
    for picked, expected in ((None, ()), (hand, ("hand",))):
        matching = match_photos(room, [noise], FEW, hand=picked)
        assert matching.seeds.reason == expected
        assert "no photo could be verified, so there are no seeds" in matching.warnings[-1]


def test_two_pairs_are_too_few_and_the_warning_says_how_many_it_takes(refused):
    matching, _ = refused
    assert any("at least 4" in warning for warning in matching.warnings)
    assert matching.seeds.reason[:2] == ("hand", "hand")


def test_progress_rises_to_the_end(refused):
    _, fractions = refused
    assert fractions == sorted(fractions)
    assert fractions[0] == 0
    assert fractions[-1] == 1


def test_cancelling_ends_the_work(room, noise):
    with pytest.raises(Cancelled):
        match_seeds(room, [noise], FEW, cancelled=lambda: True)


def test_six_pairs_picked_by_hand_place_a_photo_from_the_side(room):
    camera = painted_room.camera((1.9, 1.2, 0.4), yaw_deg=-32)
    photo = painted_room.photo(camera)
    xy, _ = camera.project(room.points)
    inside = room.valid & (xy > 10).all(axis=-1) & (xy < [470, 350]).all(axis=-1)
    rows, cols = np.argwhere(inside)[:: inside.sum() // 7][:6].T
    hand = Seeds(rows, cols, room.color[rows, cols], photos=("photo 1",) * 6, photo_xy=xy[rows, cols])
    matching = match_photos(room, [photo], FEW, hand=hand)
    (report,) = matching.photos
    assert report.verified
    assert report.reason == "hand"
    assert matching.seeds.reason[:6] == ("hand",) * 6
    np.testing.assert_array_equal(matching.seeds.rgb[:6], hand.rgb)
    posed = np.array([reason == "pose" for reason in matching.seeds.reason])
    assert posed.sum() > 20
    assert (chroma_error(matching.seeds, room)[posed] < 40).mean() > 0.8


@pytest.mark.slow
def test_pairs_that_place_a_photo_where_it_shows_nothing_are_told(room, noise):
    # From below the floor and behind the wall only their backs are seen.
    camera = painted_room.camera((0.0, 9.0, -9.0), yaw_deg=180, pitch_deg=50)
    xy, depth = camera.project(room.points)
    inside = room.valid & (depth > 0) & (xy > 10).all(axis=-1) & (xy < [470, 350]).all(axis=-1)
    rows, cols = np.argwhere(inside)[:: inside.sum() // 7][:6].T
    hand = Seeds(rows, cols, room.color[rows, cols], photos=("photo 1",) * 6, photo_xy=xy[rows, cols])
    matching = match_photos(room, [noise], FEW, hand=hand)
    assert not matching.photos[0].verified
    assert matching.photos[0].note.endswith("so placed, it shows nothing of the scan")
    assert "room: photo 1, so placed, shows nothing of the scan; check the pairs, and add some far from the others" in (
        matching.warnings
    )
    assert "pose" not in matching.seeds.reason


@pytest.mark.slow
def test_a_pair_that_does_not_fit_is_named(room):
    camera = painted_room.camera((0.9, 0.3, 0.2), yaw_deg=-9)
    xy, _ = camera.project(room.points)
    inside = room.valid & (xy > 10).all(axis=-1) & (xy < [470, 350]).all(axis=-1)
    rows, cols = np.argwhere(inside)[:: inside.sum() // 8][:8].T
    picked = xy[rows, cols]
    picked[2] = (picked[2] + [170, 120]) % [480, 360]
    hand = Seeds(rows, cols, room.color[rows, cols], photos=("photo 1",) * 8, photo_xy=picked)
    matching = match_photos(room, [painted_room.photo(camera)], FEW, hand=hand)
    place = f"row {rows[2]}, column {cols[2]}"
    assert f"photo 1: pair 3 ({place}) does not fit the others; its color is kept, check it" in matching.warnings


def test_kept_seeds_stay_as_they_are_and_nothing_is_found_on_their_pixels(matching, room, turned):
    found = matching.seeds
    kept = Seeds(
        found.rows[:3],
        found.cols[:3],
        [[1, 2, 3]] * 3,
        confidence=[0.3, 0.5, np.nan],
        reason=("pose", "appearance", None),
    )
    hand = Seeds(found.rows[2:4], found.cols[2:4], [[9, 9, 9]] * 2)
    seeds = match_seeds(room, [turned], Settings(matching="paper", slic_segments=150), hand=hand, kept=kept)
    assert seeds.reason[:4] == ("hand", "hand", "pose", "appearance")
    np.testing.assert_array_equal(seeds.rgb[:4], [[9, 9, 9]] * 2 + [[1, 2, 3]] * 2)
    np.testing.assert_array_equal(seeds.confidence[:4], [1, 1, 0.3, 0.5])
    assert len(set(zip(seeds.rows.tolist(), seeds.cols.tolist(), strict=True))) == len(seeds)
    assert len(seeds) > 100


@pytest.mark.slow
def test_scans_of_a_site_share_what_they_learn(room, turned):
    unseen = painted_room.scan(rows=40, columns=40, step_deg=0.5, name="corner")
    unseen = replace(unseen, points=unseen.points[:, ::-1] * [1, -1, 1], pose=np.diag([1.0, -1, 1, 1]))
    first, second = match_site([room, unseen], [turned], replace(FEW, guess=True))
    assert first.photos[0].verified
    assert len(second.seeds) > 0


def test_a_scan_that_no_photo_shows_is_guessed_from_the_others_and_told(monkeypatch, room, turned):
    # Here the reflectance tells the color, red for bright and blue for dark.
    def two_tones(rgb):
        return np.where(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY) > 140, 210, 50).astype(np.uint8)

    room = replace(room, reflectance=two_tones(room.color).astype(np.float32))
    gray = two_tones(turned)
    photo = np.dstack([gray, np.full_like(gray, 90), 255 - gray])

    def register(views, photo, *, step):
        return registration.register(views, photo, step=step) if views.scan is room else Registration.nothing()

    monkeypatch.setattr(location, "register", register)
    first, second = match_site([room, replace(room, name="copy")], [photo], FEW)
    assert first.photos[0].verified
    assert set(second.seeds.reason) == {"appearance"}
    assert second.warnings[-1] == "copy: no photo shows it; all its colors are guessed from the other scans"


def test_a_scan_with_one_percent_of_returns_gives_seeds(room, turned):
    valid = room.valid & (np.random.default_rng(0).random(room.shape) < 0.01)
    sparse = Scan(name="sparse", points=room.points, reflectance=room.reflectance, valid=valid)
    seeds = match_seeds(sparse, [turned], replace(FEW, guess=True))
    assert len(seeds) > 0
    assert valid[seeds.rows, seeds.cols].all()


@pytest.mark.parametrize("matching", ["paper", "verified"])
def test_a_photo_of_one_color_gives_that_color(room, matching):
    photo = np.full((90, 120, 3), (200, 120, 40), np.uint8)
    seeds = match_seeds(room, [photo], Settings(matching=matching, slic_segments=60))
    assert (np.abs(seeds.rgb.astype(int) - [200, 120, 40]) <= 1).all()


def test_a_tiny_photo_is_refused_in_one_line(room):
    with pytest.raises(ImageError, match=r"photo 1: has 8 x 4 pixels, expected at least 16 on each side"):
        match_seeds(room, [np.zeros((4, 8, 3), np.uint8)])


def test_a_gray_array_is_refused_in_one_line(room):
    with pytest.raises(ImageError, match=r"photo 1: expected \(H, W, 3\) uint8"):
        match_seeds(room, [np.zeros((40, 80), np.uint8)])


def test_a_missing_photo_is_refused_by_its_name(room, tmp_path):
    with pytest.raises(ImageError, match=r"gone\.jpg"):
        match_seeds(room, [tmp_path / "gone.jpg"])


def test_no_photo_at_all_is_refused(room):
    with pytest.raises(SeedsError, match="no photo"):
        match_seeds(room, [])


def test_a_scan_without_a_return_is_refused(turned):
    nothing = np.zeros((20, 30))
    scan = Scan(name="empty", points=np.zeros((20, 30, 3)), reflectance=nothing, valid=nothing.astype(bool))
    with pytest.raises(SeedsError, match="empty: no pixel has a return"):
        match_seeds(scan, [turned])


def test_reason_and_confidence_survive_saving(matching, tmp_path):
    matching.seeds.save(tmp_path / "found.json")
    loaded = Seeds.load(tmp_path / "found.json")
    assert loaded.reason == matching.seeds.reason
    np.testing.assert_allclose(loaded.confidence, matching.seeds.confidence, atol=5e-4)


def test_matches_are_drawn_with_scan_and_photo_side_by_side(matching, room, turned):
    drawing = draw_matches(room, [turned], matching.seeds)
    assert drawing.dtype == np.uint8
    assert drawing.shape[0] == 720
    # Lines of verified seeds.
    assert (drawing == (60, 200, 90)).all(axis=-1).any() or (drawing == (60, 160, 240)).all(axis=-1).any()
