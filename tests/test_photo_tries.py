"""Which pairs of a photo and a scan are matched, and in which order."""

import pytest
from test_photo_claims import CELLAR, HALL, HALL_AGAIN, claim

from reflcolor_addon.batch.archive.tries import MOST_SCANS, Tries
from reflcolor_addon.batch.archive.verdicts import Verdicts


def rounds_of(ranks, claims=None, *, first=(), partners=None, few=False, strongest=None):
    """All rounds, with these claims and partners after the first: pairs of a photo and a scan."""
    tries, rounds, found = Tries(ranks, dict(first), few, strongest=strongest), [], Verdicts({})
    while pairs := tries.next(found, (partners or {}) if rounds else {}):
        rounds.append({(photo, name) for name, photos in pairs.items() for photo in photos})
        found = Verdicts(claims or {})
    return rounds


def count(rounds, photo):
    return sum(own == photo for pairs in rounds for own, _ in pairs)


# Many more pairs, so that the share of all that may be tried does not end the rounds.
_OTHERS = {f"other {photo}": [(f"other scan {number}", 1.0) for number in range(200)] for photo in range(30)}
_NAMES = [f"scan {number:02}" for number in range(20)]


def test_the_likeliest_pairs_are_matched_first_and_a_placed_photo_takes_few_more():
    ranks = {photo: [(name, 0.5**k) for k, name in enumerate(_NAMES)] for photo in ("sure", "unsure")}
    claims = {
        "sure": [claim("scan 00", 80.0, HALL, evidence=2.0)],
        "unsure": [claim("scan 00", 30.0, HALL, evidence=2.0), claim("scan 05", 29.0, CELLAR, evidence=2.0)],
    }
    rounds = rounds_of(ranks | _OTHERS, claims)
    assert {("sure", "scan 00"), ("unsure", "scan 00")} < rounds[0] and len(rounds[0]) == len(ranks | _OTHERS)
    assert count(rounds, "unsure") == MOST_SCANS
    assert 1 < count(rounds, "sure") < MOST_SCANS / 2


def test_what_was_barely_verified_is_tried_on_further_scans():
    ranks = {photo: [(name, 1.0) for name in _NAMES] for photo in ("sure", "unsure")}
    claims = {
        "sure": [claim("scan 00", 80.0, evidence=2.0)],
        "unsure": [claim("scan 00", 80.0, evidence=1.1)],
    }
    rounds = rounds_of(ranks | _OTHERS, claims)
    assert count(rounds, "sure") == 1 and count(rounds, "unsure") == MOST_SCANS


def test_a_photo_that_looks_like_many_scans_is_tried_on_more_of_them():
    ranks = {
        "plain": [(name, 1.0) for name in _NAMES],
        "clear": [("hall", 1.0), *((name, 0.001) for name in _NAMES)],
    }
    rounds = rounds_of(ranks | _OTHERS)
    after = [pair for pairs in rounds[1:] for pair in pairs]
    tries = {photo: [photo == own for own, _ in after].index(True) for photo in ranks}
    assert tries["plain"] < tries["clear"]


def test_scans_of_the_place_that_a_photo_shows_are_tried_even_if_they_look_unlikely():
    ranks = {"a": [("hall", 1.0), *((name, 1.0) for name in _NAMES), ("hall again", 0.0)], "b": [("hall", 1.0)]}
    both = [claim("hall", 80.0, HALL, evidence=2.0), claim("hall again", 80.0, HALL_AGAIN, evidence=2.0)]
    rounds = rounds_of(ranks | _OTHERS, {"a": [claim("hall", 80.0, HALL, evidence=2.0)], "b": both})
    assert [pair for pairs in rounds for pair in pairs if pair[0] == "a"] == [("a", "hall"), ("a", "hall again")]


def test_scans_that_measured_the_same_as_the_one_that_a_photo_shows_are_tried_even_if_they_look_unlikely():
    ranks = {"a": [("hall", 1.0), *((name, 1.0) for name in _NAMES), ("hall again", 0.0)]}
    found = {"a": [claim("hall", 80.0, HALL, evidence=2.0)]}
    assert count(rounds_of(ranks | _OTHERS, found), "a") == 1
    rounds = rounds_of(ranks | _OTHERS, found, partners={"a": {"hall", "hall again"}})
    assert {("a", "hall again")} == {pair for pair in rounds[1] if pair[0] == "a"}
    assert count(rounds, "a") == 2


