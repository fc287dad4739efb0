"""What a photo shows, as far as the scans that it was matched with say: one place."""

from dataclasses import replace

import numpy as np

from reflcolor_addon import Scan
from reflcolor_addon.batch.archive.claims import Claim, Verdict, verdict
from reflcolor_addon.batch.archive.places import camera_place, depth_map, likeness
from reflcolor_addon.batch.archive.tries import MOST_SCANS, Tries
from reflcolor_addon.matching.models import Camera

HALL = np.linspace(2.0, 6.0, 18 * 24).reshape(18, 24).tolist()
CELLAR = np.linspace(3.0, 1.0, 18 * 24).reshape(18, 24).tolist()


def claim(item, strength, depths=None, **more):
    return Claim(item=item, verified=True, strength=strength, depths=depths, **more)


def test_a_photo_shows_the_scan_that_it_is_verified_on():
    assert verdict([claim("hall", 30.0), Claim(item="cellar", verified=False, strength=29.0)]) == Verdict(
        shown=("hall",)
    )
    assert verdict([Claim(item="cellar", verified=False, strength=29.0)]) == Verdict()
    assert Verdict(shown=("hall",)).warning("a.jpg") is None


def test_of_two_places_only_the_one_that_is_clearly_better_is_shown():
    found = verdict([claim("cellar", 20.0, CELLAR), claim("hall", 60.0, HALL)])
    assert found == Verdict(shown=("hall",), refused=("cellar",))
    assert "only hall gets its colors" in str(found.warning("a.jpg"))
    assert str(found.doubt("cellar")).startswith("gives no colors here")
    assert "cellar" in found.doubt("hall") and not found.doubt("attic")


def test_where_no_place_is_clearly_better_none_is_shown():
    found = verdict([claim("cellar", 58.0, CELLAR), claim("hall", 60.0, HALL)])
    assert found == Verdict(refused=("hall", "cellar"))
    assert "write yes into pairs.csv" in str(found.warning("a.jpg"))
    assert "none is clearly right" in found.doubt("hall")


def test_scans_that_see_the_same_shape_may_all_be_shown():
    both = [claim("hall", 60.0, HALL), claim("hall again", 45.0, HALL), claim("cellar", 30.0, CELLAR)]
    assert verdict(both) == Verdict(shown=("hall", "hall again"), refused=("cellar",))
    # Rooms can be alike, but then less speaks for the wrong one.
    assert verdict([claim("hall", 60.0, HALL), claim("like it", 20.0, HALL)]).refused == ("like it",)


def test_a_person_decides_where_places_contradict_each_other():
    found = verdict([claim("cellar", 20.0, CELLAR, by_hand=True), claim("hall", 60.0, HALL)])
    assert found == Verdict(shown=("cellar",), refused=("hall",))


def test_poses_tell_whether_scans_that_see_different_parts_are_of_one_place():
    ahead = [0.0, 1.0, 0.0]
    left, right = HALL, CELLAR
    one, beside = [10.0, 5.0, 1.5, *ahead], [10.2, 5.1, 1.5, *ahead]
    far = [40.0, 5.0, 1.5, *ahead]
    assert not verdict([claim("a", 60.0, left, camera=one), claim("b", 50.0, right, camera=beside)]).refused
    assert verdict([claim("a", 60.0, left, camera=one), claim("b", 50.0, left, camera=far)]).refused


