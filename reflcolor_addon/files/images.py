"""Image files as arrays: photos upright in 8-bit sRGB, measured images with every bit that they have."""

from contextlib import suppress
from pathlib import Path

import numpy as np

from ..errors import ImageError, OutputError
from ..messages import Message
from ..srgb import linear_to_srgb8
from .atomic import written_atomically
from .color_profiles import embedded_profile
from .exr import exr_channels
from .gate import contents, opened
from .image_headers import EXPECTED, image_header
from .native_noise import native_output_aside
from .tiff import tiff_pixels, upright

IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp", ".exr")
"""Image files that can be opened; for file dialogs."""

_LARGEST_FILE, _START = 1 << 32, 1 << 17
_DAMAGE = ("Corrupt JPEG data", "Premature end of JPEG", "Invalid SOS parameters", "Inconsistent progression")


def read_image(path, warnings=None, *, cancelled=None):
    """Read a photo.

    Parameters
    ----------
    path : path-like
        Of any name on any platform. Its orientation is honored; an alpha channel is dropped, but what it makes
        invisible in a PNG or TIFF is black; gray becomes three equal channels, 16 bits are scaled to 8, and linear
        floating-point colors (EXR, float TIFF) are sRGB encoded. Colors in another space (Display P3, Adobe RGB) are
        converted, if the file's ICC profile is one of a matrix and curves.
    warnings : list, optional
        Gets a `Message` where a profile cannot be followed, so that the colors are taken as sRGB, where parts of the
        picture are damaged, and where the file holds more pictures than the one that is read.

    Returns
    -------
    (H, W, 3) uint8
        sRGB, row 0 at the top.

    Raises
    ------
    ImageError
        If there is no such file, or it is no image or a broken one.
    """
    return image_of(_contents(path, cancelled), Path(path).name, warnings)


def image_of(data, name, warnings=None):
    """Return the (H, W, 3) uint8 of the bytes of an image file; see `read_image`."""
    header = image_header(data, name)
    if header is None:
        return _srgb_of_light(_color_of_exr(exr_channels(data, name), name))
    values, alpha = _pixels(data, header, name, [] if warnings is None else warnings)
    _tell_pictures(header, name, warnings)
    rgb = _eight_bit_colors(values, name)
    if alpha is not None:
        rgb[alpha == 0] = 0
    if header.layout is not None:
        rgb = upright(rgb, header.layout.orientation)
    return rgb if values.dtype.kind == "f" else _in_srgb(rgb, data, name, warnings)


def image_size(path):
    """Return (rows, columns) of an image as its header claims them, held against the file and the memory.

    Raises
    ------
    ImageError
        As `read_image`, as far as it can be known.
    """
    with opened(path, EXPECTED, error=ImageError, most=_LARGEST_FILE) as file:
        start = file.read(_START)
    if start.startswith(b"\xff\xd8"):
        # Of a JPEG the beginning is enough, unless it holds more about the photo than cameras write.
        with suppress(ImageError):
            header = image_header(start, Path(path).name)
            return header.height, header.width
    return _size_of(_contents(path, None), Path(path).name)


def check_image(path, *, cancelled=None):
    """Return what `image_size` does, of an image that can be decoded.

    Raises
    ------
    ImageError
        As `read_image`, also where it is damaged or cut short.
    """
    data, name = _contents(path, cancelled), Path(path).name
    if not data.startswith(b"\xff\xd8"):
        return image_of(data, name).shape[:2]
    import cv2

    # A JPEG is decoded to an eighth of its size, which takes a fraction of the time and reads all of it.
    size = _size_of(data, name)
    _decoded(data, cv2.IMREAD_REDUCED_COLOR_8, name)
    return size


def _size_of(data, name):
    header = image_header(data, name)
    if header is None:
        return next(iter(exr_channels(data, name).values())).shape
    return header.height, header.width


def _contents(path, cancelled):
    return contents(path, EXPECTED, error=ImageError, most=_LARGEST_FILE, cancelled=cancelled)


