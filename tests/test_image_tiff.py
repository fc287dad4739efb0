"""TIFF pictures of another writer, in every layout: right, or refused; never other pixels in silence."""

import struct
import zlib

import cv2
import numpy as np
import pytest
import tifffile

from reflcolor_addon.errors import ImageError
from reflcolor_addon.files.images import read_image, read_measured
from reflcolor_addon.files.tiff import upright

RNG = np.random.default_rng(11)
KINDS = ("u1", "u2", "u4", "i1", "i2", "i4", "f2", "f4", "f8")
SHAPE = (37, 53)


def written(tmp_path, image, name="a.tif", **options):
    path = tmp_path / name
    tifffile.imwrite(path, image, **options)
    return path


def tiff(strips, height, width, tags):
    """A TIFF of strips as high as the picture, with more tags, for what no writer at hand makes."""
    tags = tags | {256: [width], 257: [height], 278: [height], 279: [len(strip) for strip in strips]}
    tags[273] = np.cumsum([8, *tags[279]])[:-1].tolist()
    at = 8 + sum(tags[279])
    after = at + 2 + 12 * len(tags) + 4
    entries, behind = b"", b""
    for tag, values in sorted(tags.items()):
        kind = 4 if tag in (256, 257, 273, 278, 279) else 3
        packed = struct.pack(f"<{len(values)}{'I' if kind == 4 else 'H'}", *values)
        if len(packed) > 4:
            packed, behind = struct.pack("<I", after + len(behind)), behind + packed
        entries += struct.pack("<HHI", tag, kind, len(values)) + packed.ljust(4, b"\0")
    table = struct.pack("<H", len(tags)) + entries + bytes(4) + behind
    return struct.pack("<2sHI", b"II", 42, at) + b"".join(strips) + table


def failure(path, read):
    with pytest.raises(ImageError) as caught:
        read(path)
    assert str(caught.value).isprintable()
    return str(caught.value)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"rowsperstrip": 7},
        {"tile": (16, 32)},
        {"compression": "zlib", "rowsperstrip": 7},
        {"compression": "zlib", "tile": (16, 32)},
        {"bigtiff": True},
    ],
    ids=lambda options: " ".join(options),
)
def test_measured_values_come_back_as_they_were(tmp_path, kind, order, options):
    values = (RNG.random(SHAPE) * 200 - (60 if kind[0] in "if" else 0)).astype(kind)
    read, opaque = read_measured(written(tmp_path, values, photometric="minisblack", byteorder=order, **options))
    assert read.dtype == (np.float32 if kind == "f2" else np.dtype(kind))
    assert np.array_equal(read, values)
    assert opaque is None


@pytest.mark.parametrize("kind", ["u1", "u2", "u4", "i2"])
@pytest.mark.parametrize("options", [{"rowsperstrip": 7}, {"tile": (16, 32)}], ids=["strips", "tiles"])
def test_differences_between_pixels_are_summed(tmp_path, kind, options):
    values = (RNG.random(SHAPE) * 30_000).astype(kind)
    path = written(tmp_path, values, photometric="minisblack", compression="zlib", predictor=True, **options)
    assert np.array_equal(read_measured(path)[0], values)


@pytest.mark.parametrize("kind", ["f2", "f4", "f8"])
def test_differences_of_floating_point_are_summed(tmp_path, kind):
    """As technical note 3 of TIFF has it: bytes by their significance, and differences of those along the row."""
    values = RNG.normal(0, 100, SHAPE).astype(kind)
    size = values.itemsize
    planes = values.astype(f">{kind}").view(np.uint8).reshape(*SHAPE, size).swapaxes(1, 2).reshape(SHAPE[0], -1)
    packed = zlib.compress(np.diff(planes, axis=1, prepend=np.uint8(0)).tobytes())
    path = tmp_path / "a.tif"
    path.write_bytes(tiff([packed], *SHAPE, {258: [8 * size], 259: [8], 262: [1], 277: [1], 317: [3], 339: [3]}))
    assert np.array_equal(read_measured(path)[0], values)


