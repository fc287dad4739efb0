"""How pictures of scans look."""

from dataclasses import dataclass

ARCHIVE, LIT = "archive", "lit"
LOOKS = {
    ARCHIVE: "Colors exactly as they are, without any light",
    LIT: "In even light, which shows the shape of surfaces",
}
BACKGROUND = (0.045, 0.047, 0.05)
"""Linear light: darker than white walls, lighter than dark floors."""
LIGHT_FROM = (-0.4, 0.5, 1.0)
"""The direction that the light comes from, as the camera sees it: from the left, above and behind."""


@dataclass(frozen=True, kw_only=True)
class Picture:
    """How scans are shown in a picture.

    Parameters
    ----------
    look : {"archive", "lit"}
        Colors exactly as they are, or in even light.
    filled : bool
        Fill small holes and smooth outlines; else show the measured surface alone.
    drop_mixed : bool
        Where it is filled, leave out returns of a beam that met two surfaces.
    """

    look: str = ARCHIVE
    filled: bool = True
    drop_mixed: bool = True
