"""Range and reflectance images with a sensor model become scans: geometry by closed forms, every key checked."""

import json

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reflcolor_addon.batch.paths import scan_files
from reflcolor_addon.errors import Cancelled, OutputError, ScanError
from reflcolor_addon.files.readers import ReadOptions, read_scans, scan_json
from reflcolor_addon.files.readers.scan_json import write_scan_json

HEIGHT, WIDTH = 8, 10
PINHOLE = {"type": "pinhole", "fx": 12.0, "fy": 11.0, "cx": 4.5, "cy": 3.5}
PANORAMA = {"type": "spherical", "azimuth_deg": [-180, 180], "elevation_deg": [-40, 40]}
REFLECTANCE = np.arange(HEIGHT * WIDTH, dtype=np.uint16).reshape(HEIGHT, WIDTH) * 800
DEPTH = (np.arange(HEIGHT * WIDTH, dtype=np.uint16).reshape(HEIGHT, WIDTH) + 2) * 100
COLOR = np.random.default_rng(2).integers(1, 256, (HEIGHT, WIDTH, 3), np.uint8)


@pytest.fixture
def folder(tmp_path):
    save(tmp_path / "depth.png", DEPTH)
    save(tmp_path / "ir.png", REFLECTANCE)
    save(tmp_path / "rgb.png", COLOR[..., ::-1])
    return tmp_path


def save(path, image):
    path.write_bytes(cv2.imencode(path.suffix, image)[1])


def description(**changes):
    content = {
        "format": "reflcolor-scan",
        "version": 1,
        "range": "depth.png",
        "range_scale": 0.001,
        "reflectance": "ir.png",
        "model": PINHOLE,
        **changes,
    }
    return {key: value for key, value in content.items() if value is not None}


def read(folder, content=None, **changes):
    path = folder / "garage.scan.json"
    content = description(**changes) if content is None else content
    path.write_text(content if isinstance(content, str) else json.dumps(content), "utf-8")
    (scan,) = read_scans(path)
    return scan


def failure(folder, content=None, **changes):
    with pytest.raises(ScanError) as caught:
        read(folder, content, **changes)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_pinhole_depth_is_measured_along_the_axis(folder):
    scan = read(folder)
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    depth = DEPTH * 0.001
    assert scan.points[..., 0] == pytest.approx((u - 4.5) / 12 * depth)
    assert scan.points[..., 1] == pytest.approx(depth)
    assert scan.points[..., 2] == pytest.approx(-(v - 3.5) / 11 * depth)
    assert np.array_equal(scan.reflectance, REFLECTANCE)
    assert scan.name == "garage"
    assert scan.color is None
    assert scan.warnings == ()


def test_a_pinhole_range_may_be_the_length_of_the_ray(folder):
    assert read(folder, range_type="ray").range == pytest.approx(DEPTH * 0.001)


def test_a_panorama_covers_its_limits_with_pixel_centers_half_a_step_inside(folder):
    scan = read(folder, model=PANORAMA)
    assert scan.range == pytest.approx(DEPTH * 0.001)
    right = np.degrees(np.arctan2(scan.points[..., 0], scan.points[..., 1]))
    up = np.degrees(np.arcsin(scan.points[..., 2] / scan.range))
    assert right == pytest.approx(np.tile(np.arange(-162, 180, 36.0), (HEIGHT, 1)))
    assert up == pytest.approx(np.tile(np.arange(35, -40, -10.0)[:, None], WIDTH))
    assert scan.full_turn


def test_a_part_of_a_panorama_is_no_full_turn(folder):
    assert not read(folder, model={**PANORAMA, "azimuth_deg": [-90, 90]}).full_turn


def test_limits_in_reverse_say_that_the_image_is_stored_mirrored(folder):
    upright = read(folder, model=PANORAMA)
    save(folder / "depth.png", DEPTH[::-1, ::-1])
    save(folder / "ir.png", REFLECTANCE[::-1, ::-1])
    scan = read(folder, model={**PANORAMA, "azimuth_deg": [180, -180], "elevation_deg": [40, -40]})
    assert scan.points == pytest.approx(upright.points)
    assert np.array_equal(scan.reflectance, upright.reflectance)


