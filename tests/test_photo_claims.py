"""What a photo shows, as far as all claims of a batch say: one place, and photos of one scan agree."""

from dataclasses import astuple, replace
from types import SimpleNamespace

import numpy as np

from reflcolor_addon import Scan
from reflcolor_addon.batch.archive.claims import Claim, Verdict
from reflcolor_addon.batch.archive.places import (
    Cells,
    agreement,
    alike,
    brightness_seen,
    camera_place,
    reflectance_seen,
)
from reflcolor_addon.batch.archive.verdicts import Verdicts
from reflcolor_addon.matching.models import Camera
from reflcolor_addon.matching.photo_image import PhotoImage


def cells(seed, noise=0.0):
    """What is seen of a place, in 24 x 18 cells, and something that was not there the other time."""
    seen = np.random.default_rng(seed).normal(size=(18, 24)) + noise * np.random.default_rng(99).normal(size=(18, 24))
    rows, cols = np.indices(seen.shape)
    return Cells.of(rows.ravel(), cols.ravel(), 24, seen.ravel())


HALL, HALL_AGAIN, CELLAR = cells(1), cells(1, noise=0.5), cells(2)


def claim(item, strength, reflectance=None, verified=True, evidence=1.0, **more):
    return Claim(item=item, verified=verified, strength=strength, evidence=evidence, reflectance=reflectance, **more)


def verdict(claims):
    return Verdicts({"a": claims}).by_photo().get("a", Verdict())


def test_a_photo_shows_the_scan_that_it_is_verified_on():
    assert verdict([claim("hall", 30.0), claim("cellar", 29.0, verified=False)]) == Verdict(shown=("hall",))
    assert verdict([claim("cellar", 29.0, verified=False)]) == Verdict()
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
    assert "write yes for the right scan into a copy of pairs.csv" in str(found.warning("a.jpg"))
    assert "none is clearly right" in found.doubt("hall")


def test_what_exceeds_the_evidence_needed_counts_for_more_than_what_barely_has_it():
    # On a scan whose walls repeat themselves wrong cameras are strong as well, and more is needed.
    found = verdict([claim("cellar", 56.0, CELLAR, evidence=1.0), claim("hall", 56.0, HALL, evidence=1.6)])
    assert found == Verdict(shown=("hall",), refused=("cellar",))
    assert not verdict([claim("cellar", 56.0, CELLAR, evidence=1.0), claim("hall", 56.0, HALL, evidence=1.4)]).shown


def test_scans_that_measured_the_same_reflectance_behind_a_photo_may_all_be_shown():
    both = [claim("hall", 60.0, HALL), claim("hall again", 25.0, HALL_AGAIN), claim("cellar", 30.0, CELLAR)]
    assert verdict(both) == Verdict(shown=("hall", "hall again"), refused=("cellar",))


def columns_of(seen, first, last):
    """What is seen in some columns of `cells` alone."""
    index, values = np.array(seen.index), np.array(seen.values)
    inside = (index % seen.across >= first) & (index % seen.across < last)
    return Cells(seen.across, index[inside].tolist(), values[inside].tolist())


def test_scans_that_see_different_parts_of_a_photo_may_all_be_shown():
    left, middle, right = columns_of(HALL, 0, 11), columns_of(HALL_AGAIN, 7, 17), columns_of(HALL, 13, 24)
    # Neighbors have four columns in common, the outer ones none.
    assert alike(left, middle) and alike(middle, right) and not alike(left, right)
    assert agreement(left, middle) is None
    claims = [claim("left", 60.0, left), claim("middle", 55.0, middle), claim("right", 50.0, right)]
    assert verdict(claims) == Verdict(shown=("left", "middle", "right"))
    assert verdict([claims[0], claims[2]]) == Verdict(refused=("left", "right"))
    # Of another place they are not alike there.
    assert not alike(columns_of(CELLAR, 0, 11), middle)
    # That a third one is like both does not count where they can be compared and differ.
    assert alike(HALL, CELLAR) is False and alike(left, right) is None
    between = claim("between", 60.0, camera=[0.4, 0.0, 0.0, 0.0, 1.0, 0.0, 4.0])
    far, farther = (replace(between, item=str(x), camera=[x, 0.0, 0.0, 0.0, 1.0, 0.0, 4.0]) for x in (0.0, 0.8))
    assert not verdict([between, far]).refused and not verdict([between, farther]).refused
    assert set(verdict([far, between, farther]).refused) == {"0.0", "0.8"}
    # One column is too little to tell.
    assert not alike(columns_of(HALL, 0, 8), columns_of(HALL, 7, 17))


