"""How far colors are from the true ones: figures against closed forms, the verb `evaluate`, and its refusals."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from command_line import SHAPE, assert_refused
from hypothesis import given
from hypothesis import strategies as st
from small_scans import random_scan

from reflcolor_addon import ScanError, evaluate
from reflcolor_addon.color.colorspaces import chrominance, merge
from reflcolor_addon.color.evaluation import error_map
from reflcolor_addon.files.images import write_png
from reflcolor_addon.files.writers import write_ptx
from reflcolor_addon.srgb import linear_to_srgb8, srgb8_to_linear

ALL = np.ones(SHAPE, bool)


def flat(*rgb, shape=SHAPE):
    return np.full((*shape, 3), rgb, np.uint8)


def random_colors(seed, shape=SHAPE):
    return np.random.default_rng(seed).integers(0, 256, (*shape, 3), np.uint8)


def test_equal_colors_have_no_error():
    colors = random_colors(0)
    nothing = {"ciede2000_mean": 0.0, "ciede2000_p95": 0.0, "chrominance_psnr_db": math.inf}
    assert evaluate(colors, colors, ALL) == {
        "pixels": 60,
        "structural_similarity": None,
        "as_is": nothing,
        "after_gain": nothing | {"gain": 1.0},
        "color_alone": nothing,
    }


def test_the_difference_of_pure_red_and_green_is_the_published_one():
    figures = evaluate(flat(0, 255, 0), flat(255, 0, 0), ALL)["as_is"]
    assert figures["ciede2000_mean"] == pytest.approx(86.61, abs=0.02)
    assert figures["ciede2000_p95"] == pytest.approx(86.61, abs=0.02)


def test_one_exposure_is_not_to_blame_after_the_gain():
    truth = random_colors(8)
    darker = linear_to_srgb8(srgb8_to_linear(truth) * 0.4)
    figures = evaluate(darker, truth, ALL)
    assert figures["as_is"]["ciede2000_mean"] > 10
    assert figures["after_gain"]["ciede2000_mean"] < 0.5
    assert figures["after_gain"]["gain"] == pytest.approx(2.5, rel=0.01)
    black = evaluate(flat(0, 0, 0), truth, ALL)
    assert black["after_gain"] == black["as_is"] | {"gain": 1.0}


def test_the_structural_similarity_is_that_of_the_windows_that_are_whole():
    from skimage.metrics import structural_similarity

    rgb, truth = random_colors(9, (40, 50)), random_colors(10, (40, 50))
    truth[:20] = rgb[:20] // 2 + truth[:20] // 2
    valid = np.ones((40, 50), bool)
    valid[:, 20:23] = False
    # Each side of the gap alone, without the windows that cross its edges.
    sides = []
    for columns in (slice(None, 20), slice(23, None)):
        images = [image[:, columns] @ [0.299, 0.587, 0.114] for image in (rgb, truth)]
        _, similarity = structural_similarity(*images, data_range=255, full=True)
        sides.append(similarity[3:-3, 3:-3].ravel())
    expected = np.concatenate(sides).mean()
    rgb[~valid], truth[~valid] = 255, 0
    assert evaluate(rgb, truth, valid)["structural_similarity"] == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("pixels", [1, 350, 10**6])
def test_the_structural_similarity_does_not_depend_on_the_strips(monkeypatch, pixels):
    rgb, truth = random_colors(11, (30, 50)), random_colors(12, (30, 50))
    whole = evaluate(rgb, truth, np.ones((30, 50), bool))["structural_similarity"]
    monkeypatch.setattr("reflcolor_addon.color.evaluation._CHUNK_PIXELS", pixels)
    assert evaluate(rgb, truth, np.ones((30, 50), bool))["structural_similarity"] == pytest.approx(whole, abs=1e-6)


def test_grays_differ_as_they_are_but_not_in_color_alone():
    figures = evaluate(flat(90, 90, 90), flat(160, 160, 160), ALL)
    assert figures["as_is"]["ciede2000_mean"] > 20
    assert figures["as_is"]["chrominance_psnr_db"] > 150
    assert figures["color_alone"]["ciede2000_mean"] == 0


def test_the_signal_to_noise_ratio_is_that_of_a_known_shift():
    # Cb grows by about 20 levels, Cr stays: the mean square over both is 200.
    truth = flat(128, 128, 128)
    rgb = merge(np.full(SHAPE, 128.0), np.broadcast_to([20.0, 0.0], (*SHAPE, 2)), "ycbcr")
    figures = evaluate(rgb, truth, ALL)
    for name in ("as_is", "color_alone"):
        assert figures[name]["chrominance_psnr_db"] == pytest.approx(10 * math.log10(255**2 / 200), abs=0.1)


def test_only_valid_pixels_count():
    truth = random_colors(1)
    rgb, valid = truth.copy(), ALL.copy()
    rgb[2, 3], valid[2, 3] = 255 - rgb[2, 3], False
    figures = evaluate(rgb, truth, valid)
    assert figures["pixels"] == 59
    assert figures["as_is"]["ciede2000_mean"] == 0
    assert np.isnan(error_map(rgb, truth, valid)[2, 3])


def test_the_map_holds_the_errors_that_the_figures_sum_up():
    rgb, truth = random_colors(2, (30, 40)), random_colors(3, (30, 40))
    valid = np.random.default_rng(4).random((30, 40)) < 0.7
    errors, figures = error_map(rgb, truth, valid), evaluate(rgb, truth, valid)["as_is"]
    assert errors.dtype == np.float32
    assert (np.isnan(errors) == ~valid).all()
    assert errors[valid].mean() == pytest.approx(figures["ciede2000_mean"], rel=1e-5)
    assert np.percentile(errors[valid], 95) == pytest.approx(figures["ciede2000_p95"], rel=1e-5)


@given(st.integers(0, 2**32 - 1), st.integers(-30, 30))
def test_color_alone_does_not_see_the_luminance(seed, shift):
    # Colors far enough from black and white to be moved without being clipped.
    random = np.random.default_rng(seed)
    rgb, truth = (random.integers(100, 156, (4, 5, 3), np.uint8) for _ in range(2))
    brighter = (rgb.astype(int) + shift).astype(np.uint8)
    valid = np.ones((4, 5), bool)
    one, other = (evaluate(colors, truth, valid)["color_alone"]["ciede2000_mean"] for colors in (rgb, brighter))
    # A tie may be rounded either way.
    assert one == pytest.approx(other, abs=0.2)
    assert np.allclose(chrominance(brighter, "ycbcr"), chrominance(rgb, "ycbcr"))


@pytest.mark.parametrize(
    ("rgb", "truth", "valid", "part"),
    [
        (flat(1, 2, 3, shape=(5, 10)), flat(1, 2, 3), ALL, r"^colors: expected an image of shape \(6, 10, 3\)"),
        (flat(1, 2, 3), flat(1, 2, 3, shape=(6, 9)), ALL, "^true colors: expected"),
        (flat(1, 2, 3), flat(1, 2, 3), ~ALL, "nothing to compare"),
    ],
)
def test_what_cannot_be_compared_is_one_clear_line(rgb, truth, valid, part):
    for compare in (evaluate, error_map):
        with pytest.raises(ScanError, match=part):
            compare(rgb, truth, valid)


# The verb


@pytest.fixture
def garage(cli_folder):
    """A scan that has colors of its own, black at one pixel, and a result; returns scan and result."""
    color = np.maximum(random_colors(5), 1)
    color[0, 0] = 0
    scan = replace(random_scan(shape=SHAPE), color=color)
    write_ptx(scan, cli_folder / "garage.ptx")
    result = random_colors(6)
    write_png(cli_folder / "result.png", result)
    return scan, result


def test_the_verb_compares_with_the_scans_own_colors_where_it_saw_any(run_cli, garage):
    scan, result = garage
    status, out, err = run_cli("evaluate", "garage.ptx", "result.png", "--json")
    assert (status, err) == (0, "")
    document = json.loads(out)
    assert (document.pop("format"), document.pop("version")) == ("reflcolor-evaluation", 1)
    assert document.pop("scan") == {"name": "garage", "index": 1}
    seen = ALL.copy()
    seen[0, 0] = False
    assert document == evaluate(result, scan.color, seen)


def test_the_verb_compares_with_an_image(run_cli, cli_folder, garage):
    truth = random_colors(7)
    write_png(cli_folder / "truth.png", truth)
    status, out, _ = run_cli("evaluate", "garage.ptx", "result.png", "--truth", "truth.png", "--json")
    assert status == 0
    document = json.loads(out)
    figures = evaluate(garage[1], truth, ALL)
    assert {key: document[key] for key in figures} == figures


def test_the_verb_says_the_figures_in_words(run_cli, garage):
    status, out, _ = run_cli("evaluate", "garage.ptx", "result.png")
    assert status == 0
    head, titles, as_is, exposed, alone, similarity = out.splitlines()
    assert head == "59 pixels compared"
    assert titles.split() == ["CIEDE2000", "mean", "95", "%", "chrominance", "PSNR"]
    assert as_is.startswith("as is") and exposed.startswith("exposed alike") and alone.startswith("color alone")
    assert similarity == "structural similarity of the luminance: no window of 7 x 7 pixels is whole"
    assert alone.endswith(" dB")


def test_no_error_at_all_is_json_still(run_cli, cli_folder, garage):
    write_png(cli_folder / "same.png", garage[0].color)
    status, out, _ = run_cli("evaluate", "garage.ptx", "same.png", "--json")
    assert status == 0
    assert json.loads(out)["as_is"] == {"ciede2000_mean": 0.0, "ciede2000_p95": 0.0, "chrominance_psnr_db": None}


def test_the_verb_takes_one_scan_of_several(run_cli, cli_folder, garage):
    scan = garage[0]
    write_ptx([random_scan(1, shape=SHAPE), scan], cli_folder / "garage.ptx")
    assert_refused(run_cli("evaluate", "garage.ptx", "result.png"), 2, "choose one by --scan NAME")
    status, out, _ = run_cli("evaluate", "garage.ptx", "result.png", "--scan", "2", "--json")
    assert (status, json.loads(out)["scan"]["index"]) == (0, 2)


@pytest.mark.parametrize(
    ("arguments", "status", "part"),
    [
        (("garage.ptx",), 2, "RESULT.png"),
        (("garage.ptx", "gone.png"), 1, "gone.png: no such file"),
        (("garage.ptx", "garage.ptx"), 1, "garage.ptx: is not an image"),
        (("garage.ptx", "small.png"), 1, "small.png: is 4 x 3 pixels, but the scan garage has 10 columns x 6 rows"),
        (("garage.ptx", "result.png", "--truth", "small.png"), 1, "small.png: is 4 x 3 pixels"),
        (("plain.ptx", "result.png"), 1, "plain.ptx: the scan plain has no colors of its own; give --truth IMAGE"),
        (("gone.ptx", "result.png"), 1, "gone.ptx: no such file"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_what_the_verb_cannot_compare_is_said_in_one_line(run_cli, cli_folder, garage, arguments, status, part):
    write_png(cli_folder / "small.png", random_colors(8, (3, 4)))
    write_ptx(random_scan(shape=SHAPE), cli_folder / "plain.ptx")
    assert_refused(run_cli("evaluate", *arguments), status, part)