def test_lens_distortion_is_undone(folder):
    lens = [0.4878, 0.0320, 0.001, -0.002, 0.0019, 0.8265, 0.1244, 0.0108]
    scan = read(folder, model={**PINHOLE, "distortion": lens})
    camera = np.array([[12.0, 0, 4.5], [0, 11.0, 3.5], [0, 0, 1]])
    seen = np.stack([scan.points[..., 0], -scan.points[..., 2], scan.points[..., 1]], axis=-1).reshape(-1, 1, 3)
    pixels, _ = cv2.projectPoints(seen, np.zeros(3), np.zeros(3), camera, np.array(lens))
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    assert pixels[:, 0] == pytest.approx(np.column_stack([u.ravel(), v.ravel()]), abs=1e-3)


def test_pixels_that_no_lens_can_see_are_no_returns(folder):
    scan = read(folder, model={**PINHOLE, "distortion": [-1.5, 0, 0, 0]})
    assert scan.valid[3:5, 4:6].all()
    assert not scan.valid[0, 0]


def test_zero_is_no_return_even_with_an_offset(folder):
    depth = DEPTH.copy()
    depth[1, 2] = 0
    save(folder / "depth.png", depth)
    scan = read(folder, range_offset=0.25, range_type="ray")
    assert np.array_equal(scan.valid, depth > 0)
    assert scan.range[0, 0] == pytest.approx(0.45)


def test_a_transparent_pixel_is_no_return_and_an_opaque_zero_is_one(folder):
    values = np.arange(HEIGHT * WIDTH, dtype=np.uint8).reshape(HEIGHT, WIDTH)
    alpha = np.full((HEIGHT, WIDTH), 255, np.uint8)
    alpha[5, 5] = 0
    save(folder / "depth.png", np.dstack([values, values, values, alpha]))
    scan = read(folder, range_scale=0.1, range_offset=2, range_type="ray")
    assert np.array_equal(scan.valid, alpha > 0)
    assert scan.range[0, 0] == pytest.approx(2)


@pytest.mark.parametrize("hole", [np.nan, np.inf, -1.0, 0.0, 1e10])
def test_float_ranges_without_a_number_above_zero_are_no_returns(folder, hole):
    depth = DEPTH.astype(np.float32) / 1000
    depth[3, 4] = hole
    save(folder / "depth.tiff", depth)
    scan = read(folder, range="depth.tiff", range_scale=None)
    assert np.count_nonzero(~scan.valid) == 1
    assert np.array_equal(scan.points[scan.valid][:, 1], depth[scan.valid].astype(float))


def test_a_table_gives_the_meters_of_values_that_are_no_linear_measure(folder):
    save(folder / "depth.png", np.arange(1, 81, dtype=np.uint8).reshape(HEIGHT, WIDTH))
    scan = read(folder, range_scale=None, range_table=[[0, 1.0], [40, 3.0], [80, 43.0]])
    assert scan.points[0, 0, 1] == pytest.approx(1.05)
    assert scan.points[3, 9, 1] == pytest.approx(3.0)
    assert scan.points[7, 8, 1] == pytest.approx(42.0)


def test_color_name_and_pose_are_taken_over(folder):
    pose = [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]
    scan = read(folder, color="rgb.png", name="Höhle", pose=pose)
    assert np.array_equal(scan.color, COLOR)
    assert np.array_equal(scan.pose, pose)
    assert scan.name == "Höhle"
    assert np.array_equal(read(folder, color="rgb.png", color_order="bgr").color, COLOR[..., ::-1])


