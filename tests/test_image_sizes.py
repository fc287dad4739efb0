"""The size of an image is read from its header before anything decodes it."""

import cv2
import numpy as np
import pytest

from reflcolor_addon.errors import ImageError
from reflcolor_addon.files import image_size
from reflcolor_addon.files.image_headers import image_header
from reflcolor_addon.files.images import read_image

IMAGE = np.random.default_rng(7).integers(0, 256, (21, 34, 3), np.uint8)
LOSSY, LOSSLESS = [cv2.IMWRITE_WEBP_QUALITY, 80], [cv2.IMWRITE_WEBP_QUALITY, 101]
WAYS = {
    "PNG": (".png", []),
    "JPEG": (".jpg", []),
    "progressive JPEG": (".jpg", [cv2.IMWRITE_JPEG_PROGRESSIVE, 1]),
    "TIFF": (".tiff", []),
    "WebP": (".webp", LOSSY),
    "lossless WebP": (".webp", LOSSLESS),
    "BMP": (".bmp", []),
}


def encoded(suffix, options, image=IMAGE):
    return bytearray(cv2.imencode(suffix, image, options)[1].tobytes())


@pytest.mark.parametrize(("suffix", "options"), WAYS.values(), ids=WAYS)
def test_every_kind_tells_its_size(suffix, options):
    header = image_header(encoded(suffix, options), "a")
    assert (header.width, header.height) == (34, 21)


def test_a_webp_with_alpha_tells_its_size(tmp_path):
    data = encoded(".webp", LOSSY, np.dstack([IMAGE, IMAGE[..., 0]]))
    assert data[12:16] == b"VP8X"
    header = image_header(data, "a")
    assert (header.width, header.height) == (34, 21)


def test_a_jpeg_with_other_segments_before_its_size_tells_it():
    data = encoded(".jpg", [])
    data[2:2] = b"\xff\xe1\x00\x08" + b"\xff\xc0\x00\x11ab" + b"\xff\xff\xfe\x00\x04ok"
    assert image_header(data, "a").width == 34


@pytest.mark.parametrize(("suffix", "options"), WAYS.values(), ids=WAYS)
def test_what_does_not_fit_into_memory_is_told_before_it_is_decoded(tmp_path, monkeypatch, suffix, options):
    path = tmp_path / "a.jpg"
    path.write_bytes(encoded(suffix, options))
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("it was decoded"))
    monkeypatch.setattr("reflcolor_addon.files.memory.available_bytes", lambda: 8000)
    with pytest.raises(ImageError, match=r"^a\.jpg: 34 x 21 pixels needs about .* of memory, and 7\.81 KB are free$"):
        read_image(path)


@pytest.mark.parametrize(("suffix", "options"), WAYS.values(), ids=WAYS)
def test_a_header_that_is_cut_anywhere_is_told(suffix, options):
    data = encoded(suffix, options)
    for length in range(2, min(len(data), 400)):
        try:
            image_header(data[:length], "a")
        except ImageError as error:
            assert str(error).isprintable()


def test_limits_are_those_of_a_scan():
    with pytest.raises(ImageError, match="expected 1 to 500,000,000 in all"):
        image_size.require_size(30_000, 30_000, 3, "a", most=10**12)
    with pytest.raises(ImageError, match="expected 1 to"):
        image_size.require_size(2_000_000, 1, 3, "a", most=10**12)
    image_size.require_size(10, 10, 3, "a", most=300)
