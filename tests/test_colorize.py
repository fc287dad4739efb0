"""Colorizing against a brute-force evaluation of the paper's equations."""

import itertools

import numpy as np
import pytest
from dijkstra_reference import reference_blend, reference_distances
from hypothesis import example, given
from hypothesis import strategies as st
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon import Cancelled, ReflcolorError, Seeds, SeedsError, Settings, colorize
from reflcolor_addon.color import colorspaces
from reflcolor_addon.files import memory
from reflcolor_addon.geodesic import kernel
from reflcolor_addon.geodesic.blending import Blend
from reflcolor_addon.geodesic.distances import distances_over
from reflcolor_addon.geodesic.engines import engine_for
from reflcolor_addon.geodesic.graph import PixelGraph
from reflcolor_addon.scan.normalization import normalize
from reflcolor_addon.settings import SETTINGS

# Paths of up to 54 steps in float32.
FLOAT32 = 4e-6
betas = st.sampled_from([0.0, 1e-3, 1.0, 1e6])
neighbors = st.sampled_from([4, 8])
any_width = st.integers(1, 9)


# Everything holds with the native kernel and without.
pytestmark = pytest.mark.usefixtures("engine")


@st.composite
def grids(draw, widths=any_width):
    """Random (height, width) images of few levels, so that there are ties and steps for nothing, and a mask."""
    shape = draw(st.integers(1, 6)), draw(widths)
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    levels = draw(st.sampled_from([1, 2, 4, 1000]))
    luminance, range_image = (rng.integers(0, levels, shape) * (255 / levels) for _ in range(2))
    valid = rng.random(shape) < draw(st.sampled_from([0.5, 0.8, 1.0]))
    return luminance.astype(np.float32), range_image.astype(np.float32), valid


def draw_pixels(data, valid, most=5):
    """Pixels with a return; some of them may be the same."""
    rows, cols = np.nonzero(valid)
    chosen = data.draw(st.lists(st.integers(0, rows.size - 1), min_size=1, max_size=most))
    return rows[chosen], cols[chosen]


@given(data=st.data(), shape=st.sampled_from([(2, 3), (3, 2), (1, 4), (2, 2)]), neighbors=neighbors, wrap=st.booleans())
def test_the_reference_finds_the_least_of_all_paths(data, shape, neighbors, wrap):
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    luminance, ranges, valid = rng.integers(0, 9, shape), rng.integers(0, 3, shape), rng.random(shape) < 0.9
    pixels = [tuple(pixel) for pixel in np.argwhere(valid)]

    def step(p, q):
        down, right = abs(p[0] - q[0]), abs(p[1] - q[1])
        if wrap:
            right = min(right, shape[1] - right)
        if max(down, right) > 1 or (neighbors == 4 and down + right > 1):
            return np.inf
        return (0.5 * (int(ranges[q]) - int(ranges[p])) ** 2 + 1) * abs(int(luminance[q]) - int(luminance[p]))

    for source in pixels:
        least = np.full(shape, np.inf)
        others = [pixel for pixel in pixels if pixel != source]
        for count in range(len(others) + 1):
            for path in itertools.permutations(others, count):
                end = path[-1] if path else source
                length = sum(step(p, q) for p, q in itertools.pairwise((source, *path)))
                least[end] = min(least[end], length)
        found = reference_distances(luminance, ranges, valid, source, beta=0.5, neighbors=neighbors, wrap=wrap)
        assert (found == least).all()


@given(grid=grids(), data=st.data(), beta=betas, neighbors=neighbors, wrap=st.booleans())
def test_distances_equal_the_reference(grid, data, beta, neighbors, wrap):
    luminance, range_image, valid = grid
    valid[0, 0] = True
    rows, cols = draw_pixels(data, valid)
    graph = PixelGraph(
        luminance=luminance, range_image=range_image, valid=valid, beta=beta, neighbors=neighbors, wrap=wrap
    )
    for distance, row, col in zip(distances_over(graph, rows, cols), rows, cols, strict=True):
        expected = reference_distances(
            luminance, range_image, valid, (row, col), beta=beta, neighbors=neighbors, wrap=wrap
        )
        np.testing.assert_allclose(distance, expected, rtol=FLOAT32, atol=0)


distances = st.sampled_from([0.0, 1e-300, 1e-9, 1.0, 1.0 + 1e-9, 3.0, 1e13, np.inf]) | st.floats(0, 1e6)