def test_gray_colors_are_no_colors(folder):
    save(folder / "rgb.png", np.repeat(COLOR[..., :1], 3, axis=-1))
    scan = read(folder, color="rgb.png")
    assert scan.color is None
    assert "red = green = blue" in scan.warnings[0]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": "gltf"}, 'expected a JSON object with "format": "reflcolor-scan"'),
        ({"version": 2}, "version: expected 1 (this file needs a newer release), found 2"),
        ({"range": None}, "range: is missing"),
        ({"reflectance": None}, "reflectance: is missing"),
        ({"model": None}, "model: is missing"),
        ({"range": 7}, "range: expected a text in one line, found 7"),
        ({"rnage_scale": 1}, "rnage_scale: unknown key, expected one of format, version, range, "),
        ({"range_scale": "x"}, 'range_scale: expected a number from 1e-12 to 1,000,000, found "x"'),
        ({"range_scale": None}, "range_scale: missing; depth.png holds whole numbers: give the meters per unit"),
        ({"range_scale": 0}, "range_scale: expected a number from 1e-12 to 1,000,000, found 0"),
        ({"range_scale": True}, "range_scale: expected a number from 1e-12 to 1,000,000, found true"),
        ({"range_scale": 10**400}, "range_scale: expected a number from 1e-12 to 1,000,000, found 1000"),
        ({"range_offset": [1]}, "range_offset: expected a number from -1,000,000,000 to 1,000,000,000, found [1]"),
        ({"range_type": "time"}, 'range_type: expected "depth" or "ray", found "time"'),
        ({"model": PANORAMA, "range_type": "depth"}, 'range_type: expected "ray", found "depth"'),
        ({"range_table": [[0, 1], [1, 2]]}, "range_table: replaces range_scale"),
        ({"range_scale": None, "range_table": [[0, 1]]}, "range_table: expected a list of at least two"),
        ({"range_scale": None, "range_table": [[1, 1], [0, 2]]}, "range_table: expected a list of at least two"),
        ({"color_order": "cmyk"}, 'color_order: expected "rgb" or "bgr", found "cmyk"'),
        ({"model": "pinhole"}, 'model: expected an object with a type, found "pinhole"'),
        ({"model": {"type": "fisheye"}}, 'model.type: expected "pinhole" or "spherical" or "beams", found "fisheye"'),
        ({"model": {**PINHOLE, "fx": "x"}}, 'model.fx: expected a number from 0.001 to 10,000,000, found "x"'),
        ({"model": {**PINHOLE, "fy": -1}}, "model.fy: expected a number from 0.001 to 10,000,000, found -1"),
        ({"model": {"type": "pinhole", "fx": 1, "fy": 1, "cx": 1}}, "model.cy: is missing"),
        ({"model": {**PINHOLE, "k1": 1}}, "model.k1: unknown key, expected one of type, fx, fy, cx, cy, distortion"),
        ({"model": {**PINHOLE, "distortion": [1, 2]}}, "model.distortion: expected 4, 5 or 8 numbers"),
        ({"model": {**PANORAMA, "azimuth_deg": [0, 361]}}, "two numbers 0.000001 to 360 degrees apart"),
        ({"model": {**PANORAMA, "azimuth_deg": [5, 5]}}, "two numbers 0.000001 to 360 degrees apart"),
        ({"model": {**PANORAMA, "elevation_deg": [-45, 91]}}, "model.elevation_deg: expected a number from -90 to 90"),
        (
            {"model": {**PANORAMA, "elevation_deg": 45}},
            "model.elevation_deg: expected two numbers in degrees, found 45",
        ),
        ({"pose": [[1, 0], [0, 1]]}, "pose: expected 4 rows of 4 numbers"),
        ({"pose": np.zeros((4, 4)).tolist()}, "pose: expected a matrix that can be inverted"),
        ({"range": "missing.png"}, "missing.png: no such file"),
        ({"reflectance": "rgb.png"}, "reflectance: rgb.png: its color channels differ"),
        ({"color": "garage.scan.json"}, "color: garage.scan.json: is not an image"),
    ],
)
def test_every_field_is_checked_and_named(folder, changes, message):
    found = failure(folder, **changes)
    assert found.startswith("garage.scan.json: ")
    assert message in found


def test_numbers_that_are_not_finite_are_refused(folder):
    text = json.dumps(description(range_scale=float("nan")))
    assert (
        failure(folder, text) == "garage.scan.json: range_scale: expected a number from 1e-12 to 1,000,000, found NaN"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{\n'format'", "line 2, column 1: expected a JSON description"),
        ("[]", "expected a JSON object"),
        ("{" * 100, "line 1, column 2: expected a JSON description of a scan"),
        ('{"a":' * 100_000, "found values that JSON cannot hold"),
    ],
)
def test_what_is_no_json_is_told(folder, text, said):
    assert said in failure(folder, text)


