"""Images on a scan's grid with the detail of the photos."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import painted_room
import pytest
from command_line import COLORIZE
from gltf_files import Glb
from small_scans import random_scan, scan_from_ranges

from reflcolor_addon import Cancelled, Seeds, Settings, colorize, read_scans
from reflcolor_addon.files.images import png_bytes, read_image
from reflcolor_addon.matching.models import GridHomography
from reflcolor_addon.matching.photo_image import PhotoImage
from reflcolor_addon.matching.registration.stored import model_document, model_of
from reflcolor_addon.matching.transfer.fusion import fused
from reflcolor_addon.matching.transfer.surface import GridSurface
from reflcolor_addon.matching.transfer.texture import Shot, texture, texture_shape
from reflcolor_addon.matching.transfer.views import seen_by

NATURAL = Settings.preset("Natural")


@pytest.fixture(scope="module")
def room():
    """A coarse scan of the room, its colorization from a photo that shows more, and that photo."""
    scan = painted_room.scan(rows=50, columns=74, step_deg=0.9)
    camera = painted_room.camera((0.2, 0.1, 0.0), width=960, height=720)
    photo = PhotoImage("photo", painted_room.photo(camera))
    observed = fused([seen_by(photo, camera, GridSurface(scan))], np.ones((1, 3)), GridSurface(scan))
    rows, cols = np.nonzero(observed.seen)
    few = np.linspace(0, len(rows) - 1, 60).astype(int)
    seeds = Seeds(rows[few], cols[few], observed.rgb[rows[few], cols[few]], reason=["pose"] * 60)
    return scan, colorize(scan, seeds, NATURAL, observed), Shot(photo, camera)


def made(scan, result, shots, longest, **options):
    return texture(scan, result.rgb, result.observed, result.photo, shots, longest, **options)


def plain(scan):
    """Of one color wherever there is a return."""
    rgb = np.where(scan.valid[..., None], np.array([90, 60, 40]), 0).astype(np.uint8)
    nothing, none = np.zeros(scan.shape, np.float32), np.full(scan.shape, -1)
    return SimpleNamespace(rgb=rgb, observed=nothing, photo=none)


def test_texels_are_square_and_the_longer_side_has_as_many_as_are_wanted():
    scan = scan_from_ranges(np.full((20, 30), 3.0), np.random.default_rng(0).random((20, 30)), azimuth_deg=60)
    assert texture_shape(scan, 600) == (400, 600)


def test_it_shows_the_photo_s_detail_between_the_scan_s_pixels(room):
    scan, result, shot = room
    image = made(scan, result, [shot], 592)
    # The truth at each texel: the same room scanned eight times as finely.
    fine = painted_room.scan(rows=400, columns=592, step_deg=0.9 / 8)
    assert image.shape == fine.color.shape
    seen = np.kron(result.observed > 0.99, np.ones((8, 8), bool)) & fine.valid
    plain = np.kron(result.rgb, np.ones((8, 8, 1), np.uint8))
    errors = [np.abs(each.astype(int) - fine.color).mean(axis=-1)[seen].mean() for each in (image, plain)]
    assert errors[0] < 0.4 * errors[1]


def test_on_the_scan_s_own_pixels_it_has_their_colors(room):
    scan, result, shot = room
    image = made(scan, result, [shot], 74 * 9)
    middles = image[4::9, 4::9]
    valid = scan.valid & (result.observed == 1)
    # A photo is looked at closer there than for a whole pixel of the scan: edges differ.
    assert np.median(np.abs(middles.astype(int) - result.rgb)[valid]) <= 3


def test_without_photos_the_scan_s_colors_are_enlarged():
    scan = random_scan(shape=(20, 30))
    image = made(scan, plain(scan), [], 300)
    np.testing.assert_array_equal(image, np.broadcast_to([90, 60, 40], image.shape))


def test_where_nothing_returned_it_has_the_color_beside():
    scan = random_scan(shape=(20, 30))
    valid = scan.valid.copy()
    valid[8:12, 10:20] = False
    scan = replace(scan, valid=valid)
    assert (made(scan, plain(scan), [], 300) == [90, 60, 40]).all()


def test_it_can_be_cancelled(room):
    scan, result, shot = room
    with pytest.raises(Cancelled):
        made(scan, result, [shot], 300, cancelled=lambda: True)


@pytest.mark.parametrize("model", ["camera", "homography"])
def test_a_model_survives_as_json_to_the_last_bit(model):
    own = painted_room.camera((0.2, 0.1, 0.3), yaw_deg=7)
    if model == "homography":
        own = GridHomography(np.random.default_rng(0).random((3, 3)), (20, 30), 640, 480)
    again = model_of(json.loads(json.dumps(model_document(own))))
    assert model_document(again) == model_document(own)
    assert type(again) is type(own)


def test_on_the_command_line_png_and_glb_have_as_many_pixels_as_are_wanted(run_cli, cli_folder):
    status, _, err = run_cli(*COLORIZE, "--texture", "200", "-o", "out.png", "-o", "out.glb")
    assert (status, err) == (0, "")
    (scan,) = read_scans("garage.ptx")
    image = read_image(cli_folder / "out.png")
    assert image.shape[:2] == texture_shape(scan, 200)
    glb = Glb(cli_folder / "out.glb")
    primitive = glb.document["meshes"][0]["primitives"][0]
    assert "TEXCOORD_0" in primitive["attributes"] and "COLOR_0" not in primitive["attributes"]
    assert glb.bytes_of(glb.document["images"][0]["bufferView"]) == png_bytes(image, "out.png")


@pytest.mark.parametrize("pixels", ["0", "-5", "1.5", "many", "100000"])
def test_a_texture_of_no_size_is_refused(run_cli, pixels):
    status, _, err = run_cli(*COLORIZE, f"--texture={pixels}", "-o", "out.png")
    assert status == 2 and "expected a whole number from 1 to 16384" in err
