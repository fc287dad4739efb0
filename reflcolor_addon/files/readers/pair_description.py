"""The description of two images that a person picked: which is the range, and how the sensor looks."""

from pathlib import Path

from ...errors import ScanError
from ..images import read_measured
from .scan_json import write_scan_json

_RANGE_WORDS = ("depth", "range", "dist")


def describe_pair(first, second, model, *, range_scale, swap=False):
    """Write the ``.scan.json`` of two images beside them.

    The range image is the one whose name says so (depth, range, dist), else the one with more bits per pixel.

    Parameters
    ----------
    first, second : path
        A range and a reflectance image, in any order, in one folder.
    model : dict
        The sensor model as it stands in the file.
    range_scale : float
        Metres for one unit of the range image.
    swap : bool
        Take the other one as the range image.

    Returns
    -------
    Path
        The file written: named after both images, so that the same pair is described anew and no other file is lost.

    Raises
    ------
    ScanError
        If the images cannot be told apart, or the model is not valid.
    ImageError
        If one cannot be read.
    OutputError
        If the folder cannot be written to.
    """
    images = [Path(first), Path(second)]
    named = [any(word in path.stem.lower() for word in _RANGE_WORDS) for path in images]
    if named[0] == named[1]:
        depths = [read_measured(path)[0].dtype.itemsize for path in images]
        if depths[0] == depths[1]:
            raise ScanError(
                '{first}, {second}: cannot tell which is the range image; put "depth" or "range" into its file name',
                first=images[0].name,
                second=images[1].name,
            )
        named = [depths[0] > depths[1], depths[1] > depths[0]]
    range_image, reflectance_image = images if named[0] != swap else images[::-1]
    # Blender's properties are float32: what was typed as 0.001 is 0.0010000000474974513.
    model = {key: _as_typed(value) for key, value in model.items()}
    path = reflectance_image.with_name(f"{reflectance_image.stem}+{range_image.stem}.scan.json")
    write_scan_json(
        path,
        range_image=range_image,
        reflectance_image=reflectance_image,
        model=model,
        range_scale=_as_typed(range_scale),
    )
    return path


def _as_typed(value):
    """The number of six digits that a float32 stands for; sequences by their parts, anything else as it is."""
    if isinstance(value, tuple | list):
        return [_as_typed(part) for part in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value
