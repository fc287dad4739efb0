"""Kriging of chrominance from seeds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon import Scan
from reflcolor_addon.color import kriging
from reflcolor_addon.color.kriging import FEATURES, Kriging, pixel_features
from reflcolor_addon.errors import Cancelled
from reflcolor_addon.native.kriging import exponential_sums
from reflcolor_addon.native.library import Control

seed_counts = st.integers(1, 40)


def random_seeds(count, generator):
    return generator.normal(size=(count, FEATURES)), generator.uniform(-60, 60, (count, 2))


@given(count=seed_counts, number=st.integers(0, 2**32 - 1))
def test_residuals_are_those_of_fitting_without_the_seed(count, number):
    """The closed form against leaving out in earnest, with the mean and the nuggets of the whole."""
    features, colors = random_seeds(count, np.random.default_rng(number))
    distances = np.linalg.norm(features[:, None] - features, axis=-1)
    nuggets = np.random.default_rng(number).uniform(0.02, 0.5, count)
    covariance = np.exp(-distances)
    matrix = covariance + np.diag(nuggets)
    one = np.linalg.solve(matrix, np.ones(count))
    mean = one @ colors / one.sum()
    residuals, _ = kriging._residuals(covariance, colors, nuggets)
    for seed in range(count):
        others = np.delete(np.arange(count), seed)
        weights = np.linalg.solve(matrix[np.ix_(others, others)], colors[others] - mean)
        estimate = mean + covariance[seed, others] @ weights
        assert residuals[seed] == pytest.approx(colors[seed] - estimate, abs=1e-6)


@given(count=seed_counts, number=st.integers(0, 2**32 - 1))
def test_seeds_of_one_color_give_that_color_everywhere(count, number):
    generator = np.random.default_rng(number)
    features, _ = random_seeds(count, generator)
    model = Kriging(features, np.full((count, 2), (12.0, -7.0)))
    assert model.estimate(generator.normal(size=(50, FEATURES))) == pytest.approx(
        np.broadcast_to((12.0, -7.0), (50, 2)), abs=1e-6
    )


@given(count=seed_counts, number=st.integers(0, 2**32 - 1))
def test_the_order_of_the_seeds_does_not_matter(count, number):
    generator = np.random.default_rng(number)
    features, colors = random_seeds(count, generator)
    order, pixels = generator.permutation(count), generator.normal(size=(20, FEATURES))
    turned = Kriging(features[order], colors[order])
    assert turned.estimate(pixels) == pytest.approx(Kriging(features, colors).estimate(pixels), abs=1e-3)


@given(
    count=st.integers(1, 300), pixels=st.integers(1, 200), channels=st.integers(1, 4), number=st.integers(0, 2**32 - 1)
)
def test_the_kernels_sums_are_those_of_double_precision(count, pixels, channels, number):
    generator = np.random.default_rng(number)
    features, seeds = (generator.normal(size=(n, FEATURES)).astype(np.float32) for n in (pixels, count))
    weights = generator.uniform(-100, 100, (count, channels)).astype(np.float32)
    shares = np.exp(-np.linalg.norm(features[:, None].astype(np.float64) - seeds, axis=-1))
    sums = exponential_sums(features, seeds, weights)
    assert (np.abs(sums - shares @ weights) < 1e-5 * (shares @ np.abs(weights))).all()


def test_an_estimate_does_not_depend_on_the_pixels_beside_it():
    generator = np.random.default_rng(3)
    features, colors = random_seeds(300, generator)
    model, pixels = Kriging(features, colors), generator.normal(size=(200, FEATURES)).astype(np.float32)
    alone = np.concatenate([model.estimate(pixels[start : start + 1]) for start in range(len(pixels))])
    assert np.array_equal(model.estimate(pixels), alone)


def test_sums_of_the_wrong_shape_or_that_are_cancelled_are_none():
    with pytest.raises(ValueError, match="expected"):
        exponential_sums(np.zeros((1, 7)), np.zeros((1, 8)), np.zeros((1, 2)))
    control = Control()
    control.cancel()
    with pytest.raises(Cancelled):
        exponential_sums(np.zeros((1, 8)), np.zeros((1, 8)), np.zeros((1, 2)), control)


def test_far_from_every_seed_the_mean_is_estimated_and_near_one_about_its_color():
    generator = np.random.default_rng(4)
    features, colors = 20 * generator.normal(size=(30, FEATURES)), generator.uniform(-60, 60, (30, 2))
    model = Kriging(features, colors)
    far, near = model.estimate(np.full((1, FEATURES), 1e4)), model.estimate(features)
    assert far == pytest.approx(colors.mean(axis=0)[None], abs=1.0)
    assert np.abs(near - colors).max() < np.abs(far - colors).max()


def test_a_seed_that_fits_badly_counts_less():
    features = np.zeros((41, FEATURES))
    features[:, 0] = np.linspace(0, 2, 41)
    colors = np.column_stack([10 * np.sin(features[:, 0]), np.zeros(41)])
    colors += np.random.default_rng(5).normal(0, 0.2, colors.shape)
    right = Kriging(features, colors).estimate(features[20:21])
    wrong = colors.copy()
    wrong[20] += 100
    assert Kriging(features, wrong).estimate(features[20:21]) == pytest.approx(right, abs=5.0)


def test_many_seeds_are_left_out_in_groups(monkeypatch):
    generator = np.random.default_rng(6)
    features, colors = random_seeds(25, generator)
    pixels = generator.normal(size=(20, FEATURES))
    monkeypatch.setattr("reflcolor_addon.color.kriging._GROUP", 8)
    model = Kriging(features, colors)
    assert np.isfinite(model.estimate(pixels)).all()
    assert np.isfinite(model.residuals).all()


def test_seeds_on_one_pixel_are_averaged():
    model = Kriging(np.zeros((2, FEATURES)), np.array([[10.0, 0], [20.0, 4]]))
    assert model.estimate(np.zeros((1, FEATURES))) == pytest.approx(np.array([[15.0, 2.0]]), abs=1e-6)


@pytest.mark.parametrize("count", [1, 7, 3000])
def test_chunks_cover_all_pixels_once(count):
    model = Kriging(np.zeros((1, FEATURES)), np.zeros((1, 2)))
    covered = np.zeros(count, int)
    for chunk in model.chunks(count):
        covered[chunk] += 1
    assert (covered == 1).all()


def test_features_of_pixels_that_are_alike_are_the_same_and_units_are_as_documented():
    shape = (40, 40)
    rows, cols = np.indices(shape)
    rays = np.stack([(cols - 19.5) / 40, np.ones(shape), -(rows - 19.5) / 40], axis=-1)
    scan = Scan(name="wall", points=4 * rays, reflectance=np.zeros(shape), valid=rows > 0)
    features = pixel_features(scan, np.where(cols < 20, 0, 255).astype(np.float32)).reshape(*shape, FEATURES)
    assert (features[0] == 0).all()
    assert features.dtype == np.float32
    across = np.linalg.norm(features[20, 0] - features[20, 39])
    # Half a unit of luminance is one; the whole extent is two, for what is nearly a square.
    assert features[20, 39, 3] - features[20, 0, 3] == pytest.approx(2.0)
    assert np.linalg.norm(features[20, 0, :3] - features[20, 39, :3]) == pytest.approx(2.0, rel=0.1)
    assert across > 2.0
    assert features[20, :, 5:] == pytest.approx(np.broadcast_to((0, -0.25, 0), (40, 3)), abs=1e-3)
