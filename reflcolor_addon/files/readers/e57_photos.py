"""Photos inside an E57 file: listed, and read as photos to take colors from (ASTM E2807, sections 6.14 to 6.20).

No native reader of E57 sees them: their places are in the XML section, their bytes are plain JPEG or PNG files.
"""

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import ImageError, ScanError
from ...messages import Message, one_line
from ...scan.limits import LONGEST_NAME
from ..e57_pages import PAGE, PAYLOAD, contents, first_bad_page
from ..gate import opened
from ..images import image_of
from ..memory import require_memory
from ..photo import Photo, Place
from .e57_file import read_structure
from .panorama import faces
from .poses import quaternion_pose

PINHOLE, SPHERICAL, VISUAL = "pinhole", "spherical", "visual reference"
_KINDS = {
    "pinholeRepresentation": PINHOLE,
    "sphericalRepresentation": SPHERICAL,
    "visualReferenceRepresentation": VISUAL,
    "cylindricalRepresentation": Message("cylindrical"),
}
_USED = (PINHOLE, SPHERICAL, VISUAL)
_NOT_USED = (
    "it is {kind}; photos are compared with a scan as pinhole, spherical or visual reference images: export it as one "
    "of these, or straighten it and give the picture with --photo"
)
_BLOBS = ("jpegImage", "pngImage")
_BLOB_HEADER = 16
"""Bytes of a binary section before what it holds."""

_LARGEST = 1 << 30
_MOST_PHOTOS = 1000
# A camera of E57 looks along -Z, with X to the right and Y up.
_AXES = np.diag([1.0, -1.0, -1.0])


@dataclass(frozen=True, eq=False, kw_only=True)
class PhotoInside:
    """What a file says of one of its photos.

    Parameters
    ----------
    name : str
        Another one for each photo of the file.
    kind : str
        "pinhole", "spherical", "visual reference", "cylindrical", or "unknown".
    size : (width, height) or None
        As stated.
    pose : (4, 4) float64 or None
        Camera to world, where it is stated.
    usable : bool
        Whether it can be used as a photo.
    """

    name: str
    kind: str
    size: tuple[int, int] | None
    pose: np.ndarray | None
    usable: bool
    blob: tuple[int, int] | None = field(default=None, repr=False)
    representation: object = field(default=None, repr=False)


def photos_inside(path):
    """Return the `PhotoInside` of every photo of an E57 file; none where it is not E57.

    Raises
    ------
    ScanError
        In one line, if the file cannot be read.
    """
    path = Path(path)
    if path.suffix.lower() != ".e57":
        return []
    with opened(path, Message("an E57 file"), error=ScanError) as file:
        return _listed(file, path)


def read_photos(path, warnings=None, *, cancelled=None):
    """Read the photos of an E57 file that can be used.

    A spherical one becomes up to six photos of 90 degrees, so that it can be compared with a scan like any other.

    Parameters
    ----------
    path : path-like
    warnings : list, optional
        Gets a `Message` for each photo that cannot be used.
    cancelled : callable, optional

    Returns
    -------
    list of Photo

    Raises
    ------
    ImageError
        In one line, if the file cannot be read, or none of its photos can be used.
    """
    path, warnings = Path(path), [] if warnings is None else warnings
    found = []
    try:
        with opened(path, Message("an E57 file"), error=ScanError) as file:
            listed = _listed(file, path, cancelled)
            for inside in listed:
                if not inside.usable:
                    warnings.append(_left_out(path, inside, Message(_NOT_USED, kind=inside.kind)))
                    continue
                try:
                    found += _photos(file, path, inside, warnings)
                except ImageError as error:
                    warnings.append(_left_out(path, inside, error.message))
    except ScanError as error:
        raise ImageError(error.message.template, **error.message.values) from None
    if not found:
        raise ImageError("{file}: holds no photo that can be used", file=path.name)
    return found


def _left_out(path, inside, reason):
    return Message("{file}: its photo {photo} is left out: {reason}", file=path.name, photo=inside.name, reason=reason)


def _listed(file, path, cancelled=None):
    root, _ = read_structure(file, path, cancelled)
    images = root.child("images2D")
    if images is None or images.kind != "Vector":
        return []
    listed, names = [], set()
    for number, node in enumerate(images.children[:_MOST_PHOTOS], 1):
        tag = next((tag for tag in _KINDS if node.child(tag) is not None), None)
        representation = None if tag is None else node.child(tag)
        blob = None if representation is None else _blob(representation)
        kind = Message("unknown") if tag is None else _KINDS[tag]
        listed.append(
            PhotoInside(
                name=_name(node, path, number, names),
                kind=kind,
                size=None if representation is None else _size(representation),
                pose=_pose(node),
                usable=kind in _USED and blob is not None,
                blob=blob,
                representation=representation,
            )
        )
    return listed