def test_the_shape_that_a_photo_shows_does_not_depend_on_where_the_scanner_stood():
    # A wall with steps, seen from two places; the camera stands at the first one.
    x, z = np.meshgrid(np.linspace(-2, 2, 80), np.linspace(1.5, -1.5, 60))
    wall = np.stack([x, 3 + np.floor(x), z], axis=-1)
    shift = np.array([0.5, -1.0, 0.25])
    here, there = (
        Scan(name="wall", points=points, reflectance=x.astype(np.float32), valid=np.ones(x.shape, bool))
        for points in (wall, wall - shift)
    )
    camera = Camera(np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), np.zeros(3), 60.0, 0.0, 80, 60)
    one, other = depth_map(here, camera), depth_map(there, replace(camera, center=-shift))
    assert likeness(one, other) == 1.0
    assert likeness(one, (2 * np.array(one, float)).tolist()) == 0.0
    assert likeness(one, [[None] * len(line) for line in one]) is None
    assert camera_place(here, camera) is None
    posed = replace(here, pose=np.array([[0, -1.0, 0, 7], [1, 0, 0, 8], [0, 0, 1, 9], [0, 0, 0, 1]]))
    assert camera_place(posed, camera) == [7, 8, 9, -1, 0, 0]


def rounds_of(tries, claims=None, beside=None):
    """All rounds, with these claims after the first: pairs of a photo and a scan."""
    rounds, found = [], {}
    while pairs := tries.next(found, beside or {}):
        rounds.append({(photo, name) for name, photos in pairs.items() for photo in photos})
        found = claims or {}
    return rounds


def count(rounds, photo):
    return sum(own == photo for pairs in rounds for own, _ in pairs)


# Many more pairs, so that the share of all that may be tried does not end the rounds.
_OTHERS = {f"other {photo}": [(f"other scan {number}", 1.0) for number in range(200)] for photo in range(30)}
_NAMES = [f"scan {number:02}" for number in range(20)]


def test_the_likeliest_pairs_are_matched_first_and_a_placed_photo_takes_few_more():
    ranks = {photo: [(name, 1.0 - 0.1 * k) for k, name in enumerate(_NAMES)] for photo in ("sure", "unsure")}
    claims = {"sure": [claim("scan 00", 80.0)], "unsure": [claim("scan 00", 30.0), claim("scan 05", 29.0)]}
    rounds = rounds_of(Tries(ranks | _OTHERS), claims)
    assert {("sure", "scan 00"), ("unsure", "scan 00")} < rounds[0] and len(rounds[0]) == len(ranks | _OTHERS)
    assert count(rounds, "unsure") == MOST_SCANS
    assert 1 < count(rounds, "sure") < MOST_SCANS / 2


def test_a_placed_photo_is_not_tried_on_scans_that_are_far_less_likely():
    ranks = {"a": [("hall", 1.0), ("cellar", 0.2)]}
    assert count(rounds_of(Tries(ranks | _OTHERS), {"a": [claim("hall", 80.0)]}), "a") == 1


def test_scans_of_the_place_that_a_photo_shows_are_tried_even_if_they_look_unlikely():
    ranks = {"a": [("hall", 1.0), ("cellar", 0.02), ("hall again", 0.01)]}
    rounds = rounds_of(Tries(ranks | _OTHERS), {"a": [claim("hall", 80.0)]}, {"hall": {"hall again"}})
    assert [pair for pairs in rounds for pair in pairs if pair[0] == "a"] == [("a", "hall"), ("a", "hall again")]


def test_a_few_photos_are_tried_on_several_scans_at_once():
    ranks = {photo: [(f"scan {number}", 1.0) for number in range(200)] for photo in "abc"}
    rounds = rounds_of(Tries(ranks))
    assert [len(pairs) for pairs in rounds] == [9, 9, 9]


def test_in_a_small_archive_a_photo_that_is_not_found_is_tried_on_all_scans():
    ranks = {"a": [(name, 1.0 / (k + 1)) for k, name in enumerate(_NAMES)]}
    assert count(rounds_of(Tries(ranks, few=True)), "a") == len(_NAMES)


def test_no_more_than_a_share_of_all_pairs_is_matched():
    ranks = {f"{photo}": [(f"scan {number}", 1.0) for number in range(30)] for photo in range(40)}
    assert sum(map(len, rounds_of(Tries(ranks)))) <= 0.15 * 1200