@given(
    fields=st.integers(1, 6).flatmap(
        lambda count: st.lists(st.tuples(*[distances] * 4), min_size=count, max_size=count)
    ),
    alpha=st.sampled_from([0.1, 1.0, 6.0, 64.0]),
)
@example(fields=[(0.0, 5.0, np.inf, 1.0), (0.0, 0.0, np.inf, np.inf)], alpha=64.0)
@example(fields=[(1e300, 1e-9, 1e-300, 1.0), (1e-300, 5e-324, 1e300, np.inf)], alpha=64.0)
def test_the_blend_equals_the_reference_whatever_the_distances(fields, alpha):
    fields = np.array(fields).reshape(-1, 2, 2)
    colors = np.random.default_rng(len(fields)).uniform(-128, 128, (len(fields), 2))
    blend = Blend((2, 2), alpha)
    for field, color in zip(fields, colors, strict=True):
        blend.add(field, color)
    expected = reference_blend(fields, colors, alpha)
    reached = np.isfinite(fields).any(axis=0)
    mean = blend.mean()
    np.testing.assert_allclose(mean.values[:, reached].T, expected[reached], rtol=1e-6, atol=1e-5)
    assert (mean.values[:, ~reached] == 0).all()
    assert (mean.least == fields.min(axis=0).astype(np.float32)).all()
    assert (mean.nearest_seed == np.where(reached, fields.argmin(axis=0), -1)).all()


@pytest.mark.parametrize("space", [choice.value for choice in SETTINGS["color_space"].choices])
@given(
    grid=grids(widths=st.integers(1, 4) | st.integers(8, 11)),
    data=st.data(),
    alpha=st.sampled_from([0.1, 2.5, 6.0, 64.0]),
    beta=betas,
    neighbors=neighbors,
    azimuth_deg=st.sampled_from([90.0, 360.0]),
)
def test_the_result_equals_a_brute_force_evaluation(space, grid, data, alpha, beta, neighbors, azimuth_deg):
    reflectance, ranges, valid = grid
    valid[0, 0] = True
    scan = scan_from_ranges(2 + ranges / 100, reflectance, valid, azimuth_deg=azimuth_deg)
    rows, cols = draw_pixels(data, valid)
    rgb = np.array(data.draw(st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=rows.size, max_size=rows.size)))
    settings = Settings(alpha=alpha, beta=beta, neighbors=neighbors, color_space=space)
    result = colorize(scan, Seeds(rows, cols, rgb), settings)

    luminance, _ = normalize(scan.reflectance, valid)
    range_image, _ = normalize(scan.range, valid)
    options = {"beta": beta, "neighbors": neighbors, "wrap": scan.full_turn}
    fields = np.stack(
        [reference_distances(luminance, range_image, valid, pixel, **options) for pixel in zip(rows, cols, strict=True)]
    )
    expected = reference_blend(fields, colorspaces.chrominance(rgb, space), alpha)
    reached = np.isfinite(fields).any(axis=0)
    # Where a channel sits on the edge of two levels, a chrominance that differs in its last digits may tip it over.
    chrominance = colorspaces.chrominance(rgb, space)
    last_digits = 2 * alpha * FLOAT32 * np.ptp(chrominance, axis=0) + 1e-6 * np.abs(chrominance).max()
    tips = [
        colorspaces.merge(luminance, np.nan_to_num(expected) + last_digits * tip, space)
        for tip in itertools.product((-1, 0, 1), repeat=2)
    ]
    assert ((result.rgb >= np.min(tips, axis=0)) & (result.rgb <= np.max(tips, axis=0)))[reached].all()
    assert (result.rgb[~reached] == np.rint(luminance)[~reached, None]).all()
    assert ((result.nearest_seed >= 0) == reached).all()
    nearest = np.take_along_axis(fields, np.maximum(result.nearest_seed, 0)[None], axis=0)[0]
    assert (nearest[reached] <= fields.min(axis=0)[reached] * (1 + FLOAT32)).all()
    assert ((result.confidence > 0) == reached).all()


def test_on_a_line_the_blend_is_the_closed_form():
    # Steps of 1 and of 2 gray levels between the seeds at the ends: r = 1 and 2 in the middle.
    luminance = np.array([[10.0, 11.0, 13.0]], np.float32)
    graph = PixelGraph(luminance=luminance, range_image=np.zeros((1, 3)), valid=np.ones((1, 3), bool))
    fields = distances_over(graph, [0, 0], [0, 2])
    assert fields.tolist() == [[[0, 1, 3]], [[3, 2, 0]]]
    blend = engine_for(graph).blend(6.0)
    blend.add(fields[0], (64.0, 0.0))
    blend.add(fields[1], (0.0, 64.0))
    chroma = blend.mean().values[:, 0]
    assert chroma[:, 1] == pytest.approx([64 * 64 / 65, 64 / 65])
    assert chroma[:, [0, 2]].T.tolist() == [[64, 0], [0, 64]]