def test_a_photo_for_which_looks_found_little_anywhere_is_tried_on_fewer_scans():
    strongest = {"little": 19.9, "enough": 20.0}
    ranks = {photo: [(name, 1.0) for name in _NAMES] for photo in (*strongest, "not looked at twice")}
    rounds = rounds_of(ranks | _OTHERS, strongest=strongest)
    assert count(rounds, "little") == 3
    assert count(rounds, "enough") == count(rounds, "not looked at twice") == MOST_SCANS


def test_a_photo_for_which_looks_found_little_is_tried_on_every_scan_of_its_place():
    ranks = {"little": [*((name, 1.0) for name in _NAMES), ("hall", 0.0), ("hall again", 0.0)]}
    tries = Tries(ranks | _OTHERS, {}, overlaps={"little": ["a"]}, strongest={"little": 6.0})
    while pairs := tries.next(Verdicts({}), {}):
        assert not {"hall", "hall again"} & pairs.keys()
    both = [claim("hall", 80.0, HALL, evidence=2.0), claim("hall again", 80.0, HALL_AGAIN, evidence=2.0)]
    pairs = tries.next(Verdicts({"a": both}), {})
    assert all("little" in pairs[name] for name in ("hall", "hall again"))


@pytest.mark.parametrize(("photos", "scans"), [(20, 20), (20, 16), (12, 26), (23, 14)])
def test_every_photo_is_tried_on_its_likeliest_scan_however_few_pairs_there_are(photos, scans):
    ranks = {f"{photo}": [(f"scan {(photo + k) % scans}", 1.0) for k in range(scans)] for photo in range(photos)}
    assert {(f"{photo}", f"scan {photo % scans}") for photo in range(photos)} <= set().union(*rounds_of(ranks))


def test_what_was_likeliest_at_the_first_look_is_tried_before_the_rest_unless_the_photo_was_found():
    ranks = {photo: [(name, 0.5**k) for k, name in enumerate(_NAMES)] for photo in ("lost", "found")}
    first = {photo: [("scan 19", 1.0), ("scan 00", 0.9)] for photo in ranks}
    rounds = rounds_of(ranks | _OTHERS, {"found": [claim("scan 00", 80.0, evidence=2.0)]}, first=first)
    assert {pair for pair in rounds[1] if pair[0] == "lost"} == {("lost", "scan 19")}
    assert not any(pair == ("found", "scan 19") for pairs in rounds for pair in pairs)


def test_a_few_photos_are_tried_on_several_scans_at_once():
    ranks = {photo: [(f"scan {number}", 1.0) for number in range(200)] for photo in "abc"}
    rounds = rounds_of(ranks)
    assert [len(pairs) for pairs in rounds] == [9, 9, 9]


def test_in_a_small_archive_a_photo_that_is_not_found_is_tried_on_all_scans():
    ranks = {"a": [(name, 1.0 / (k + 1)) for k, name in enumerate(_NAMES)]}
    assert count(rounds_of(ranks, few=True), "a") == len(_NAMES)


def test_in_a_small_archive_a_photo_that_was_found_is_tried_on_other_likely_scans():
    ranks = {"a": [(name, 1.0) for name in _NAMES[:6]]}
    found = {"a": [claim("scan 00", 80.0, HALL, evidence=2.0)]}
    assert count(rounds_of(ranks, found, few=True), "a") == 6
    assert count(rounds_of(ranks | _OTHERS, found), "a") == 1


def test_no_more_than_a_share_of_all_pairs_is_matched():
    ranks = {f"{photo}": [(f"scan {number}", 1.0) for number in range(30)] for photo in range(40)}
    assert sum(map(len, rounds_of(ranks))) <= 0.15 * 1200


def test_scans_that_another_photo_shows_to_be_of_one_place_are_tried_beyond_that_share():
    ranks = {f"{photo}": [(f"scan {number}", 1.0 / (number + 1)) for number in range(30)] for photo in range(40)}
    names = [f"scan {number}" for number in range(8)]
    found = {"0": [claim(name, 80.0, HALL, evidence=2.0) for name in names]}
    found |= {f"{photo}": [claim(names[0], 80.0, HALL, evidence=2.0)] for photo in range(1, 40)}
    rounds = rounds_of(ranks, found)
    assert {(photo, name) for photo in found if photo != "0" for name in names} <= set().union(*rounds)
    assert sum(map(len, rounds)) > 0.15 * 1200
