"""The k nearest seeds of every pixel against the seeds' own fields."""

import numpy as np
import pytest
from dijkstra_reference import reference_distances
from hypothesis import given, settings
from hypothesis import strategies as st
from small_graphs import small_graphs

from reflcolor_addon.errors import ReflcolorError
from reflcolor_addon.geodesic import kernel


def of_listed(fields, seeds):
    """The listed seeds' own distances; infinite for no seed."""
    own = np.take_along_axis(np.moveaxis(fields, 0, -1), np.maximum(seeds, 0), axis=-1)
    return np.where(seeds < 0, np.inf, own)


@settings(max_examples=1000)
@given(small_graphs(seeds=9), st.integers(1, 12))
def test_the_distances_are_the_k_least_of_all_fields_to_the_bit(small, k):
    found = kernel.nearest(small.kernel_graph(), small.pixels, k)
    distances, seeds = found.distances, found.seeds
    fields = small.fields()
    least = np.full((*small.valid.shape, k), np.inf, np.float32)
    ordered = np.sort(np.moveaxis(fields, 0, -1), axis=-1)[..., :k]
    least[..., : ordered.shape[-1]] = ordered
    np.testing.assert_array_equal(distances, least)
    np.testing.assert_array_equal(of_listed(fields, seeds), distances)
    np.testing.assert_array_equal(seeds < 0, np.isinf(distances))


@settings(max_examples=300)
@given(small_graphs(seeds=9), st.integers(1, 12))
def test_no_seed_is_listed_twice_and_equals_stand_in_order(small, k):
    found = kernel.nearest(small.kernel_graph(), small.pixels, k)
    distances, seeds = found.distances, found.seeds
    for own, listed in zip(distances.reshape(-1, k), seeds.reshape(-1, k), strict=True):
        found = listed[listed >= 0]
        assert len(set(found)) == len(found)
        equal = (own[:-1] == own[1:]) & (listed[1:] >= 0)
        assert (listed[1:] > listed[:-1])[equal].all()


@settings(max_examples=200)
@given(small_graphs(seeds=5), st.integers(1, 5))
def test_the_distances_are_the_reference(small, k):
    found = kernel.nearest(small.kernel_graph(), small.pixels, k)
    distances, seeds = found.distances, found.seeds
    images = small.luminance, small.range_image, small.valid
    sources = [divmod(int(pixel), small.valid.shape[1]) for pixel in small.pixels]
    fields = np.stack([reference_distances(*images, source, **small.settings) for source in sources])
    np.testing.assert_allclose(distances, of_listed(fields, seeds), rtol=(small.valid.size + 7) * 2**-24)


@settings(max_examples=300)
@given(small_graphs(seeds=9), st.integers(1, 12), st.integers(1, 8), st.integers(1, 4))
def test_lists_that_seeds_are_added_to_have_the_distances_of_all_seeds_at_once(small, k, first, threads):
    graph, pixels = small.kernel_graph(), np.append(small.pixels, small.pixels[0])
    first = min(first, len(pixels) - 1)
    found = kernel.nearest(graph, pixels[:first], k)
    kernel.extend(found, pixels, first, threads=threads)
    distances, seeds = found.distances, found.seeds
    np.testing.assert_array_equal(distances, kernel.nearest(graph, pixels, k).distances)
    fields = np.stack([kernel.field(graph, pixel) for pixel in pixels])
    np.testing.assert_array_equal(of_listed(fields, seeds), distances)


@settings(max_examples=300)
@given(small_graphs(seeds=9), st.integers(1, 20), st.integers(2, 9))
def test_the_number_of_threads_changes_no_bit(small, k, threads):
    one, several = (kernel.nearest(small.kernel_graph(), small.pixels, k, threads=n) for n in (1, threads))
    np.testing.assert_array_equal(one.distances, several.distances)
    np.testing.assert_array_equal(one.seeds, several.seeds)


@settings(max_examples=300)
@given(small_graphs(seeds=9), st.integers(1, 8), st.integers(1, 8))
def test_the_distances_are_the_same_whether_fewer_are_known_or_not(small, few, more):
    graph = small.kernel_graph()
    known = kernel.nearest(graph, small.pixels, few)
    found = kernel.nearest(graph, small.pixels, few + more, known=known)
    alone = kernel.nearest(graph, small.pixels, few + more)
    np.testing.assert_array_equal(found.distances, alone.distances)
    np.testing.assert_array_equal(of_listed(small.fields(), found.seeds), found.distances)


def test_on_a_flat_image_the_first_seeds_win():
    flat = np.zeros((4, 5), np.float32)
    for threads in (1, 3):
        found = kernel.nearest(kernel.Graph(flat, flat, flat == 0), [19, 0, 7, 7, 3], 3, threads=threads)
        assert (found.seeds == [0, 1, 2]).all()


def test_many_seeds_on_a_real_size_agree_with_their_fields():
    random = np.random.default_rng(0)
    luminance, range_image = (random.random((2, 90, 120)) * 255).astype(np.float32)
    valid = random.random((90, 120)) < 0.8
    graph = kernel.Graph(luminance, range_image, valid)
    pixels = random.choice(np.flatnonzero(valid), 200)
    found = kernel.nearest(graph, pixels, 8)
    distances, seeds = found.distances, found.seeds
    fields = np.stack([kernel.field(graph, pixel) for pixel in pixels])
    np.testing.assert_array_equal(distances, np.moveaxis(np.sort(fields, axis=0)[:8], 0, -1))
    np.testing.assert_array_equal(of_listed(fields, seeds), distances)


def test_the_lists_of_single_pixels_are_those_of_all():
    luminance = np.arange(12, dtype=np.float32).reshape(3, 4)
    found = kernel.nearest(kernel.Graph(luminance, luminance, luminance != 5), [2, 11, 0], 2)
    distances, seeds = found.at([4, 11])
    np.testing.assert_array_equal(distances, found.distances[[1, 2], [0, 3]])
    np.testing.assert_array_equal(seeds, found.seeds[[1, 2], [0, 3]])


@pytest.mark.slow
def test_a_large_image_is_searched_in_bands_and_agrees_with_its_fields():
    random = np.random.default_rng(4)
    luminance, range_image = (random.random((2, 1100, 1000)) * 9).astype(np.float32)
    valid = random.random((1100, 1000)) < 0.9
    graph = kernel.Graph(luminance, range_image, valid, wrap=True)
    pixels = random.choice(np.flatnonzero(valid), 60)
    found = kernel.nearest(graph, pixels, 3)
    fields = np.stack([kernel.field(graph, pixel) for pixel in pixels])
    np.testing.assert_array_equal(found.distances, np.moveaxis(np.sort(fields, axis=0)[:3], 0, -1))


@pytest.mark.parametrize("k", [0, -1, 1025])
def test_a_number_of_seeds_out_of_its_range_is_refused(k):
    flat = np.zeros((2, 2), np.float32)
    with pytest.raises(ReflcolorError, match="nearest seeds"):
        kernel.nearest(kernel.Graph(flat, flat, flat == 0), [0], k)
