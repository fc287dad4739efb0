"""Image files as arrays: photos upright in 8-bit sRGB, measured images with every bit that they have."""

from pathlib import Path

import numpy as np

from ..errors import ImageError, OutputError
from ..messages import Message
from ..srgb import linear_to_srgb8
from .atomic import written_atomically
from .color_profiles import embedded_profile
from .exr import exr_channels, is_exr
from .gate import contents
from .native_noise import quiet_on_failure

IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp", ".exr")
"""Image files that can be opened; for file dialogs."""

_PNG, _PNG_WITH_ALPHA = b"\x89PNG\r\n\x1a\n", (4, 6)
_EXPECTED = "an image (PNG, JPEG, TIFF, WebP, BMP or EXR)"
_LARGEST_FILE = 1 << 32


def read_image(path, warnings=None, *, cancelled=None):
    """Read a photo.

    Parameters
    ----------
    path : path-like
        Of any name on any platform. Its EXIF orientation is honored; an alpha channel is dropped, but what it makes
        invisible in a PNG is black; gray becomes three equal channels, 16 bits are scaled to 8, and linear
        floating-point colors (EXR, float TIFF) are sRGB encoded. Colors in another space (Display P3, Adobe RGB) are
        converted, if the file's ICC profile is one of a matrix and curves.
    warnings : list, optional
        Gets a `Message` where a profile cannot be followed, so that the colors are taken as sRGB.

    Returns
    -------
    (H, W, 3) uint8
        sRGB, row 0 at the top.

    Raises
    ------
    ImageError
        If there is no such file, or it is no image or a broken one.
    """
    import cv2

    path = Path(path)
    data = contents(path, _EXPECTED, error=ImageError, most=_LARGEST_FILE, cancelled=cancelled)
    if is_exr(data):
        return _srgb_of_light(_color_of_exr(exr_channels(data, path.name), path))
    image = _decoded(path, data, cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH)
    cv2.cvtColor(image, cv2.COLOR_BGR2RGB, dst=image)
    if data.startswith(_PNG) and data[25] in _PNG_WITH_ALPHA:
        alpha = _decoded(path, data, cv2.IMREAD_UNCHANGED)[..., -1]
        if alpha.shape == image.shape[:2]:
            image[alpha == 0] = 0
    if image.dtype == np.uint16:
        image = ((np.arange(65536) * 255 + 32767) // 65535).astype(np.uint8)[image]
    if image.dtype == np.uint8:
        return _in_srgb(image, data, path, warnings)
    if image.dtype.kind == "f":
        return _srgb_of_light(image)
    raise ImageError(f"{path.name}: its pixels are {image.dtype}, expected 8 or 16 bits or floating point")


def _in_srgb(image, data, path, warnings):
    profile = embedded_profile(data)
    if profile is None:
        return image
    if not profile.known and warnings is not None:
        text = "{file}: its color profile{name} is one of tables, which is not followed; its colors are taken as sRGB"
        warnings.append(Message(text, file=path.name, name=f" ({profile.name})" if profile.name else ""))
    return profile.to_srgb(image)


def eight_bits(pixels):
    """Return the (H, W, 3) uint8 of (H, W, 3 or 4) float colors and opacity of 0 to 1; what is invisible is black."""
    rgb = np.rint(np.clip(pixels[..., :3], 0, 1) * 255).astype(np.uint8)
    if pixels.shape[2] == 4:
        rgb[pixels[..., 3] == 0] = 0
    return rgb


def read_measured(path, *, cancelled=None):
    """Read an image whose pixels are measurements: range, reflectance, infrared.

    Parameters
    ----------
    path : path-like

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

    path = Path(path)
    data = contents(path, _EXPECTED, error=ImageError, most=_LARGEST_FILE, cancelled=cancelled)
    if is_exr(data):
        return _measured_of_exr(exr_channels(data, path.name), path)
    image = _decoded(path, data, cv2.IMREAD_UNCHANGED)
    if image.ndim == 2:
        return image, None
    opaque = image[..., -1] != 0 if image.shape[2] in (2, 4) else None
    colors = image[..., : image.shape[2] - (opaque is not None)]
    seen = colors if opaque is None else colors[opaque]
    if not (seen == seen[..., :1]).all():
        raise ImageError(f"{path.name}: its color channels differ, expected a gray image with one value per pixel")
    return np.ascontiguousarray(colors[..., 0]), opaque


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
    import cv2

    image = np.asarray(image)
    if image.ndim == 3:
        image = cv2.cvtColor(image, {3: cv2.COLOR_RGB2BGR, 4: cv2.COLOR_RGBA2BGRA}[image.shape[2]])
    try:
        done, data = cv2.imencode(".png", np.ascontiguousarray(image))
    except cv2.error as error:
        done, reason = False, error.err
    else:
        reason = "the encoder refused it"
    if not done:
        raise OutputError(f"{path}: cannot be encoded as PNG ({reason})")
    with written_atomically(path) as temporary:
        temporary.write_bytes(data)


def _decoded(path, data, flags):
    # Decoding from memory: OpenCV's own file opening knows no non-ASCII paths on Windows.
    import cv2

    image, reason = None, None
    try:
        with quiet_on_failure():
            image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
            if image is None:
                raise ImageError
    except ImageError:
        if data[4:12] in (b"ftypheic", b"ftypheix", b"ftypmif1"):
            reason = f"is a HEIC photo, which is not read; save it as JPEG or PNG ({_EXPECTED})"
        else:
            reason = f"is not an image that can be read, or is cut short; {_EXPECTED}"
    except MemoryError:
        reason = "does not fit into memory"
    except cv2.error as error:
        reason = f"cannot be decoded ({error.err.strip() or 'unknown error'})"
        if "CV_IO_MAX_IMAGE" in error.err:
            reason = "has more than 1,073,741,824 pixels or a side longer than 1,048,576; make it smaller"
    if reason:
        raise ImageError(f"{path.name}: {reason}")
    return image


def _color_of_exr(channels, path):
    """(H, W, 3) from R, G, B, or from Y, of the first layer that has them."""
    for name in channels:
        layer, _, channel = name.rpartition(".")
        prefix = f"{layer}." if layer else ""
        if channel == "R" and all(prefix + other in channels for other in "GB"):
            return np.stack([channels[prefix + color] for color in "RGB"], axis=-1)
        if channel in ("Y", "V") and prefix + "R" not in channels:
            return np.repeat(channels[name][..., None], 3, axis=-1)
    raise ImageError(f"{path.name}: holds no R, G, B or Y, found {', '.join(channels)}")


def _measured_of_exr(channels, path):
    """The one channel there is, or the depth, or three equal colors."""
    alpha = next((channels[name] for name in channels if name.rpartition(".")[2] == "A"), None)
    values = {name: channel for name, channel in channels.items() if name.rpartition(".")[2] != "A"}
    depth = [name for name in values if name.rpartition(".")[2] in ("Z", "Depth", "depth")]
    names = depth or list(values)
    if not names:
        raise ImageError(f"{path.name}: holds no channel but alpha, expected one value per pixel")
    first = values[names[0]]
    if any(not np.array_equal(first, values[name], equal_nan=True) for name in names[1:]):
        raise ImageError(f"{path.name}: its channels {', '.join(names)} differ, expected one value per pixel")
    return first, None if alpha is None else alpha != 0


def _srgb_of_light(linear):
    """Linear light as 8-bit sRGB; what is not a number is black."""
    return linear_to_srgb8(np.nan_to_num(linear, nan=0.0))
