"""What is written is what is read back."""

import numpy as np
import pytest

from reflcolor_addon import read_scans
from reflcolor_addon.errors import OutputError
from reflcolor_addon.files.writers import write_e57, write_image_pair, write_ptx
from reflcolor_addon.files.writers.image_pair import spherical_limits_deg
from reflcolor_addon.scan.directions import directions
from reflcolor_addon.scan.rotations import quaternion
from reflcolor_addon.scan.scan import Scan


def rotation(axis, degrees):
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + s * skew + (1 - c) * skew @ skew


def make_scan(*, height=6, width=9, color=False, pose=None, reflectance=None, name="garage", holes=True, turn=False):
    random = np.random.default_rng(5)
    azimuth = np.linspace(-180, 180, width, endpoint=False) + 180 / width if turn else np.linspace(-20, 20, width)
    valid = np.ones((height, width), bool)
    if holes:
        valid[1, 2:5] = valid[4, 0] = False
    rays = directions(azimuth, np.linspace(15, -25, height))
    return Scan(
        name=name,
        points=rays * random.uniform(2, 6, (height, width, 1)),
        reflectance=random.random((height, width)) if reflectance is None else reflectance,
        valid=valid,
        color=random.integers(0, 256, (height, width, 3), dtype=np.uint8) if color else None,
        pose=np.eye(4) if pose is None else pose,
    )


def tilted_pose():
    pose = np.eye(4)
    pose[:3, :3] = rotation((0.2, -0.1, 1), 130)
    pose[:3, 3] = (512345.25, 4400123.5, 87.125)
    return pose


@pytest.mark.parametrize("color", [False, True])
@pytest.mark.parametrize(("writer", "file_name"), [(write_ptx, "garage.ptx"), (write_e57, "garage.e57")])
def test_a_scan_reads_back_as_it_was(tmp_path, writer, file_name, color):
    scan = make_scan(color=color, pose=tilted_pose())
    writer(scan, tmp_path / file_name)
    (back,) = read_scans(tmp_path / file_name)
    assert np.array_equal(back.valid, scan.valid)
    assert back.points == pytest.approx(scan.points, abs=1e-6)
    assert back.reflectance[scan.valid] == pytest.approx(scan.reflectance[scan.valid], abs=1e-6)
    assert back.pose == pytest.approx(scan.pose, abs=1e-6)
    if color:
        assert np.array_equal(back.color[scan.valid], scan.color[scan.valid])
    else:
        assert back.color is None


@pytest.mark.parametrize(("writer", "file_name"), [(write_ptx, "site.ptx"), (write_e57, "site.e57")])
def test_several_scans_share_a_file(tmp_path, writer, file_name):
    scans = [make_scan(name="north"), make_scan(height=7, width=11, name="south", pose=tilted_pose())]
    writer(scans, tmp_path / file_name)
    back = read_scans(tmp_path / file_name)
    assert [scan.shape for scan in back] == [(6, 9), (7, 11)]
    assert back[1].pose == pytest.approx(tilted_pose(), abs=1e-6)


def test_e57_keeps_the_names_of_scans(tmp_path):
    write_e57([make_scan(name="Näher dran"), make_scan(name="south")], tmp_path / "site.e57")
    assert [scan.name for scan in read_scans(tmp_path / "site.e57")] == ["Näher dran", "south"]


@pytest.mark.parametrize(
    ("writer", "file_name"), [(write_ptx, "a.ptx"), (write_e57, "a.e57"), (write_image_pair, "a.scan.json")]
)
def test_the_same_scan_gives_the_same_bytes(tmp_path, writer, file_name):
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        writer(make_scan(color=True), tmp_path / folder / file_name)
    for path in (tmp_path / "one").iterdir():
        assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes()


def test_an_image_pair_reads_back_within_half_a_step(tmp_path):
    scan = make_scan(color=True, pose=tilted_pose())
    write_image_pair(scan, tmp_path / "garage.scan.json", range_scale=0.001)
    (back,) = read_scans(tmp_path / "garage.scan.json")
    assert np.array_equal(back.valid, scan.valid)
    assert back.points == pytest.approx(scan.points, abs=0.00051)
    assert back.reflectance[scan.valid] / 65535 == pytest.approx(scan.reflectance[scan.valid], abs=1 / 65535)
    assert back.pose == pytest.approx(scan.pose)
    assert np.array_equal(back.color[scan.valid], scan.color[scan.valid])


