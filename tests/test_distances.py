"""Geodesic distances in one call, of a scan or of plain arrays."""

import numpy as np
import pytest
from dijkstra_reference import reference_distances
from small_scans import random_scan

from reflcolor_addon import ScanError, SeedsError, Settings, geodesic_distances
from reflcolor_addon.scan.normalization import normalize

GRAY = np.array([[0.0, 128.0, 255.0], [0.0, 0.0, 255.0]])


def test_distances_of_a_scan_are_those_of_the_reference_for_each_pixel():
    scan, settings = random_scan(shape=(6, 9)), Settings(beta=0.5, neighbors=4)
    rows, cols = np.argwhere(scan.valid)[[0, 20]].T
    found = geodesic_distances(scan, rows, cols, settings)
    assert (found.shape, found.dtype) == ((2, 6, 9), np.float32)
    for distances, pixel in zip(found, zip(rows, cols, strict=True), strict=True):
        expected = reference_distances(
            normalize(scan.reflectance, scan.valid)[0],
            normalize(scan.range, scan.valid)[0],
            scan.valid,
            pixel,
            beta=0.5,
            neighbors=4,
            wrap=scan.full_turn,
        )
        np.testing.assert_allclose(distances, expected, rtol=1e-6)


def test_plain_arrays_give_what_a_scan_of_them_gives():
    scan = random_scan(shape=(6, 9))
    row, col = np.argwhere(scan.valid)[5]
    options = {"range_image": scan.range, "valid": scan.valid, "full_turn": scan.full_turn}
    plain = geodesic_distances(scan.reflectance, row, col, **options)
    assert (plain == geodesic_distances(scan, [row], [col])).all()


def test_pixels_that_are_not_finite_are_none():
    holes = np.where(GRAY == 128, np.nan, GRAY)
    found = geodesic_distances(holes, 0, 0, Settings(neighbors=4))
    assert np.isinf(found[0, 0, 1]) and found[0, 1, 2] == 255


def test_whole_numbers_of_eight_bits_do_not_wrap_around():
    assert geodesic_distances(np.array([[200, 10, 250]], np.uint8), 0, 0)[0].argmax() == 2


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (
            (GRAY[0], 0, 0),
            ScanError,
            r"^reflectance: expected a Scan or an \(H, W\) array of numbers, found shape \(3,\)",
        ),
        (("garage.ptx", 0, 0), ScanError, "^reflectance: expected a Scan"),
        ((GRAY, 2, 0), SeedsError, r"^row 2, column 0 is outside the scan's grid \(rows 0 to 1, columns 0 to 2\)"),
        ((GRAY, -1, 0), SeedsError, "^row -1, column 0 is outside"),
        ((GRAY, [0, 1], [0]), SeedsError, "^rows, cols: expected as many"),
        ((GRAY, 0.5, 0), SeedsError, "^rows, cols: expected as many whole numbers"),
        ((np.where(GRAY == 0, np.nan, GRAY), 0, 0), SeedsError, "^row 0, column 0: no return there"),
    ],
)
def test_what_cannot_be_measured_is_told_in_one_line(arguments, error, message):
    with pytest.raises(error, match=message):
        geodesic_distances(*arguments)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"valid": np.ones(GRAY.shape, np.uint8)}, r"^valid: expected booleans, found uint8; write valid > 0$"),
        ({"range_image": GRAY[:1]}, r"^range_image: expected numbers of shape \(2, 3\), found shape \(1, 3\)"),
    ],
)
def test_arrays_that_do_not_fit_are_told_in_one_line(options, message):
    with pytest.raises(ScanError, match=message):
        geodesic_distances(GRAY, 0, 0, **options)