def test_a_range_jump_makes_the_step_longer_and_beta_0_leaves_it_out():
    luminance, ranges = np.array([[0.0, 2.0]], np.float32), np.array([[0.0, 5.0]], np.float32)
    for beta, expected in ((0.0, 2.0), (1.0, (25 + 1) * 2.0), (0.5, (12.5 + 1) * 2.0)):
        graph = PixelGraph(luminance=luminance, range_image=ranges, valid=np.ones((1, 2), bool), beta=beta)
        assert distances_over(graph, [0], [0])[0, 0, 1] == expected


def test_a_seed_keeps_its_chrominance():
    scan = random_scan(shape=(12, 15))
    seeds = Seeds([2, 9], [3, 11], [[130, 110, 90], [90, 120, 140]])
    result = colorize(scan, seeds)
    gray = normalize(scan.reflectance, scan.valid)[0]
    chrominance = np.zeros((*scan.shape, 2))
    chrominance[seeds.rows, seeds.cols] = colorspaces.chrominance(seeds.rgb, "ycbcr")
    expected = colorspaces.merge(gray, chrominance, "ycbcr")
    assert (result.rgb[seeds.rows, seeds.cols] == expected[seeds.rows, seeds.cols]).all()
    assert (result.confidence[seeds.rows, seeds.cols] == 1).all()
    assert result.nearest_seed[seeds.rows, seeds.cols].tolist() == [0, 1]


def test_on_a_flat_scan_all_seeds_share_every_pixel_equally():
    scan = scan_from_ranges(np.full((4, 5), 3.0), np.full((4, 5), 0.5))
    result = colorize(scan, Seeds([0, 3, 2], [0, 4, 2], [[200, 100, 0], [0, 100, 200], [100, 100, 100]]))
    chrominance = colorspaces.chrominance(np.array([[200, 100, 0], [0, 100, 200], [100, 100, 100]]), "ycbcr").mean(
        axis=0
    )
    assert (result.rgb == colorspaces.merge(np.zeros((1, 1)), chrominance[None, None], "ycbcr")).all()


def test_pixels_cut_off_from_every_seed_keep_their_gray_and_that_is_said():
    valid = np.ones((5, 7), bool)
    valid[:, 3] = False
    scan = random_scan(shape=(5, 7), valid=valid)
    result = colorize(scan, Seeds([1], [1], [[250, 30, 30]]))
    gray = np.rint(normalize(scan.reflectance, valid)[0])
    assert (result.rgb[:, 4:] == gray[:, 4:, None]).all()
    assert (result.confidence[:, 3:] == 0).all()
    assert (result.nearest_seed[:, 3:] == -1).all()
    assert (result.rgb[:, 3] == 0).all()
    assert result.warnings == ("15 pixels are cut off from every seed and keep their gray; add seeds there",)


def test_a_stray_return_that_no_seed_reaches_is_no_warning():
    valid = np.ones((40, 60), bool)
    valid[:3, :3] = False
    valid[1, 1] = True
    scan = random_scan(shape=(40, 60), valid=valid)
    result = colorize(scan, Seeds([20], [30], [[250, 30, 30]]))
    assert result.nearest_seed[1, 1] == -1 and result.warnings == ()


def test_a_full_turn_is_joined_at_its_edges():
    # A wall of strong contrast stands in the middle; from edge to edge it is a step for nothing.
    reflectance = np.tile([0.0, 0, 0, 0, 1, 1, 0, 0, 0, 0], (4, 1))
    seeds = Seeds([1, 1], [4, 1], [[0, 0, 255], [255, 0, 0]])
    for azimuth, nearest in ((360.0, 1), (90.0, 0)):
        ranges = np.full((4, 10), 3.0)
        scan = scan_from_ranges(ranges, reflectance, azimuth_deg=azimuth)
        assert scan.full_turn == (azimuth == 360)
        assert colorize(scan, seeds, Settings(beta=0.0)).nearest_seed[1, 8] == nearest


def test_a_seed_without_return_colors_from_where_it_was_moved():
    valid = np.ones((6, 10), bool)
    valid[2, 3] = False
    scan = random_scan(valid=valid)
    result = colorize(scan, Seeds([2], [3], [[200, 50, 50]]))
    assert (result.seeds.rows[0], result.seeds.cols[0]) == (1, 3)
    assert result.warnings == ("seed 1: no return at row 2, column 3; moved to row 1, column 3",)


def test_the_limits_of_the_normalization_are_told():
    scan = random_scan()
    result = colorize(scan, Seeds([0], [0], [[1, 2, 3]]))
    assert result.normalization["reflectance"] == tuple(np.percentile(scan.reflectance.astype(float), (1, 99)))
    assert result.normalization["range"] == tuple(np.percentile(scan.range, (1, 99)))


