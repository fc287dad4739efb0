"""What a viewport can show of a scan: its colors, or maps of the values at its vertices.

A map is a color attribute of its own, made when it is asked for and removed when another is shown. So everything about
it is on the mesh, where undo, copies and files take care of it. Renders and exports never use it.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
from bpy.app.translations import pgettext_n as n_

from ...reflcolor_addon.errors import ScanError
from ...reflcolor_addon.view.colormaps import limits_of, painted, region_colors
from .scan_object import (
    COLORIZED,
    CONFIDENCE,
    ERROR,
    GRAY,
    NEAREST_SEED,
    OBSERVED,
    PHOTO,
    SCANNED,
    add_colors,
    look_at,
    show_colors,
    values_of,
)
from .texts import report_text

LEGEND = "reflcolor_legend"


@dataclass(frozen=True, kw_only=True)
class DisplayMode:
    """One thing to look at.

    Parameters
    ----------
    title, description, icon : str
    colors : str
        The color attribute that shows it.
    missing : str
        What to do where it cannot be shown.
    values : str or None
        The attribute that a map is made of; None where the colors are there themselves.
    dtype : type
        Of the values.
    gradient : str or None
        The map's; None for regions.
    limits : (low, high) of float, or None
        The ends of the gradient; None: robust ones of the values.
    unit : str
    region : str
        What a region is called in the legend, by its ``number`` from 1.
    unknown : str
        What gray means.
    result : bool
        Whether renders and exports take these colors, too, when they are looked at.
    """

    title: str
    description: str
    icon: str
    colors: str
    missing: str
    values: str | None = None
    dtype: type = np.float32
    gradient: str | None = None
    limits: tuple[float, float] | None = None
    unit: str = ""
    region: str = ""
    unknown: str = n_("Not known")
    result: bool = False


LOOKS = {
    "gray": DisplayMode(
        title="Reflectance",
        description="The gray of the reflectance, as the scanner measured it; renders and exports take it, too",
        icon="IMAGE_ZDEPTH",
        colors=GRAY,
        missing=n_("Import it again"),
        result=True,
    ),
    "colorized": DisplayMode(
        title="Colorized",
        description="The colors that were spread from the seeds; renders and exports take them, too",
        icon="COLOR",
        colors=COLORIZED,
        missing=n_("Colorize first"),
        result=True,
    ),
    "scanned": DisplayMode(
        title="Scanned Color",
        description="The colors that came with the scan",
        icon="CAMERA_DATA",
        colors=SCANNED,
        missing=n_("None in the scan"),
    ),
    "confidence": DisplayMode(
        title="Confidence",
        description="How far to trust each color: 1 at the seeds, falling with the distance from them",
        icon="CHECKMARK",
        colors="Confidence_Map",
        missing=n_("Colorize first"),
        values=CONFIDENCE,
        gradient="viridis",
        limits=(0.0, 1.0),
    ),
    "nearest_seed": DisplayMode(
        title="Nearest Seed",
        description="The regions that are nearest to each seed, in a color of their own that is not the seed's",
        icon="STICKY_UVS_LOC",
        colors="Nearest_Seed_Map",
        missing=n_("Colorize first"),
        values=NEAREST_SEED,
        dtype=np.int32,
        region=n_("Seed {number}"),
        unknown=n_("No seed reaches"),
    ),
    "observed": DisplayMode(
        title="Observed",
        description="Where a color is one that a verified photo saw there, 1, and where it is inferred from others, 0",
        icon="HIDE_OFF",
        colors="Observed_Map",
        missing=n_("Colorize first"),
        values=OBSERVED,
        gradient="viridis",
        limits=(0.0, 1.0),
    ),
    "photo": DisplayMode(
        title="Photo",
        description="Which photo saw each color, in a color of its own that is not the photo's; gray where none did",
        icon="IMAGE_DATA",
        colors="Photo_Map",
        missing=n_("Colorize first"),
        values=PHOTO,
        dtype=np.int32,
        region=n_("Photo {number}"),
        unknown=n_("Inferred"),
    ),
    "range": DisplayMode(
        title="Range",
        description="The distance from the scanner",
        icon="DRIVER_DISTANCE",
        colors="Range_Map",
        missing=n_("Import it again"),
        values="range",
        gradient="turbo",
        unit="m",
    ),
    "error": DisplayMode(
        title="Error",
        description="The difference from the true colors, where they are known, in CIEDE2000",
        icon="DRIVER_ROTATIONAL_DIFFERENCE",
        colors="Error_Map",
        missing=n_("Evaluate first"),
        values=ERROR,
        gradient="inferno",
        unit="CIEDE2000",
    ),
}
_BY_COLORS = {look.colors: identifier for identifier, look in LOOKS.items()}


def shown_look(obj):
    """Return the identifier of what the viewport shows of a scan's object, or None where it is something else."""
    return _BY_COLORS.get(obj.data.color_attributes.active_color_name)


def why_not(obj, identifier):
    """Return what to do before an object can be looked at that way; None where it can."""
    look = LOOKS[identifier]
    if look.values is None:
        return None if look.colors in obj.data.color_attributes else look.missing
    return None if look.values in obj.data.attributes else look.missing


def show_look(obj, identifier):
    """Let the viewports show an object that way.

    Raises
    ------
    ScanError
        If what it is made of is missing.
    """
    if reason := why_not(obj, identifier):
        raise ScanError(f"{obj.name}: {report_text(reason)}")
    look = LOOKS[identifier]
    if look.values is not None:
        _paint(obj, look)
    (show_colors if look.result else look_at)(obj, look.colors)
    _remove_maps(obj, spared=look)


def refresh_look(obj):
    """Make the map that is shown, if one is, of the values as they are now."""
    identifier = shown_look(obj)
    if identifier is None or LOOKS[identifier].values is None:
        return
    if why_not(obj, identifier) is None:
        _paint(obj, LOOKS[identifier])


def _paint(obj, look):
    values = values_of(obj, look.values, look.dtype)
    if look.gradient is None:
        limits, paint = (0.0, float(values.max(initial=-1) + 1)), region_colors
        unknown = values < 0
    else:
        if look.values == ERROR:
            values[values < 0] = np.nan
        unknown = np.isnan(values)
        limits = look.limits or limits_of(values)
        paint = partial(painted, name=look.gradient, limits=limits)
    add_colors(obj, look.colors, paint(values))
    obj.data[LEGEND] = [*limits, float(unknown.any())]


def _remove_maps(obj, spared):
    attributes = obj.data.color_attributes
    for look in LOOKS.values():
        if look.values is not None and look is not spared and look.colors in attributes:
            attributes.remove(attributes[look.colors])
    if spared.values is None and LEGEND in obj.data:
        del obj.data[LEGEND]