def test_images_of_different_sizes_are_told(folder):
    save(folder / "ir.png", REFLECTANCE[1:])
    assert failure(folder) == (
        "garage.scan.json: reflectance: ir.png has 7 rows x 10 columns, expected 8 x 10 as the range image has"
    )


def test_a_range_image_without_any_return_is_refused(folder):
    save(folder / "depth.png", DEPTH * 0)
    assert failure(folder) == "garage.scan.json: depth.png has no pixel with a return; there is nothing to import"


def test_cancelling_and_progress(folder):
    told = []
    path = folder / "garage.scan.json"
    path.write_text(json.dumps(description()))
    read_scans(path, progress=lambda fraction, text: told.append((fraction, text)))
    assert told[:2] == [(0.0, "Reading depth.png"), (0.4, "Reading ir.png")]
    with pytest.raises(Cancelled):
        read_scans(path, cancelled=lambda: True)


def test_a_written_description_opens_the_pair_from_anywhere(folder):
    path = folder / "deeper" / "garage.scan.json"
    path.parent.mkdir()
    write_scan_json(
        path,
        range_image=folder / "depth.png",
        reflectance_image=folder / "ir.png",
        color_image=folder / "rgb.png",
        model=PINHOLE,
        range_scale=0.001,
        name="Höhle",
    )
    assert json.loads(path.read_text("utf-8"))["range"] == "../depth.png"
    with pytest.raises(ScanError, match=r"range: \.\./depth\.png lies outside of the folder of garage\.scan\.json"):
        read_scans(path)
    (scan,) = read_scans(path, outside=True)
    expected = read(folder, color="rgb.png")
    assert np.array_equal(scan.points, expected.points)
    assert np.array_equal(scan.color, expected.color)
    assert scan.name == "Höhle"


def test_a_description_that_would_not_be_read_is_not_written(folder):
    images = {"range_image": folder / "depth.png", "reflectance_image": folder / "ir.png"}
    with pytest.raises(ScanError, match=r"model\.fx: expected a number from 0\.001 to 10,000,000, found 0"):
        write_scan_json(folder / "a.scan.json", **images, model={**PINHOLE, "fx": 0}, range_scale=1)
    with pytest.raises(OutputError, match=r"ends in \.scan\.json"):
        write_scan_json(folder / "a.json", **images, model=PINHOLE, range_scale=1)
    with pytest.raises(OutputError):
        write_scan_json(folder / "missing" / "a.scan.json", **images, model=PINHOLE, range_scale=1)
    assert sorted(path.name for path in folder.iterdir()) == ["depth.png", "ir.png", "rgb.png"]


JSON_VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda parts: st.lists(parts, max_size=5) | st.dictionaries(st.text(max_size=5), parts, max_size=3),
    max_leaves=8,
)


@given(key=st.sampled_from(sorted(scan_json._KEYS)), value=JSON_VALUES, inside=st.sampled_from([None, "fx", "type"]))
def test_any_value_of_any_key_is_accepted_or_refused_in_one_line(key, value, inside):
    content = description()
    if inside is None:
        content[key] = value
    else:
        content["model"] = {**PINHOLE, inside: value}
    try:
        scan_json.check_description(content, "garage.scan.json")
    except ScanError as error:
        assert "\n" not in str(error)


@pytest.mark.parametrize("many", [False, True], ids=["far from all others", "far more often than others"])
def test_the_greatest_code_of_16_bits_is_no_return_where_it_is_none(folder, many):
    depth = DEPTH.copy()
    if many:
        # A sensor that measures up to the end of its scale, and saturates there.
        depth = (65534 - np.arange(HEIGHT * WIDTH, dtype=np.uint16)).reshape(HEIGHT, WIDTH)
        depth[2:5] = 65535
    else:
        depth[1, 2:5] = 65535
    save(folder / "depth.png", depth)
    scan = read(folder)
    np.testing.assert_array_equal(scan.valid, depth != 65535)
    assert "depth.png holds 65535 in" in scan.warnings[0]


def test_a_range_that_was_stretched_to_16_bits_keeps_its_farthest_return(folder):
    depth = (65535 - 300 * np.arange(HEIGHT * WIDTH)[::-1]).astype(np.uint16).reshape(HEIGHT, WIDTH)
    save(folder / "depth.png", depth)
    scan = read(folder)
    assert scan.valid.all() and scan.warnings == ()


