"""How pictures of scans look."""

from dataclasses import dataclass

ARCHIVE, LIT = "archive", "lit"
LOOKS = {
    ARCHIVE: "Colors exactly as they are, without any light",
    LIT: "In even light, which shows the shape of surfaces",
}


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