@pytest.mark.parametrize("kind", ["u1", "u2"])
def test_lzw_is_unpacked(tmp_path, kind):
    values = (RNG.random(SHAPE) * 200).astype(kind)
    options = [cv2.IMWRITE_TIFF_COMPRESSION, 5, cv2.IMWRITE_TIFF_PREDICTOR, 1, cv2.IMWRITE_TIFF_ROWSPERSTRIP, 7]
    (tmp_path / "a.tif").write_bytes(cv2.imencode(".tiff", values, options)[1])
    with tifffile.TiffFile(tmp_path / "a.tif") as file:
        assert file.pages[0].compression == 5
    assert np.array_equal(read_measured(tmp_path / "a.tif")[0], values)


@pytest.mark.parametrize("planar", ["contig", "separate"])
@pytest.mark.parametrize("tile", [None, (16, 32)], ids=["strips", "tiles"])
@pytest.mark.parametrize(("kind", "scale"), [("u1", 1), ("u2", 257), ("u4", 16843009)])
def test_a_photo_comes_back_whatever_its_planes(tmp_path, planar, tile, kind, scale):
    photo = RNG.integers(0, 256, (*SHAPE, 3), np.uint8)
    stored = photo.astype(kind) * np.dtype(kind).type(scale)
    stored = np.moveaxis(stored, -1, 0) if planar == "separate" else stored
    path = written(
        tmp_path, stored, photometric="rgb", planarconfig=planar, tile=tile, rowsperstrip=None if tile else 5
    )
    assert np.array_equal(read_image(path), photo)


def test_planes_that_are_packed_by_lzw_come_back(tmp_path):
    """No writer at hand makes these: the planes of three gray files are put into one."""
    photo = RNG.integers(0, 65536, (*SHAPE, 3), np.uint16)
    strips = []
    for plane in np.moveaxis(photo, -1, 0):
        options = [cv2.IMWRITE_TIFF_COMPRESSION, 5, cv2.IMWRITE_TIFF_PREDICTOR, 1, cv2.IMWRITE_TIFF_ROWSPERSTRIP, 37]
        (tmp_path / "plane.tif").write_bytes(cv2.imencode(".tiff", np.ascontiguousarray(plane), options)[1])
        with tifffile.TiffFile(tmp_path / "plane.tif") as file:
            page = file.pages[0]
            (at,), (size,) = page.dataoffsets, page.databytecounts
        strips.append((tmp_path / "plane.tif").read_bytes()[at : at + size])
    tags = {258: [16] * 3, 259: [5], 262: [2], 277: [3], 284: [2]}
    (tmp_path / "a.tif").write_bytes(tiff(strips, *SHAPE, tags))
    with tifffile.TiffFile(tmp_path / "a.tif") as file:
        assert file.pages[0].shape == (3, *SHAPE)
    assert np.array_equal(read_image(tmp_path / "a.tif"), np.rint(photo / 257).astype(np.uint8))


@pytest.mark.parametrize("kind", ["u1", "u2", "u4"])
@pytest.mark.parametrize("planar", ["contig", "separate"])
def test_gray_with_alpha_keeps_every_bit(tmp_path, kind, planar):
    most = np.iinfo(kind).max
    gray = (RNG.random(SHAPE) * most).astype(kind)
    alpha = np.where(RNG.random(SHAPE) < 0.3, 0, most).astype(kind)
    stored = np.stack([gray, alpha], axis=0 if planar == "separate" else -1)
    path = written(tmp_path, stored, photometric="minisblack", planarconfig=planar, extrasamples=["unassalpha"])
    values, opaque = read_measured(path)
    assert np.array_equal(values, gray)
    assert np.array_equal(opaque, alpha != 0)
    assert (read_image(path)[alpha == 0] == 0).all()


@pytest.mark.parametrize("kind", ["u1", "u2"])
def test_white_as_zero_is_turned_over_in_every_depth(tmp_path, kind):
    most = np.iinfo(kind).max
    bright = (RNG.random(SHAPE) * most).astype(kind)
    path = written(tmp_path, (most - bright).astype(kind), photometric="miniswhite")
    assert np.array_equal(read_measured(path)[0], bright)
    assert np.abs(read_image(path)[..., 0] - bright / most * 255).max() <= 0.5