def test_scans_that_are_neither_alike_nor_unlike_are_of_one_place_if_what_they_measured_fits():
    # As where a camera is a little off.
    mixed = replace(HALL, values=(0.35 * np.array(HALL.values) + 0.65 * np.array(CELLAR.values)).tolist())
    assert 0.2 < agreement(HALL, mixed) < 0.5 and alike(HALL, mixed) is None
    own = {"a": [claim("hall", 60.0, HALL, picture="here"), claim("hall again", 50.0, mixed, picture="again")]}
    assert not Verdicts(own).by_photo()["a"].shown
    for partners in ({"here": {"hall again"}}, {"again": {"hall"}}):
        assert Verdicts(own, partners=partners).by_photo()["a"].shown == ("hall", "hall again")
    # Or if another photo shows both.
    both = [claim("hall", 60.0, CELLAR), claim("hall again", 60.0, CELLAR)]
    assert Verdicts(own | {"b": both}).by_photo()["a"].shown == ("hall", "hall again")
    assert not Verdicts(own | {"b": both[:1]}).by_photo()["a"].shown
    # That does not help where they are unlike.
    own["a"][1] = replace(own["a"][1], reflectance=CELLAR)
    assert not Verdicts(own | {"b": both}, partners={"here": {"hall again"}}).by_photo()["a"].shown


def test_a_photo_for_whose_other_place_more_speaks_shows_none_unless_it_would_fit_elsewhere_as_well():
    other = claim("cellar", 50.0, CELLAR, verified=False)
    found = verdict([claim("hall", 30.0, HALL), other])
    assert found == Verdict(refused=("hall",), likelier=("cellar",))
    assert "more speaks for cellar" in str(found.warning("a.jpg")) and "more speaks for cellar" in found.doubt("hall")
    assert verdict([claim("hall", 34.0, HALL), other]).shown == ("hall",)
    assert verdict([claim("hall", 30.0, HALL), replace(other, repeats=True)]).shown == ("hall",)
    assert verdict([claim("hall", 30.0, HALL), replace(other, reflectance=HALL_AGAIN)]).shown == ("hall",)


def of_two_that_overlap(*claims, by_other, partners=None):
    """The verdict on a photo that overlaps another one, which is verified on some items."""
    found = {"a": list(claims), "b": [claim(item, strength, picture=item) for item, strength in by_other.items()]}
    return Verdicts(found, overlaps={"a": {"b"}}, partners=partners).by_photo()["a"]


def test_a_photo_gives_no_colors_where_one_that_overlaps_it_clearly_shows_another_place():
    barely, missed = claim("cellar", 30.0, CELLAR), claim("hall", 5.0, HALL, verified=False)
    assert verdict([barely, missed]).shown == ("cellar",)
    found = of_two_that_overlap(barely, missed, by_other={"hall": 41.0})
    assert found == Verdict(refused=("cellar",), likelier=("hall",))
    # Neither if that speaks for it not as clearly, nor if the photo was not tried there.
    assert of_two_that_overlap(barely, missed, by_other={"hall": 39.0}).shown == ("cellar",)
    # Nor if the photo has more evidence than wrong ones have.
    sure = claim("cellar", 15.0, CELLAR, evidence=2.0)
    assert of_two_that_overlap(replace(sure, evidence=1.9), missed, by_other={"hall": 60.0}).refused == ("cellar",)
    assert of_two_that_overlap(sure, missed, by_other={"hall": 60.0}).shown == ("cellar",)
    # What would fit elsewhere as well may be there, if a photo that overlaps it is.
    repeats = replace(missed, repeats=True)
    assert of_two_that_overlap(barely, repeats, by_other={"hall": 41.0}) == found
    assert of_two_that_overlap(barely, by_other={"hall": 90.0}).shown == ("cellar",)
    assert of_two_that_overlap(barely, missed, by_other={"attic": 90.0}).shown == ("cellar",)