def _name(node, path, number, taken):
    """The name of a photo as it is in the file, without what a path could be made of; each once."""
    stored = node.child("name")
    text = stored.text if stored is not None and stored.kind == "String" else ""
    text = "".join(letter if letter.isprintable() and letter not in "/\\:" else "_" for letter in text.strip())
    name = one_line(f"{path.stem} {text[:LONGEST_NAME] or number}", LONGEST_NAME)
    fresh = name
    while fresh in taken:
        fresh = f"{name} {number}"
        number += 1
    taken.add(fresh)
    return fresh


def _blob(representation):
    """(first byte in the file, bytes) of the image; None where there is none."""
    node = next((node for name in _BLOBS if (node := representation.child(name)) is not None), None)
    if node is None or node.kind != "Blob":
        return None
    start, length = int(node.attributes["fileOffset"]), int(node.attributes["length"])
    return (start, length) if 0 < length <= _LARGEST else None


def _size(representation):
    size = tuple(representation.number(name) for name in ("imageWidth", "imageHeight"))
    return None if None in size or min(size) < 1 or max(size) > 1e6 else (int(size[0]), int(size[1]))


def _pose(node):
    """(4, 4) camera to world; None where it is not stated, or makes no sense."""
    if node.child("pose") is None:
        return None
    rotation = [node.number("pose", "rotation", name) for name in "wxyz"]
    translation = [node.number("pose", "translation", name) for name in "xyz"]
    quaternion = np.array([1.0, 0, 0, 0] if None in rotation else rotation)
    pose, doubts = quaternion_pose(quaternion, np.array([value or 0.0 for value in translation]), "")
    return None if doubts or not np.isfinite(pose).all() else pose


def _photos(file, path, inside, warnings):
    """One photo; of a spherical image those of its parts."""
    rgb = image_of(_bytes_of(file, path, inside), inside.name, warnings)
    if inside.kind == SPHERICAL:
        angles = [inside.representation.number(name) for name in ("pixelWidth", "pixelHeight")]
        step = [angle if angle is not None and angle > 0 else None for angle in angles]
        if None in step:
            step = [2 * math.pi / rgb.shape[1]] * 2
        return [
            Photo(name=f"{inside.name} {side}", rgb=view, place=_place(inside.pose, turn, view.shape[1] / 2))
            for side, view, turn in faces(rgb, *_for_size(step, inside.size, rgb.shape))
        ]
    if inside.kind == PINHOLE and inside.pose is not None:
        return [Photo(name=inside.name, rgb=rgb, place=_place(inside.pose, _AXES, _focal_px(inside, rgb.shape)))]
    return [Photo(name=inside.name, rgb=rgb)]


def _bytes_of(file, path, inside):
    """The bytes of the image, as it lies in the file across pages."""
    start, length = inside.blob
    require_memory(2 * length, inside.name, error=ImageError)
    first, before = start // PAGE, start % PAGE
    try:
        if first_bad_page(file, first, -(-(before + _BLOB_HEADER + length) // PAYLOAD)) is not None:
            raise ImageError("a checksum does not match: the file is damaged; copy or export it again")
        return contents(file, start, _BLOB_HEADER + length)[_BLOB_HEADER:]
    except EOFError:
        raise ImageError("it lies outside of the file; the file is damaged") from None


def _for_size(steps, stated, shape):
    """Angles of a pixel across and down for an image of another size than the stated one."""
    if stated is None:
        return steps
    return [steps[0] * stated[0] / shape[1], steps[1] * stated[1] / shape[0]]


def _focal_px(inside, shape):
    """Focal length in pixels of the image that was found; None where it is not stated, or for another image."""
    focal, pixel = (inside.representation.number(name) for name in ("focalLength", "pixelWidth"))
    if not focal or not pixel or not 1e-3 < focal / pixel < 1e7:
        return None
    width, height = inside.size or (shape[1], shape[0])
    scale = shape[1] / width
    # An image of another shape was cropped or rotated: the stated values do not apply to it.
    return focal / pixel * scale if abs(shape[0] / (height * scale) - 1) < 0.01 else None


def _place(pose, axes, focal_px):
    """Where a camera with these (3, 3) axes in the frame of the photo's pose looks from."""
    if pose is None or focal_px is None:
        return None
    return Place(rotation=axes @ pose[:3, :3].T, center=pose[:3, 3], focal_px=float(focal_px))