@pytest.mark.parametrize("kind", ["u1", "u2", "f4"])
def test_colors_that_were_multiplied_by_their_alpha_are_divided(tmp_path, kind):
    most = 1.0 if kind == "f4" else np.iinfo(kind).max
    color, alpha = RNG.uniform(0.2, 0.9, (*SHAPE, 3)), RNG.uniform(0.4, 1, SHAPE)
    alpha[:5] = 0
    stored = np.dstack([color * alpha[..., None], alpha]) * most
    stored = (stored if kind == "f4" else np.rint(stored)).astype(kind)
    path = written(tmp_path, stored, photometric="rgb", extrasamples=["assocalpha"])
    linear = np.where(color <= 0.0031308, 12.92 * color, 1.055 * color ** (1 / 2.4) - 0.055)
    expected = np.where(alpha[..., None] > 0, (linear if kind == "f4" else color) * 255, 0)
    # Eight bits of a color that was darkened to 0.4 are as coarse as that.
    assert np.abs(read_image(path) - expected).max() <= (3 if kind == "u1" else 1)


@pytest.mark.parametrize("kind", ["i8", "u8"])
def test_multiplied_colors_stay_within_the_greatest_number(tmp_path, kind):
    most = np.iinfo(kind).max
    path = written(tmp_path, np.full((*SHAPE, 4), most, kind), photometric="rgb", extrasamples=["assocalpha"])
    measured, opaque = read_measured(path)
    assert np.abs(measured / most - 1).max() < 1e-9
    assert opaque.all()


def test_bits_in_reversed_order_are_refused(tmp_path):
    path = tmp_path / "a.tif"
    tags = {258: [8], 259: [1], 262: [1], 266: [2], 277: [1]}
    path.write_bytes(tiff([bytes(range(12))], 3, 4, tags))
    assert "bits in reversed order" in failure(path, read_image)
    path.write_bytes(tiff([bytes(range(12))], 3, 4, tags | {266: [1]}))
    assert np.array_equal(read_measured(path)[0].ravel(), np.arange(12))


def test_tiles_without_pixels_are_damage(tmp_path):
    path = tmp_path / "a.tif"
    tags = {258: [8], 259: [1], 262: [1], 277: [1], 322: [0], 323: [16], 324: [8], 325: [12]}
    path.write_bytes(tiff([bytes(12)], 3, 4, tags))
    assert "its tags are damaged" in failure(path, read_image)


def test_alpha_that_stands_alone_changes_no_color(tmp_path):
    photo = RNG.integers(0, 256, (*SHAPE, 3), np.uint8)
    alpha = RNG.integers(1, 256, SHAPE, np.uint8)
    path = written(tmp_path, np.dstack([photo, alpha]), photometric="rgb", extrasamples=["unassalpha"])
    assert np.array_equal(read_image(path), photo)


def test_samples_that_nobody_explains_are_left_out(tmp_path):
    photo = RNG.integers(0, 256, (*SHAPE, 3), np.uint8)
    more = np.zeros((*SHAPE, 2), np.uint8)
    path = written(tmp_path, np.dstack([photo, more]), photometric="rgb", extrasamples=["unspecified", "unspecified"])
    assert np.array_equal(read_image(path), photo)


@pytest.mark.parametrize("orientation", range(1, 9))
def test_a_photo_is_upright_and_a_measurement_is_not_turned(tmp_path, orientation):
    photo = RNG.integers(0, 256, (*SHAPE, 3), np.uint8)
    path = written(tmp_path, photo, photometric="rgb", extratags=[(274, 3, 1, orientation, True)])
    assert np.array_equal(read_image(path), upright(photo, orientation))
    gray = written(tmp_path, photo[..., 0], photometric="minisblack", extratags=[(274, 3, 1, orientation, True)])
    assert np.array_equal(read_measured(gray)[0], photo[..., 0])


def test_turning_is_that_of_photos():
    image = np.arange(6).reshape(2, 3)
    turned = {
        1: image, 2: image[:, ::-1], 3: image[::-1, ::-1], 4: image[::-1],
        5: image.T, 6: np.rot90(image, -1), 7: image[::-1, ::-1].T, 8: np.rot90(image),
    }  # fmt: skip
    for orientation, expected in turned.items():
        assert np.array_equal(upright(image, orientation), expected)


