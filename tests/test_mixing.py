"""How much of a pixel's color kriging gives, and how much the paths."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon.color.mixing import Mixture, mixture, nearest_other, picked_by_a_person, unsmoothed_share

GOOD, BAD = np.full((500, 2), 0.1), np.tile([[3.0, -3], [-3, 3]], (250, 1))
APART = np.full(500, 32.0)


@given(st.lists(st.floats(0, 1e5, width=32), min_size=2), st.floats(0.01, 100))
def test_the_share_of_kriging_grows_with_the_distance_to_the_nearest_seed(distances, odds):
    shares = Mixture(odds).share(np.array(sorted(distances), np.float32))
    assert (np.diff(shares) >= 0).all() and (shares >= 0).all() and (shares <= 1).all()
    assert Mixture(odds).share(np.array([0.0, 32.0])) == pytest.approx([0, 1 / (1 + odds)])


def test_what_no_path_reaches_is_kriging_s():
    assert Mixture(1.0).share(np.array([np.inf]))[0] > 0.99


def test_it_goes_to_what_foretells_seeds_better_the_more_so_the_more_there_are():
    at = np.array([32.0])
    assert mixture(GOOD, BAD, APART, 0.5, 0).share(at) > 0.99
    assert mixture(BAD, GOOD, APART, 0.5, 0).share(at) < 0.1
    few = slice(4)
    assert 0.5 <= mixture(GOOD[few] * 20, BAD[few], APART[few], 0.5, 0).share(at) < 0.9


@pytest.mark.parametrize("expected", [0, 0.25, 0.6, 1])
def test_without_evidence_it_is_the_expected_one(expected):
    nothing = np.zeros((9, 2))
    share = mixture(nothing, nothing, APART[:9], expected, 0).share(np.array([32.0]))
    assert share == pytest.approx(expected)


def test_with_kriging_alone_even_a_seed_s_own_pixel_is_kriging_s():
    np.testing.assert_array_equal(mixture(GOOD, BAD, APART, 1, 0).share(np.array([0.0, 5.0])), [1, 1])


def test_where_near_seeds_foretell_by_paths_and_far_ones_by_kriging_both_get_their_pixels():
    apart = np.where(np.arange(500) < 250, 1.0, 1000.0)
    near = (apart == 1)[:, None]
    mixed = mixture(np.where(near, BAD, GOOD), np.where(near, GOOD, BAD), apart, 0.5, 0)
    low, high = mixed.share(np.array([1.0, 1000.0]))
    assert low < 0.3 and high > 0.7


def test_a_person_s_seeds_are_told_by_where_they_lie():
    steps = np.stack(np.meshgrid(np.arange(6.0), np.arange(6.0), [0.0]), axis=-1).reshape(-1, 3)
    uneven = steps**3
    far, near = np.full(36, 50.0), np.full(900, 5.0)
    assert picked_by_a_person(steps, far, near) == 0
    assert picked_by_a_person(uneven, far, near) == 1
    assert picked_by_a_person(uneven, far, np.full(900, 50.0)) == 0


@pytest.mark.parametrize("count", [1, 2])
def test_one_or_two_seeds_tell_nothing(count):
    apart = np.full(count, np.inf if count == 1 else 9.0)
    assert picked_by_a_person(np.eye(3)[:count], apart, np.array([1.0])) == 0


def test_seeds_that_pass_for_a_person_s_leave_the_pixels_to_the_paths():
    assert mixture(GOOD, BAD, APART, 0.6, 1).share(np.array([32.0])) < 0.05


# No seed, one seed that counts alone, two and three that are equally near.
WEIGHT = np.array([0, 1, 2, 3], np.float32)


def test_unsmoothed_paths_count_where_smoothed_ones_do_not_tell_a_person_s_seeds_apart():
    np.testing.assert_allclose(unsmoothed_share(WEIGHT, 1.0, GOOD, BAD), [0, 0, 3 / 4, 8 / 9], rtol=1e-6)
    np.testing.assert_allclose(unsmoothed_share(WEIGHT, 0.5, GOOD, BAD), [0, 0, 3 / 8, 4 / 9], rtol=1e-6)
    assert not unsmoothed_share(WEIGHT, 0.0, GOOD, BAD).any()


def test_unsmoothed_paths_take_over_sooner_where_they_foretell_left_out_seeds_better():
    shares = [unsmoothed_share(WEIGHT, 1.0, GOOD * factor, GOOD) for factor in (1.0, 1.02, 1.05, 2.0)]
    np.testing.assert_allclose(shares[0], [0, 0, 3 / 4, 8 / 9], rtol=1e-6)
    assert (shares[0][2:] < shares[1][2:]).all() and (shares[1][2:] < shares[2][2:]).all()
    np.testing.assert_allclose(shares[2], [0, 0, 1 - 2.0**-8, 1 - 3.0**-8], rtol=1e-6)
    np.testing.assert_array_equal(shares[3], shares[2])


def test_seeds_of_one_color_give_unsmoothed_paths_no_more():
    nothing = np.zeros((3, 2))
    np.testing.assert_allclose(unsmoothed_share(WEIGHT, 1.0, nothing, nothing), [0, 0, 3 / 4, 8 / 9], rtol=1e-6)


def test_a_seed_is_no_neighbor_of_its_own():
    distances, seeds = np.array([[0, 3, 9], [0, 3, np.inf]], np.float32), np.array([[0, 1, 2], [1, 0, -1]])
    np.testing.assert_array_equal(nearest_other(distances, seeds), [3, 3])
    np.testing.assert_array_equal(nearest_other(distances[:, :1], seeds[:, :1]), [np.inf, np.inf])
