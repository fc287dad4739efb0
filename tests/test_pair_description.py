"""Images picked together: which is which, what is guessed of them, and what is said of the scene that comes of it."""

import cv2
import numpy as np
import pytest

from reflcolor_addon.errors import ScanError
from reflcolor_addon.files.readers import read_scans
from reflcolor_addon.files.readers.pair_description import Pair, describe_pair, pair_and_photos, previewed, table_of


@pytest.fixture
def pair(tmp_path):
    """A function that saves images and returns a Pair of them."""

    def make(given=None, **images):
        paths = []
        for name, pixels in images.items():
            paths.append(tmp_path / f"{name}.{'tiff' if pixels.dtype.kind == 'f' else 'png'}")
            cv2.imwrite(str(paths[-1]), pixels[..., ::-1] if pixels.ndim == 3 else pixels)
        return Pair(images=tuple(paths), **(given or {}))

    return make


def room(height, width, dtype=np.uint16, scale=1000):
    """Distances of a room of 8 x 6 x 3 m all around, and any reflectance."""
    azimuth = (np.arange(width) + 0.5) / width * 2 * np.pi - np.pi
    elevation = (90 - (np.arange(height)[:, None] + 0.5) * 180 / height) * np.pi / 180
    ray = np.abs(
        [np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth), np.sin(elevation + 0 * azimuth)]
    )
    distance = 1 / np.max(ray / np.array([4.0, 3.0, 1.5])[:, None, None], axis=0)
    return (distance * scale).astype(dtype), (255 * np.random.default_rng(0).random((height, width))).astype(np.uint8)


def camera(height=48, width=64):
    depth = (1500 + 10 * np.arange(width)[None] + 0 * np.arange(height)[:, None]).astype(np.uint16)
    return depth, np.arange(height * width, dtype=np.uint8).reshape(height, width)


def test_a_wide_image_is_a_panorama_with_square_pixels(pair):
    depth, infrared = room(60, 120)
    preview = previewed(pair(depth=depth, infrared=infrared))
    assert preview.content["model"] == {"type": "spherical", "azimuth_deg": [-180, 180], "elevation_deg": [-90, 90]}
    assert preview.content["range_scale"] == 0.001
    assert preview.doubts == ()
    assert preview.said[0] == "range: depth.png, 16 bits" and preview.said[1] == "reflectance: infrared.png"
    assert preview.said[3].startswith(("mesh: 8.0", "mesh: 7.9"))


def test_a_wider_one_is_cut_off_above_and_below(pair):
    depth, infrared = room(64, 1024)
    model = previewed(pair(depth=depth, infrared=infrared)).content["model"]
    assert model["elevation_deg"] == [-11.25, 11.25]


def test_any_other_image_is_a_cameras(pair):
    depth, infrared = camera()
    model = previewed(pair(depth=depth, infrared=infrared)).content["model"]
    assert model == {"type": "pinhole", "fx": 51.2, "fy": 51.2, "cx": 31.5, "cy": 23.5}


@pytest.mark.parametrize(("values", "scale"), [(np.float32(2.5), 1.0), (np.float32(2500), 0.001)])
def test_floating_point_holds_meters_unless_they_are_thousands(pair, values, scale):
    depth, infrared = camera()
    assert previewed(pair(depth=np.full(depth.shape, values), infrared=infrared)).content["range_scale"] == scale


def test_eight_bits_are_a_guess_and_it_is_said(pair):
    depth, infrared = camera()
    preview = previewed(pair(depth=(depth / 10).astype(np.uint8), infrared=infrared))
    assert "8 bits do not give their scale; 10 m is a guess" in preview.doubts[0]
    told = pair({"range_scale": 0.01}, depth=(depth / 10).astype(np.uint8), infrared=infrared)
    assert previewed(told).doubts == ()


def test_a_bowl_of_360_degrees_is_doubted(pair):
    depth, infrared = camera()
    around = {"type": "spherical", "azimuth_deg": (-180, 180), "elevation_deg": (-45, 90)}
    doubts = previewed(pair({"model": around, "range_scale": 0.0001}, depth=depth, infrared=infrared)).doubts
    assert "all around, its points are 0.18 m away, as in a bowl" in doubts[0]
    assert "left and right edges do not meet" in doubts[1]


def test_angles_that_stretch_the_pixels_are_doubted(pair):
    depth, infrared = room(60, 120)
    flat = {"type": "spherical", "azimuth_deg": (-180, 180), "elevation_deg": (-5, 5)}
    doubts = previewed(pair({"model": flat}, depth=depth, infrared=infrared)).doubts
    assert any("18 times as wide as high" in doubt for doubt in doubts)


def test_a_range_far_beyond_reason_is_doubted(pair):
    depth, infrared = camera()
    doubts = previewed(pair({"range_scale": 10.0}, depth=depth, infrared=infrared)).doubts
    assert "m away; check the range's scale" in doubts[0]


def test_a_table_stands_for_the_scale_and_a_third_image_is_the_color(pair):
    depth, infrared = camera()
    color = np.random.default_rng(2).integers(0, 256, (*depth.shape, 3), np.uint8)
    given = {"range_table": table_of("1000 1, 3000 5"), "color_order": "bgr"}
    path, doubts = describe_pair(pair(given, infrared=infrared, depth=depth, extra=color))
    (scan,) = read_scans(path)
    np.testing.assert_allclose(scan.points[..., 1], 1 + (depth - 1000.0) / 2000 * 4, rtol=1e-6)
    np.testing.assert_array_equal(scan.color, color[..., ::-1])
    assert doubts == ()


@pytest.mark.parametrize("text", ["1 2 3", "a b", "1"])
def test_a_table_that_is_none_is_told(text):
    with pytest.raises(ScanError, match="range table: expected pairs"):
        table_of(text)
    assert table_of(" ") is None


@pytest.mark.parametrize("swap", [False, True])
def test_the_image_with_more_bits_is_the_range_unless_swapped(pair, swap):
    depth, infrared = camera()
    content = previewed(pair({"swap": swap, "range_scale": 0.001}, one=infrared, other=depth)).content
    assert content["range_image"].stem == ("one" if swap else "other")


def test_images_that_cannot_be_told_apart_are_refused(pair):
    _, infrared = camera()
    with pytest.raises(ScanError, match="cannot tell which is the range image"):
        previewed(pair(one=infrared, other=infrared))


def test_images_of_another_size_are_photos_and_so_are_those_that_all_have_colors(pair):
    depth, infrared = camera()
    colors = np.random.default_rng(0).integers(0, 256, (*depth.shape, 3), np.uint8)
    photo = np.random.default_rng(1).integers(0, 256, (30, 40, 3), np.uint8)
    images = pair(depth=depth, ir=infrared, rgb=colors, first=photo, second=photo).images
    assert pair_and_photos(images) == (images[:3], images[3:])
    assert pair_and_photos(images[:2]) == (images[:2], ())
    assert pair_and_photos(images[:2] + images[3:4]) == (images[:2], images[3:4])
    # None stands out: what is wrong is said when they are described.
    assert pair_and_photos(images[1:2] + images[3:4]) == (images[1:2] + images[3:4], ())
