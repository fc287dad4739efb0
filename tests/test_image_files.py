"""Photos come in upright as 8-bit sRGB, measured images with every bit, and results go out whole or not at all."""

import struct
import zlib

import cv2
import numpy as np
import pytest

from reflcolor_addon.errors import ImageError, OutputError
from reflcolor_addon.files.exr import read_exr_channels
from reflcolor_addon.files.images import eight_bits, read_image, read_measured, write_png
from reflcolor_addon.files.png_text import without_text

RGB = np.random.default_rng(2).integers(0, 256, (6, 9, 3), np.uint8)


def encoded(image, suffix=".png"):
    image = image if image.ndim == 2 else image[..., [2, 1, 0, *range(3, image.shape[2])]]
    # OpenCV packs the colors of float TIFFs with loss unless told not to.
    done, data = cv2.imencode(suffix, image, [cv2.IMWRITE_TIFF_COMPRESSION, 1] if suffix == ".tiff" else [])
    assert done
    return data.tobytes()


def saved(tmp_path, image, name="photo.png"):
    path = tmp_path / name
    path.write_bytes(encoded(image, path.suffix))
    return path


def failure(path, read=read_image):
    with pytest.raises(ImageError) as caught:
        read(path)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def exif(orientation):
    """A TIFF block with the orientation and nothing else."""
    return struct.pack("<2sHIHHHIHHI", b"II", 42, 8, 1, 0x0112, 3, 1, orientation, 0, 0)


def exr(channels, compression=0, half=False):
    """An EXR of (H, W) channels by name, with compression 0 (none), 2 (ZIPS) or 3 (ZIP)."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    kind, dtype = (1, "<f2") if half else (2, "<f4")
    listing = b"".join(name.encode() + b"\0" + struct.pack("<4i", kind, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = {
        ("channels", "chlist"): listing,
        ("compression", "compression"): bytes([compression]),
        ("dataWindow", "box2i"): window,
        ("displayWindow", "box2i"): window,
        ("lineOrder", "lineOrder"): b"\0",
    }
    header = b"\x76\x2f\x31\x01" + struct.pack("<I", 2)
    for (name, of_type), value in attributes.items():
        header += name.encode() + b"\0" + of_type.encode() + b"\0" + struct.pack("<i", len(value)) + value
    header += b"\0"
    rows = 16 if compression == 3 else 1
    blocks = []
    for first in range(0, height, rows):
        lines = range(first, min(first + rows, height))
        data = b"".join(channels[name][line].astype(dtype).tobytes() for line in lines for name in names)
        if compression:
            data = min(zlib.compress(filtered(data)), data, key=len)
        blocks.append(struct.pack("<ii", first, len(data)) + data)
    at = len(header) + 8 * len(blocks)
    offsets = b""
    for block in blocks:
        offsets += struct.pack("<Q", at)
        at += len(block)
    return header + offsets + b"".join(blocks)


def filtered(data):
    """EXR's order of bytes before deflate: even places, then odd places, as differences around 128."""
    data = np.frombuffer(data, np.uint8)
    data = np.concatenate([data[0::2], data[1::2]]).astype(int)
    return np.concatenate([data[:1], (np.diff(data) + 128) % 256]).astype(np.uint8).tobytes()


@pytest.mark.parametrize("suffix", [".png", ".tiff", ".bmp"])
def test_a_photo_comes_back_as_rgb(tmp_path, suffix):
    assert np.array_equal(read_image(saved(tmp_path, RGB, f"photo{suffix}")), RGB)


UPRIGHT = {
    1: lambda image: image,
    2: lambda image: image[:, ::-1],
    3: lambda image: image[::-1, ::-1],
    4: lambda image: image[::-1],
    5: lambda image: image.transpose(1, 0, 2),
    6: lambda image: np.rot90(image, -1),
    7: lambda image: image[::-1, ::-1].transpose(1, 0, 2),
    8: lambda image: np.rot90(image),
}


@pytest.mark.parametrize("orientation", UPRIGHT)
def test_the_exif_orientation_is_honored(tmp_path, orientation):
    smooth = np.zeros((16, 32, 3), np.uint8)
    smooth[:8, :16], smooth[8:, :16], smooth[:8, 16:] = (250, 20, 20), (20, 250, 20), (20, 20, 250)
    jpeg = encoded(smooth, ".jpg")
    tag = b"Exif\0\0" + exif(orientation)
    path = tmp_path / "phone.jpg"
    path.write_bytes(jpeg[:2] + b"\xff\xe1" + struct.pack(">H", len(tag) + 2) + tag + jpeg[2:])
    expected = UPRIGHT[orientation](smooth)
    image = read_image(path)
    assert image.shape == expected.shape
    corners = ([2, 2, -3, -3], [2, -3, 2, -3])
    assert np.abs(image[corners].astype(int) - expected[corners]).max() < 12