def test_a_photo_that_was_refused_itself_or_for_which_less_speaks_refuses_no_other():
    barely, missed = claim("cellar", 30.0, CELLAR), claim("hall", 20.0, HALL, verified=False)
    assert of_two_that_overlap(barely, missed, by_other={"hall": 28.0}).shown == ("cellar",)
    wrong = [claim("hall", 60.0, HALL, photo="b.jpg"), claim("attic", 58.0, cells(3))]
    found = Verdicts({"a": [barely, missed], "b": wrong}, overlaps={"a": {"b"}, "b": {"a"}}).by_photo()
    assert found["a"].shown == ("cellar",) and not found["b"].shown


def test_photos_that_overlap_may_be_verified_on_different_scans_of_one_place():
    one = claim("hall again", 30.0, HALL_AGAIN, picture="again")
    missed = claim("hall", 20.0, CELLAR, verified=False)
    assert not of_two_that_overlap(one, missed, by_other={"hall": 60.0}).shown
    # That they are of one place is known from what the scans measured, or from a third photo.
    for known in ({"hall": {"hall again"}}, {"again": {"hall"}}):
        assert of_two_that_overlap(one, missed, by_other={"hall": 60.0}, partners=known).shown == ("hall again",)
    found = {"a": [one, missed], "b": [claim("hall", 60.0)]}
    found["c"] = [claim("hall", 60.0, HALL), claim("hall again", 60.0, HALL_AGAIN)]
    assert Verdicts(found, overlaps={"a": {"b"}}).by_photo()["a"].shown == ("hall again",)
    # Or from several, each of which shows two scans beside each other.
    found["c"] = [claim("hall", 60.0, HALL), claim("stairs", 60.0, HALL_AGAIN)]
    assert not Verdicts(found, overlaps={"a": {"b"}}).by_photo()["a"].shown
    found["d"] = [claim("stairs", 60.0, CELLAR), claim("hall again", 60.0, CELLAR)]
    assert Verdicts(found, overlaps={"a": {"b"}}).by_photo()["a"].shown == ("hall again",)
    # Or from a scan beside which the photo shows this one.
    beside = [one, missed, claim("stairs", 31.0, HALL_AGAIN)]
    found_beside = {**found, "a": beside, "d": []}
    assert set(Verdicts(found_beside, overlaps={"a": {"b"}}).by_photo()["a"].shown) == {"hall again", "stairs"}
    # But not from one that shows neither, because another place is clearly right.
    found["d"].append(claim("attic", 300.0, cells(3)))
    assert not Verdicts(found, overlaps={"a": {"b"}}).by_photo()["a"].shown


def test_what_a_look_saw_counts_where_a_match_found_less():
    other = claim("cellar", 15.0, CELLAR, verified=False)
    assert verdict([claim("hall", 31.0, HALL, looked=33.0), replace(other, looked=50.0)]).likelier == ("cellar",)
    # Looks are not exact: what is hardly more does not count.
    assert verdict([claim("hall", 31.0, HALL, looked=33.0), replace(other, looked=49.0)]).shown == ("hall",)
    assert verdict([claim("hall", 9.0, HALL, looked=45.0), replace(other, looked=11.0)]).shown == ("hall",)
    # Where one of both was not looked at, looks do not tell.
    assert verdict([claim("hall", 31.0, HALL), replace(other, looked=50.0)]).shown == ("hall",)


def test_a_person_decides_where_places_contradict_each_other():
    found = verdict([claim("cellar", 20.0, CELLAR, by_hand=True), claim("hall", 60.0, HALL)])
    assert found == Verdict(shown=("cellar",), refused=("hall",))


def on_the_hall(overlaps=None, **photos):
    """The verdicts on photos of one scan: of each how much speaks for it and what it shows."""
    claims = {
        name: [claim("hall", strength, photo=f"{name}.jpg", brightness=seen)]
        for name, (strength, seen) in photos.items()
    }
    return Verdicts(claims, overlaps=overlaps).by_photo()


def test_of_photos_that_show_a_part_of_a_scan_differently_the_one_that_is_clearly_better_colors_it():
    found = on_the_hall(a=(60.0, HALL), b=(30.0, CELLAR), c=(20.0, HALL_AGAIN))
    assert found["a"] == found["c"] == Verdict(shown=("hall",))
    assert found["b"] == Verdict(refused=("hall",), against={"hall": ("a.jpg", "c.jpg")})
    assert "does not fit a.jpg, c.jpg" in str(found["b"].warning("b.jpg"))
    assert "does not fit a.jpg, c.jpg" in found["b"].doubt("hall")