def test_an_image_pair_keeps_whole_reflectances_as_they_are(tmp_path):
    values = np.arange(54).reshape(6, 9) * 40
    write_image_pair(make_scan(reflectance=values, holes=False), tmp_path / "a.scan.json")
    assert np.array_equal(read_scans(tmp_path / "a.scan.json")[0].reflectance, values)


def test_an_image_pair_stretches_reflectances_that_fit_no_image(tmp_path):
    values = np.linspace(-2048, 2047, 54).reshape(6, 9)
    write_image_pair(make_scan(reflectance=values, holes=False), tmp_path / "a.scan.json")
    back = read_scans(tmp_path / "a.scan.json")[0].reflectance
    assert back == pytest.approx((values + 2048) / 4095 * 65535, abs=0.51)


def test_an_image_pair_of_far_points_has_a_coarser_scale(tmp_path):
    scan = make_scan()
    far = Scan(name="far", points=scan.points * 100, reflectance=scan.reflectance, valid=scan.valid)
    write_image_pair(far, tmp_path / "far.scan.json")
    assert read_scans(tmp_path / "far.scan.json")[0].points == pytest.approx(far.points, abs=0.01)


@pytest.mark.parametrize("turn", [False, True])
def test_the_angles_of_a_grid_are_found_from_its_points(turn):
    (left, right), (bottom, top) = spherical_limits_deg(make_scan(width=24, turn=turn))
    expected = (-180, 180) if turn else (-20 - 20 / 23, 20 + 20 / 23)
    assert (left, right) == pytest.approx(expected, abs=1e-6)
    assert (bottom, top) == pytest.approx((-29, 19), abs=1e-6)


def test_a_grid_that_is_not_regular_is_no_image_pair(tmp_path):
    scan = make_scan()
    bent = Scan(name="bent", points=scan.points + np.array([0, 0, 1.0]), reflectance=scan.reflectance, valid=scan.valid)
    with pytest.raises(OutputError, match=r"bent: .* write it as PTX or E57"):
        write_image_pair(bent, tmp_path / "bent.scan.json", azimuth_deg=(-21, 21), elevation_deg=(-29, 19))
    assert not list(tmp_path.iterdir())


def test_an_image_pair_needs_its_suffix(tmp_path):
    with pytest.raises(OutputError, match=r"ends in \.scan\.json"):
        write_image_pair(make_scan(), tmp_path / "garage.json")


def test_e57_refuses_a_pose_that_scales(tmp_path):
    with pytest.raises(OutputError, match="more than a rotation and a translation"):
        write_e57(make_scan(pose=np.diag([2.0, 2, 2, 1])), tmp_path / "a.e57")
    assert not list(tmp_path.iterdir())


def test_e57_refuses_a_scan_without_returns(tmp_path):
    empty = Scan(name="e", points=np.zeros((2, 2, 3)), reflectance=np.zeros((2, 2)), valid=np.zeros((2, 2), bool))
    with pytest.raises(OutputError, match="no return"):
        write_e57(empty, tmp_path / "a.e57")


@pytest.mark.parametrize(
    ("writer", "file_name"), [(write_ptx, "a.ptx"), (write_e57, "a.e57"), (write_image_pair, "a.scan.json")]
)
def test_a_folder_that_is_not_there_is_one_clear_line(tmp_path, writer, file_name):
    with pytest.raises(OutputError, match="cannot be written"):
        writer(make_scan(), tmp_path / "nowhere" / file_name)


@pytest.mark.parametrize("degrees", [0, 1, 90, 179.999, 180])
@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, -3)])
def test_the_quaternion_turns_as_the_matrix_does(axis, degrees):
    matrix = rotation(axis, degrees)
    w, x, y, z = quaternion(matrix)
    again = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    assert again == pytest.approx(matrix, abs=1e-12)