def test_colors_and_opacity_become_eight_bits_and_what_is_invisible_black():
    pixels = np.array([[[0.5, 1.2, -1.0, 1.0], [0.2, 0.4, 0.6, 0.0]]], np.float32)
    assert eight_bits(pixels).tolist() == [[[128, 255, 0], [0, 0, 0]]]
    assert eight_bits(pixels[..., :3]).tolist() == [[[128, 255, 0], [51, 102, 153]]]


def test_alpha_is_dropped(tmp_path):
    alpha = np.dstack([RGB, np.arange(1, 55, dtype=np.uint8).reshape(6, 9)])
    assert np.array_equal(read_image(saved(tmp_path, alpha)), RGB)


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_what_a_png_makes_invisible_is_black(tmp_path, kind):
    most = np.iinfo(kind).max
    alpha = np.full((6, 9), most, kind)
    alpha[2:4, 3:] = 0
    read = read_image(saved(tmp_path, np.dstack([RGB.astype(kind) * (most // 255), alpha])))
    assert np.array_equal(read, np.where(alpha[..., None] > 0, RGB, 0))


def test_gray_becomes_three_equal_channels(tmp_path):
    assert np.array_equal(read_image(saved(tmp_path, RGB[..., 0])), np.repeat(RGB[..., :1], 3, axis=-1))


@pytest.mark.parametrize("suffix", [".png", ".tiff"])
def test_sixteen_bits_are_scaled_to_eight(tmp_path, suffix):
    assert np.array_equal(read_image(saved(tmp_path, RGB.astype(np.uint16) * 257, f"photo{suffix}")), RGB)
    assert read_image(saved(tmp_path, np.full((2, 2, 3), 65535 // 2, np.uint16), f"half{suffix}"))[0, 0, 0] == 127


def test_floating_point_photos_are_linear_and_become_srgb(tmp_path):
    linear = np.full((2, 2, 3), 0.2140411, np.float32)
    assert np.abs(read_image(saved(tmp_path, linear, "photo.tiff")).astype(int) - 127.5).max() <= 0.5
    (tmp_path / "photo.exr").write_bytes(exr(dict.fromkeys("RGB", linear[..., 0])))
    assert np.array_equal(read_image(tmp_path / "photo.exr"), read_image(tmp_path / "photo.tiff"))


@pytest.mark.parametrize("name", ["Straße.png", "写真.png", "with space.png", "PHOTO.PNG"])
def test_any_file_name_opens(tmp_path, name):
    assert np.array_equal(read_image(saved(tmp_path, RGB, name)), RGB)


def test_the_suffix_does_not_matter(tmp_path):
    assert np.array_equal(read_image(saved(tmp_path, RGB).rename(tmp_path / "photo")), RGB)


def test_two_hundred_megapixels_open(tmp_path):
    path = tmp_path / "large.png"
    path.write_bytes(cv2.imencode(".png", np.zeros((10_000, 20_000), np.uint8), [cv2.IMWRITE_PNG_COMPRESSION, 1])[1])
    assert read_measured(path)[0].shape == (10_000, 20_000)


def png_header(width, height):
    data = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunk = b"IHDR" + data
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", len(data)) + chunk + struct.pack(">I", zlib.crc32(chunk))


@pytest.mark.parametrize(
    ("contents", "said"),
    [
        (b"", "photo.jpg: is empty"),
        (b"not an image at all, but some words\n", "is not an image"),
        (bytes(5000), "is not an image"),
        (encoded(RGB)[:100], "is not a whole PNG: it is damaged or cut short"),
        (encoded(RGB, ".jpg")[:30], "is not a whole JPEG"),
        (png_header(900_000, 900_000) + encoded(RGB)[33:], "claims to be 900,000 x 900,000 pixels, expected 1 to 500,"),
        (
            png_header(30_000, 30_000) + bytes(2_600_000),
            "claims to be 30,000 x 30,000 pixels, expected 1 to 500,",
        ),
        (
            png_header(9_000, 9_000) + encoded(RGB)[33:],
            "9,000 x 9,000 pixels, more than the file can hold",
        ),
        (png_header(0, 9) + encoded(RGB)[33:], "claims to be 0 x 9 pixels"),
        (b"GIF89a" + bytes(100), "is not an image that can be read"),
        (b"P6\n1 1\n255\n123", "is not an image that can be read"),
        (b"#?RADIANCE\n" + bytes(100), "is not an image that can be read"),
        (b"\0\0\0\x0cjP  \r\n\x87\n" + bytes(100), "is not an image that can be read"),
        (b"\0\0\0\x18ftypheic" + bytes(100), "HEIC"),
    ],
)
def test_what_is_no_photo_is_told_in_one_line(tmp_path, capfd, contents, said):
    path = tmp_path / "photo.jpg"
    path.write_bytes(contents)
    assert said in failure(path)
    captured = capfd.readouterr()
    assert captured.out + captured.err == ""


@pytest.mark.parametrize("read", [read_image, read_measured, read_exr_channels])
def test_a_missing_file_and_a_directory_are_told(tmp_path, read):
    assert "missing.png" in failure(tmp_path / "missing.png", read)
    assert str(tmp_path) in failure(tmp_path, read)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32, np.float64])
def test_measured_images_keep_their_values(tmp_path, dtype):
    values = (np.arange(54).reshape(6, 9) * (1 if dtype == np.uint8 else 300.25)).astype(dtype)
    suffix = ".tiff" if np.dtype(dtype).kind == "f" else ".png"
    stored, opaque = read_measured(saved(tmp_path, values, f"depth{suffix}"))
    assert stored.dtype == dtype
    assert np.array_equal(stored, values)
    assert opaque is None


def test_a_measured_image_may_be_gray_in_three_channels_with_alpha(tmp_path):
    gray = np.repeat(RGB[..., :1], 3, axis=-1)
    alpha = np.where(np.arange(9) < 4, 0, 255) * np.ones((6, 1), int)
    stored, opaque = read_measured(saved(tmp_path, np.dstack([gray, alpha.astype(np.uint8)])))
    assert np.array_equal(stored, RGB[..., 0])
    assert np.array_equal(opaque, alpha > 0)


def test_a_colored_image_is_no_measurement(tmp_path):
    assert "its color channels differ" in failure(saved(tmp_path, RGB), read_measured)


@pytest.mark.parametrize("compression", [0, 2, 3])
@pytest.mark.parametrize("half", [False, True])
def test_exr_channels_come_back(tmp_path, compression, half):
    row, column = np.mgrid[:37, :53]
    channels = {"Z": row / 4 + column, "ViewLayer.A": (row > column) * 1.0}
    path = tmp_path / "depth.exr"
    path.write_bytes(exr(channels, compression, half))
    stored = read_exr_channels(path)
    assert stored.keys() == channels.keys()
    assert all(np.array_equal(stored[name], channels[name]) for name in channels)
    values, opaque = read_measured(path)
    assert np.array_equal(values, channels["Z"])
    assert np.array_equal(opaque, row > column)


def test_exr_files_that_are_not_read_are_told_in_one_line(tmp_path):
    whole = exr({"Z": np.ones((20, 30))}, 3)
    path = tmp_path / "depth.exr"
    for contents, said in (
        (exr({"Z": np.ones((20, 30))}, 4), "compressed with PIZ"),
        (whole[:8] + whole[8:].replace(b"dataWindow", b"dateWindow"), "damaged or cut short"),
        (whole[:4] + b"\x02\x02" + whole[6:], "is tiled"),
        (whole[:-20], "damaged or cut short"),
        (whole[:60], "damaged or cut short"),
        (exr({"X": np.ones((2, 3)), "Y": np.zeros((2, 3))}), "its channels X, Y differ"),
    ):
        path.write_bytes(contents)
        assert said in failure(path, read_measured)


def test_an_exr_cut_or_changed_anywhere_never_leaves_the_error_family(tmp_path):
    whole = exr({"Z": np.random.default_rng(0).random((20, 30))}, 3)
    path = tmp_path / "depth.exr"
    rng = np.random.default_rng(1)
    for _ in range(300):
        data = bytearray(whole)
        data[rng.integers(4, len(whole))] = rng.integers(256)
        path.write_bytes(data[: rng.integers(4, 2 * len(whole))])
        try:
            read_measured(path)
        except ImageError as error:
            assert "\n" not in str(error)


@pytest.mark.parametrize("shape", [(5, 4), (5, 4, 3), (5, 4, 4)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_a_png_that_is_written_reads_back(tmp_path, shape, dtype):
    image = np.random.default_rng(4).integers(0, np.iinfo(dtype).max, shape, dtype, endpoint=True)
    path = tmp_path / "结果.png"
    write_png(path, image)
    back = cv2.imdecode(np.fromfile(path, np.uint8), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(back if len(shape) == 2 else back[..., [2, 1, 0, *range(3, shape[2])]], image)


def test_a_png_that_cannot_be_written_leaves_nothing_and_is_told(tmp_path):
    for path in (tmp_path / "missing" / "out.png", tmp_path):
        with pytest.raises(OutputError) as caught:
            write_png(path, RGB)
        assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_png_without_its_texts_has_the_same_pixels(tmp_path):
    rgb = np.random.default_rng(0).integers(0, 256, (8, 9, 3)).astype(np.uint8)
    write_png(tmp_path / "a.png", rgb)
    plain = (tmp_path / "a.png").read_bytes()
    texts = b""
    for kind, data in ((b"tEXt", b"Date\0today"), (b"tIME", b"1234567")):
        texts += struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    told = plain[:33] + texts + plain[33:]
    (tmp_path / "b.png").write_bytes(told)
    assert without_text(told) == plain == without_text(plain)
    assert without_text(plain[:-20]) == plain[:-20] and without_text(told[:50]) == told[:50]
    assert np.array_equal(read_image(tmp_path / "b.png"), rgb)