def test_of_photos_that_differ_and_are_equally_good_that_one_is_taken_which_another_agrees_with():
    assert not any(own.shown for own in on_the_hall(a=(60.0, HALL), b=(50.0, CELLAR)).values())
    found = on_the_hall(a=(50.0, HALL), b=(60.0, CELLAR), c=(45.0, HALL_AGAIN))
    assert found["a"].shown == found["c"].shown == ("hall",) and not found["b"].shown


def test_photos_that_overlap_do_not_speak_for_each_other_because_they_make_the_same_mistake():
    photos = {"a": (50.0, HALL), "b": (60.0, CELLAR), "c": (45.0, HALL_AGAIN)}
    for overlaps in ({"a": ["c"]}, {"c": ["a"]}):
        assert not any(own.shown for own in on_the_hall(overlaps, **photos).values())


def test_poses_tell_whether_scans_that_see_different_parts_are_of_one_place():
    ahead = [0.0, 1.0, 0.0, 4.0]
    left, right = HALL, CELLAR
    one, beside = [10.0, 5.0, 1.5, *ahead], [10.2, 5.1, 1.5, *ahead]
    far = [40.0, 5.0, 1.5, *ahead]
    assert not verdict([claim("a", 60.0, left, camera=one), claim("b", 50.0, right, camera=beside)]).refused
    assert verdict([claim("a", 60.0, left, camera=one), claim("b", 50.0, left, camera=far)]).refused


def wall(shift=0.0):
    """A wall with steps, painted at random, seen from one place, and as if the scanner stood elsewhere."""
    x, z = np.meshgrid(np.linspace(-2, 2, 160), np.linspace(1.5, -1.5, 120))
    paint = np.kron(np.random.default_rng(3).random((30, 40)), np.ones((4, 4))).astype(np.float32)
    points = np.stack([x, 3 + np.floor(x), z], axis=-1) - shift
    return Scan(name="wall", points=points, reflectance=paint, valid=np.ones(x.shape, bool))


AHEAD = Camera(np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), np.zeros(3), 120.0, 0.0, 160, 120)


def test_what_scans_measured_behind_a_photo_does_not_depend_on_where_the_scanner_stood():
    shift = np.array([0.5, -1.0, 0.25])
    here = reflectance_seen(wall(), AHEAD)
    assert agreement(here, reflectance_seen(wall(shift), replace(AHEAD, center=-shift))) > 0.99
    # The same shape, but of other paint.
    other = wall()
    other = replace(other, reflectance=other.reflectance[::-1])
    assert abs(agreement(here, reflectance_seen(other, AHEAD))) < 0.2
    assert agreement(here, None) is None
    assert agreement(here, Cells(here.across, here.index[:100], here.values[:100])) is None


def test_photos_of_a_scan_are_compared_where_both_show_it_whatever_their_exposure():
    scan = wall()
    gray = np.uint8(40 + 150 * scan.reflectance)[..., None].repeat(3, axis=2)
    straight = replace(AHEAD, center=np.array([0.0, 0.5, 0.0]))
    seen = [
        brightness_seen(scan, camera, SimpleNamespace(gray=(gain * gray[..., 0]).astype(np.float32)))
        for camera, gain in ((AHEAD, 1.0), (AHEAD, 0.4), (straight, 1.0))
    ]
    assert agreement(seen[0], seen[1]) > 0.99
    assert agreement(seen[0], seen[2]) < 0.5
    assert astuple(brightness_seen(scan, AHEAD, PhotoImage("a", gray))) == astuple(seen[0])


def test_the_place_of_a_camera_is_that_in_the_world():
    assert camera_place(wall(), AHEAD) is None
    posed = replace(wall(), pose=np.array([[0, -1.0, 0, 7], [1, 0, 0, 8], [0, 0, 1, 9], [0, 0, 0, 1]]))
    assert camera_place(posed, AHEAD)[:6] == [7, 8, 9, -1, 0, 0]
    assert 2 < camera_place(posed, AHEAD)[6] < 4
