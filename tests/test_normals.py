"""Normals of the scanned surface."""

import numpy as np
import pytest
from sample_scans import room_points

from reflcolor_addon.scan.normals import surface_normals


def plane_points(normal, distance, shape=(20, 30), valid=None):
    """What a scanner sees of the plane n x = distance, by a pinhole that looks along +Y."""
    rows, cols = np.indices(shape)
    rays = np.stack([(cols - shape[1] / 2) / 40, np.ones(shape), -(rows - shape[0] / 2) / 40], axis=-1)
    return rays * (distance / (rays @ normal))[..., None]


@pytest.mark.parametrize("normal", [(0, 1, 0), (0.6, 0.8, 0), (0.3, 0.9, -0.3), (-0.4, 0.8, 0.4)])
def test_a_plane_has_its_normal_everywhere_and_it_points_to_the_scanner(normal):
    normal = np.array(normal) / np.linalg.norm(normal)
    points = plane_points(normal, 5.0)
    found = surface_normals(points, np.ones(points.shape[:2], bool))
    assert found == pytest.approx(np.broadcast_to(-normal, points.shape), abs=2e-3)


def test_holes_leave_the_normals_of_the_others_as_they_are():
    normal = np.array([0.0, 0.8, 0.6])
    points = plane_points(normal, 3.0)
    valid = np.random.default_rng(1).random(points.shape[:2]) < 0.8
    points[~valid] = 1e6
    found = surface_normals(points, valid)
    assert (found[~valid] == 0).all()
    # With holes the averages of five rows lie off their middle: not in range, for they lie on the plane.
    assert found[valid] == pytest.approx(np.broadcast_to(-normal, found[valid].shape), abs=2e-2)


def test_strips_leave_no_seam(monkeypatch):
    points = room_points(40, 25, step_deg=(1.0, 3.0))
    valid = np.random.default_rng(2).random(points.shape[:2]) < 0.9
    whole = surface_normals(points, valid)
    monkeypatch.setattr("reflcolor_addon.scan.normals._CHUNK_PIXELS", 25 * 3)
    assert surface_normals(points, valid) == pytest.approx(whole, abs=1e-5)


def test_a_full_turn_is_joined_at_its_edges():
    points = room_points(9, 60, step_deg=(4.0, 6.0))
    valid = np.ones(points.shape[:2], bool)
    turned = np.roll(surface_normals(np.roll(points, 20, axis=1), valid, wrap=True), -20, axis=1)
    assert surface_normals(points, valid, wrap=True) == pytest.approx(turned, abs=1e-5)


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (2, 2)])
def test_points_that_span_no_surface_have_no_normal_or_a_unit_one(shape):
    points = np.ones((*shape, 3))
    assert (surface_normals(points, np.ones(shape, bool)) == 0).all()
    points = np.random.default_rng(3).random((*shape, 3)) + 1
    length = np.linalg.norm(surface_normals(points, np.ones(shape, bool)), axis=-1)
    assert (np.isclose(length, 1, atol=1e-5) | (length == 0)).all()