def test_the_same_input_gives_the_same_bytes():
    scan, seeds = random_scan(shape=(30, 40)), Seeds([3, 20, 29], [5, 39, 0], [[1, 2, 3], [99, 9, 9], [0, 200, 0]])
    first, second = colorize(scan, seeds), colorize(scan, seeds)
    assert first.rgb.tobytes() == second.rgb.tobytes()
    assert first.confidence.tobytes() == second.confidence.tobytes()


def test_bad_seeds_are_refused():
    with pytest.raises(SeedsError, match="no seeds"):
        colorize(random_scan(), Seeds([], [], []))
    with pytest.raises(SeedsError, match="outside the scan's grid"):
        colorize(random_scan(), Seeds([99], [0], [[1, 2, 3]]))


def test_progress_grows_from_0_to_1():
    told = []
    colorize(
        random_scan(),
        Seeds([0, 1], [0, 1], [[1, 2, 3]] * 2),
        progress=lambda fraction, text: told.append((fraction, text)),
    )
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    assert (fractions[0], fractions[-1]) == (0, 1)
    assert all(text for _, text in told)


@pytest.mark.parametrize("after", [0, 1, 2])
def test_it_can_be_cancelled_after_any_seed(after):
    asked = itertools.count()
    with pytest.raises(Cancelled):
        colorize(random_scan(), Seeds([0, 1, 2], [0, 1, 2], [[1, 2, 3]] * 3), cancelled=lambda: next(asked) >= after)


def test_a_scan_too_large_for_the_memory_is_refused_before_the_work(monkeypatch):
    monkeypatch.setattr(memory, "available_bytes", lambda: 1000)
    with pytest.raises(ReflcolorError, match=r"small: colorizing 6 rows x 10 columns needs about .* of memory"):
        colorize(random_scan(), Seeds([0], [0], [[1, 2, 3]]))


@given(data=st.data(), grid=grids(), k=st.integers(1, 7), alpha=st.sampled_from([0.5, 6.0]))
def test_the_nearest_seeds_differ_from_all_by_no_more_than_the_bound(data, grid, k, alpha):
    luminance, range_image, valid = grid
    valid[0, 0] = True
    rows, cols = draw_pixels(data, valid, most=7)
    graph = PixelGraph(luminance=luminance, range_image=range_image, valid=valid)
    colors = np.random.default_rng(rows.size).uniform(-128, 128, (rows.size, 2)).astype(np.float32)
    engine = engine_for(graph)
    pixels = np.ravel_multi_index((rows, cols), valid.shape)
    mean, bound = engine.nearest(pixels, min(k, rows.size), engine.control()).blend(colors, alpha)
    expected = reference_blend(distances_over(graph, rows, cols), colors, alpha)
    reached = np.isfinite(mean.least)
    assert (reached == ~np.isnan(expected[..., 0])).all()
    off = np.abs(np.moveaxis(mean.values, 0, -1) - expected).max(axis=-1)[reached]
    assert (off <= bound[reached] + 2e-3).all()
    if k >= rows.size:
        assert (bound == 0).all()


def test_auto_takes_all_seeds_where_that_is_quick_else_the_nearest_and_says_which(monkeypatch, engine):
    scan = random_scan(shape=(20, 30))
    rng = np.random.default_rng(2)
    seeds = Seeds(rng.integers(0, 20, 60), rng.integers(0, 30, 60), rng.integers(0, 256, (60, 3)))
    assert colorize(scan, seeds, Settings(nearest="auto")).method["nearest"] is None
    monkeypatch.setattr("reflcolor_addon.color.nearest_seeds.EXACT_PIXEL_SEEDS", 1000)
    method = colorize(scan, seeds, Settings(nearest="auto")).method
    if engine == "scipy":
        assert method["nearest"] is None and "slower" in method["note"]
    else:
        assert method["nearest"] in (8, 16, 32) and method["note"] is None
        assert 0 <= method["bound_levels"]["p99.9"] <= method["bound_levels"]["max"]


def test_both_engines_agree(monkeypatch):
    scan = random_scan(shape=(30, 40))
    rng = np.random.default_rng(3)
    seeds = Seeds(rng.integers(0, 30, 20), rng.integers(0, 40, 20), rng.integers(0, 256, (20, 3)))
    for settings in (Settings(), Settings(nearest=5)):
        monkeypatch.setattr(kernel, "available", lambda: True)
        native = colorize(scan, seeds, settings)
        monkeypatch.setattr(kernel, "available", lambda: False)
        fallback = colorize(scan, seeds, settings)
        assert np.abs(native.rgb.astype(int) - fallback.rgb).max() <= 1
        assert (native.nearest_seed == fallback.nearest_seed).mean() > 0.999
        if settings.nearest:
            assert native.method["bound_levels"]["max"] == pytest.approx(
                fallback.method["bound_levels"]["max"], rel=0.01
            )