@pytest.mark.parametrize(
    ("image", "options", "said"),
    [
        (
            np.ones((*SHAPE, 4), np.uint8),
            {"photometric": "separated"},
            "the photometric interpretation 5, expected gray or RGB",
        ),
        (np.ones(SHAPE, bool), {"photometric": "minisblack"}, "1 bits of the format 1"),
        (np.ones(SHAPE, np.complex64), {"photometric": "minisblack"}, "64 bits of the format 6"),
        (np.ones(SHAPE, np.int16), {"photometric": "miniswhite"}, "white as zero in numbers without a greatest value"),
        (np.ones(SHAPE, np.uint16), {"photometric": "cfa"}, "the photometric interpretation 32803"),
        (np.ones((*SHAPE, 3), np.uint8), {"photometric": "rgb", "subfiletype": 1}, "a reduced image"),
    ],
)
def test_what_is_not_read_is_told(tmp_path, image, options, said):
    path = written(tmp_path, image, **options)
    for read in (read_image, read_measured):
        assert said in failure(path, read)


def test_signed_samples_are_no_photo(tmp_path):
    path = written(tmp_path, np.ones(SHAPE, np.int16), photometric="minisblack")
    assert "its samples are signed, expected colors from 0 on; save the photo with 8 or 16 bits, unsigned" in failure(
        path, read_image
    )


def test_a_palette_and_jpeg_are_read_as_usual(tmp_path):
    photo = RNG.integers(0, 256, (16, 16, 3), np.uint8)
    flat = np.repeat(np.repeat(photo[::8, ::8], 8, 0), 8, 1)
    (tmp_path / "jpeg.tif").write_bytes(cv2.imencode(".tiff", flat[..., ::-1], [cv2.IMWRITE_TIFF_COMPRESSION, 7])[1])
    with tifffile.TiffFile(tmp_path / "jpeg.tif") as file:
        assert file.pages[0].compression == 7
    assert np.abs(read_image(tmp_path / "jpeg.tif").astype(int) - flat).max() < 40
    table = (RNG.random((3, 256)) * 65535).astype(np.uint16)
    index = RNG.integers(0, 256, (16, 16), np.uint8)
    path = written(tmp_path, index, photometric="palette", colormap=table)
    assert np.abs(read_image(path) - np.moveaxis(table[:, index], 0, -1) / 257).max() <= 1


def test_a_tiff_that_is_cut_or_changed_anywhere_never_leaves_the_error_family(tmp_path):
    rng = np.random.default_rng(3)
    image = rng.integers(0, 65536, (20, 30, 3), np.uint16)
    path = tmp_path / "b.tif"
    for options in ({}, {"compression": "zlib", "predictor": True}, {"planarconfig": "separate"}, {"tile": (16, 16)}):
        stored = np.moveaxis(image, -1, 0) if "planarconfig" in options else image
        whole = written(tmp_path, stored, photometric="rgb", **options).read_bytes()
        for _ in range(150):
            data = bytearray(whole)
            for _ in range(rng.integers(1, 4)):
                data[rng.integers(4, 400 if rng.random() < 0.8 else len(data))] = rng.integers(256)
            path.write_bytes(data[: rng.integers(4, 2 * len(data))])
            for read in (read_image, read_measured):
                try:
                    read(path)
                except ImageError as error:
                    assert str(error).isprintable()


@pytest.mark.parametrize("read", [read_image, read_measured])
@pytest.mark.parametrize("options", [{}, {"bigtiff": True}, {"compression": "zlib"}])
def test_of_several_pictures_the_first_is_read_and_that_is_told(tmp_path, read, options):
    pages = RNG.integers(1, 255, (3, *SHAPE)).astype(np.uint8)
    path, warnings = written(tmp_path, pages, photometric="minisblack", **options), []
    found = read(path, warnings)
    np.testing.assert_array_equal(found[..., 0] if read is read_image else found[0], pages[0])
    assert list(map(str, warnings)) == ["a.tif: holds 3 pictures; the first was read"]


def test_a_small_copy_behind_a_picture_is_no_other_picture(tmp_path):
    path, warnings = tmp_path / "a.tif", []
    with tifffile.TiffWriter(path) as file:
        file.write(np.zeros(SHAPE, np.uint8))
        file.write(np.zeros((9, 13), np.uint8), subfiletype=1)
    read_image(path, warnings)
    assert not warnings