def _pixels(data, header, name, warnings=None):
    """(H, W) or (H, W, 3) values, in RGB, and the opacity or None; of all kinds but EXR."""
    import cv2

    if header.layout is not None:
        return tiff_pixels(data, header.layout, name, lambda part: _decoded(part, cv2.IMREAD_UNCHANGED, name, warnings))
    if header.has_alpha:
        image = _decoded(data, cv2.IMREAD_UNCHANGED, name, warnings)
        return cv2.cvtColor(image, cv2.COLOR_BGRA2RGB), image[..., 3]
    image = _decoded(data, cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH, name, warnings)
    return cv2.cvtColor(image, cv2.COLOR_BGR2RGB, dst=image), None


def _tell_pictures(header, name, warnings):
    if header.pictures > 1 and warnings is not None:
        warnings.append(Message("{file}: holds {count} pictures; the first was read", file=name, count=header.pictures))


def _eight_bit_colors(values, name):
    """(H, W, 3) uint8 of colors of any kind; floating point is linear light."""
    if values.ndim == 2:
        values = np.repeat(values[..., None], 3, axis=-1)
    if values.dtype == np.uint8:
        return np.ascontiguousarray(values)
    if values.dtype == np.uint16:
        return ((np.arange(65536) * 255 + 32767) // 65535).astype(np.uint8)[values]
    if values.dtype.kind == "u":
        return np.rint(values * (255 / np.iinfo(values.dtype).max)).astype(np.uint8)
    if values.dtype.kind == "f":
        return _srgb_of_light(values)
    raise ImageError(
        "{file}: its samples are signed, expected colors from 0 on; save the photo with 8 or 16 bits, unsigned",
        file=name,
    )


def _in_srgb(image, data, name, warnings):
    profile = embedded_profile(data)
    if profile is None:
        return image
    if not profile.known and warnings is not None:
        text = (
            "{file}: its color profile{name} consists of tables, which are not supported; its colors are taken as sRGB"
        )
        warnings.append(Message(text, file=name, name=f" ({profile.name})" if profile.name else ""))
    return profile.to_srgb(image)


def eight_bits(pixels):
    """Return the (H, W, 3) uint8 of (H, W, 3 or 4) float colors and opacity of 0 to 1; what is invisible is black."""
    rgb = np.rint(np.clip(pixels[..., :3], 0, 1) * 255).astype(np.uint8)
    if pixels.shape[2] == 4:
        rgb[pixels[..., 3] == 0] = 0
    return rgb


def read_measured(path, warnings=None, *, cancelled=None):
    """Read an image whose pixels are measurements: range, reflectance, infrared.

    Parameters
    ----------
    path : path-like
    warnings : list, optional
        Gets a `Message` where the file holds more pictures than the one that is read.

    Returns
    -------
    values : (H, W) uint8, uint16, int16, int32, float32 or float64
        As stored, nothing scaled or turned.
    opaque : (H, W) bool or None
        Where the alpha channel is not zero; None where the image has none.

    Raises
    ------
    ImageError
        If there is no such file, it is no image or a broken one, or its colors differ: a measurement has one channel.
    """
    import cv2

    data, name = _contents(path, cancelled), Path(path).name
    header = image_header(data, name)
    if header is None:
        return _measured_of_exr(exr_channels(data, name), name)
    if header.has_alpha or header.layout is not None:
        values, alpha = _pixels(data, header, name)
    else:
        values, alpha = _decoded(data, cv2.IMREAD_UNCHANGED, name), None
    _tell_pictures(header, name, warnings)
    opaque = None if alpha is None else alpha != 0
    if values.ndim == 3:
        seen = values if opaque is None else values[opaque]
        if not (seen == seen[..., :1]).all():
            raise ImageError(
                "{file}: its color channels differ, expected a gray image with one value per pixel", file=name
            )
        values = values[..., 0]
    return np.ascontiguousarray(values), opaque


def write_png(path, image):
    """Write a PNG that is whole or not there.

    Parameters
    ----------
    path : path-like
    image : (H, W), (H, W, 3) or (H, W, 4) uint8 or uint16
        Gray, RGB or RGBA.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    _write_encoded(path, image, ".png", "PNG")


def write_jpeg(path, image, quality=85):
    """Write a JPEG that is whole or not there.

    Parameters
    ----------
    path : path-like
    image : (H, W) or (H, W, 3) uint8
        Gray or sRGB.
    quality : int
        1 to 100.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    import cv2

    _write_encoded(path, image, ".jpg", "JPEG", (cv2.IMWRITE_JPEG_QUALITY, quality))


def png_bytes(image, path):
    """Return an image, as `write_png` takes it, as the bytes of a PNG; ``path`` is named in the OutputError."""
    return _encoded(path, image, ".png", "PNG")


def _write_encoded(path, image, suffix, name, options=()):
    data = _encoded(path, image, suffix, name, options)
    with written_atomically(path) as temporary:
        temporary.write_bytes(data)


def _encoded(path, image, suffix, name, options=()):
    import cv2

    image = np.asarray(image)
    if image.ndim == 3:
        image = cv2.cvtColor(image, {3: cv2.COLOR_RGB2BGR, 4: cv2.COLOR_RGBA2BGRA}[image.shape[2]])
    try:
        done, data = cv2.imencode(suffix, np.ascontiguousarray(image), options)
    except cv2.error as error:
        done, reason = False, error.err
    else:
        reason = "the encoder refused it"
    if not done:
        raise OutputError("{path}: cannot be encoded as {name} ({reason})", path=path, name=name, reason=reason)
    return data.tobytes()


def _decoded(data, flags, name, warnings=None):
    """The pixels as OpenCV has them; of a picture that is damaged only where that can be told in ``warnings``."""
    # Decoding from memory: OpenCV's own file opening knows no non-ASCII paths on Windows.
    import cv2

    try:
        with native_output_aside() as said:
            image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    except cv2.error as error:
        raise ImageError(
            "{file}: cannot be decoded ({reason})", file=name, reason=error.err.strip() or "unknown error"
        ) from None
    except MemoryError:
        raise ImageError("{file}: does not fit into memory", file=name) from None
    if image is None:
        raise ImageError("{file}: cannot be decoded: it is damaged or cut short", file=name)
    # libjpeg fills the missing part of a broken JPEG with gray and reports success.
    damage = next((line for line in said if line.startswith(_DAMAGE)), None)
    if damage is not None:
        if warnings is None:
            raise ImageError("{file}: is damaged ({reason})", file=name, reason=damage)
        text = "{file}: is damaged ({reason}); parts of it may be missing or wrong"
        warnings.append(Message(text, file=name, reason=damage))
    return image


def _color_of_exr(channels, name):
    """(H, W, 3) from R, G, B, or from Y, of the first layer that has them."""
    for channel_name in channels:
        layer, _, channel = channel_name.rpartition(".")
        prefix = f"{layer}." if layer else ""
        if channel == "R" and all(prefix + other in channels for other in "GB"):
            return np.stack([channels[prefix + color] for color in "RGB"], axis=-1)
        if channel in ("Y", "V") and prefix + "R" not in channels:
            return np.repeat(channels[channel_name][..., None], 3, axis=-1)
    raise ImageError("{file}: holds no R, G, B or Y, found {found}", file=name, found=", ".join(channels))


def _measured_of_exr(channels, name):
    """The one channel there is, or the depth, or three equal colors."""
    alpha = next((channels[key] for key in channels if key.rpartition(".")[2] == "A"), None)
    values = {key: channel for key, channel in channels.items() if key.rpartition(".")[2] != "A"}
    depth = [key for key in values if key.rpartition(".")[2] in ("Z", "Depth", "depth")]
    names = depth or list(values)
    if not names:
        raise ImageError("{file}: holds no channel but alpha, expected one value per pixel", file=name)
    first = values[names[0]]
    if any(not np.array_equal(first, values[key], equal_nan=True) for key in names[1:]):
        raise ImageError(
            "{file}: its channels {found} differ, expected one value per pixel", file=name, found=", ".join(names)
        )
    return first, None if alpha is None else alpha != 0


def _srgb_of_light(linear):
    """Linear light as 8-bit sRGB; what is not a number is black."""
    return linear_to_srgb8(np.nan_to_num(linear, nan=0.0))