def test_a_pose_in_millimeters_keeps_the_points_and_is_told(folder):
    pose = np.eye(4) * [0.001, 0.001, 0.001, 1]
    scan = read(folder, pose=pose.tolist())
    np.testing.assert_allclose(scan.points, read(folder).points)
    np.testing.assert_allclose(scan.pose, np.eye(4))
    assert "scales by 0.001" in scan.warnings[0] and "left out" in scan.warnings[0]


BEAMS = {"type": "beams", "azimuth_deg": [-180, 180], "elevation_deg": [20, 9, 4, 3, 2.5, 2, -1, -16]}


@pytest.mark.parametrize("offset", [None, [1.5, -0.5, 0, 0.25, 3, -3, 0, 0]])
def test_beams_have_elevations_and_azimuths_of_their_own(folder, offset):
    model = BEAMS if offset is None else {**BEAMS, "azimuth_offset_deg": offset}
    scan = read(folder, model=model)
    x, y, z = np.moveaxis(scan.points, -1, 0)
    elevation = np.degrees(np.arctan2(z, np.hypot(x, y)))
    np.testing.assert_allclose(elevation, np.broadcast_to(np.array(BEAMS["elevation_deg"])[:, None], elevation.shape))
    expected = np.linspace(-162, 162, WIDTH) + np.zeros((HEIGHT, 1)) + np.array(offset or [0] * HEIGHT)[:, None]
    np.testing.assert_allclose(np.degrees(np.arctan2(x, y)), expected, atol=1e-9)
    np.testing.assert_allclose(scan.range, DEPTH * 0.001)
    assert scan.full_turn


@pytest.mark.parametrize(
    ("model", "said"),
    [
        ({**BEAMS, "elevation_deg": [1, 2, 3]}, "model.elevation_deg: has 3 numbers, expected 8"),
        ({**BEAMS, "azimuth_offset_deg": [1]}, "model.azimuth_offset_deg: expected as many numbers"),
        ({**BEAMS, "elevation_deg": 5}, "model.elevation_deg: expected a list of degrees"),
    ],
)
def test_beams_that_do_not_fit_are_told(folder, model, said):
    assert said in failure(folder, model=model)


def test_arrays_stand_for_images(folder):
    np.savez(folder / "frame.npz", range=DEPTH.astype(np.uint32), signal=REFLECTANCE, rgb=COLOR)
    scan = read(folder, range="frame.npz#range", reflectance="frame.npz#signal", color="frame.npz#rgb", model=BEAMS)
    np.testing.assert_allclose(scan.range, DEPTH * 0.001)
    np.testing.assert_array_equal(scan.reflectance, REFLECTANCE)
    np.testing.assert_array_equal(scan.color, COLOR)
    assert [path.name for path in scan_files(folder / "garage.scan.json")] == ["garage.scan.json", "frame.npz"]
    assert "frame.npz: has no array depth" in failure(folder, range="frame.npz#depth")
    assert "expected an array of rows x columns" in failure(folder, range="frame.npz#rgb")


def test_a_spinning_lidars_frame_is_read(data_dir, tmp_path):
    source = data_dir / "ouster" / "OS-1-128_v2.3.0_1024x10_lb_n3_scan0.npz"
    (tmp_path / "frame.npz").write_bytes(source.read_bytes())
    model = {"type": "beams", "azimuth_deg": [-180, 180], "elevation_deg": np.linspace(22, -22, 128).tolist()}
    names = {"range": "frame.npz#range", "reflectance": "frame.npz#reflectivity"}
    scan = read(tmp_path, model=model, **names)
    assert scan.shape == (128, 1024) and scan.full_turn and 0.2 < scan.valid.mean() < 1


@pytest.mark.parametrize("step", [2, 3])
def test_every_other_row_and_column_can_be_left_out(folder, step):
    path = folder / "garage.scan.json"
    path.write_text(json.dumps(description()), "utf-8")
    (scan,) = read_scans(path, options=ReadOptions(step=step))
    np.testing.assert_array_equal(scan.reflectance, REFLECTANCE[::step, ::step])
