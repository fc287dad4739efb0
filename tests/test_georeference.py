"""Poses of scans as they lie in Blender."""

import numpy as np
import pytest

from reflcolor_addon.scan.georeference import rigid_pose

NOWHERE = np.zeros(3)


def turned(degrees, place=(0.0, 0.0, 0.0)):
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    pose = np.eye(4)
    pose[:2, :2], pose[:3, 3] = [[cosine, -sine], [sine, cosine]], place
    return pose


def test_a_matrix_in_meters_is_the_pose():
    pose = turned(30, (1, 2, 3))
    np.testing.assert_allclose(rigid_pose(pose, 1.0, NOWHERE), pose, atol=1e-12)


def test_places_are_brought_to_meters():
    np.testing.assert_allclose(rigid_pose(turned(30, (100, 200, 300)), 0.01, NOWHERE), turned(30, (1, 2, 3)))


def test_points_stay_where_their_vertices_are():
    matrix, center, points = (
        turned(70, (500, -20, 4)),
        np.array([4000.0, 2000.0, 0.0]),
        np.random.default_rng(0).random((9, 3)) + 4000,
    )
    vertices = (points - center) / 0.01
    world = (vertices @ matrix[:3, :3].T + matrix[:3, 3]) * 0.01
    pose = rigid_pose(matrix, 0.01, center)
    np.testing.assert_allclose(points @ pose[:3, :3].T + pose[:3, 3], world, atol=1e-9)


@pytest.mark.parametrize("center", [NOWHERE, np.array([3000.0, 0.0, 1000.0])])
def test_scans_scaled_alike_keep_their_places_to_each_other(center):
    first, second = turned(10, (1, 0, 0)), turned(-40, (3, 5, 1))
    scale = np.diag([0.2, 0.2, 0.2, 1])
    poses = [rigid_pose(scale @ pose, 1.0, center) for pose in (first, second)]
    unscaled = [rigid_pose(pose, 1.0, center) for pose in (first, second)]
    np.testing.assert_allclose(np.linalg.solve(*poses), np.linalg.solve(*unscaled), atol=1e-9)


@pytest.mark.parametrize("scale", [(1, 1, -1), (2, 1, 0.5), (0, 0, 0), (1, 0, 1)])
def test_what_no_scanner_does_still_gives_a_rotation(scale):
    pose = rigid_pose(turned(20, (1, 2, 3)) @ np.diag([*scale, 1.0]), 1.0, NOWHERE)
    np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-12)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1) and np.isfinite(pose).all()
