"""Where a seed's color comes from: the one list for seeds' files, the window, the command line and reports."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Source:
    """One way in which a seed can get its color.

    Parameters
    ----------
    name : str
        The seed's ``reason`` in files and arrays.
    label, help : str
        Its name and tooltip in the window.
    said : str
        What the command line says of such seeds.
    counted : str
        What the window says of such seeds, with a place for their ``count``.
    color : (r, g, b)
        Of its lines in a picture of matches, 0..255.
    found : bool
        Whether the program found the color, not a person.
    guessed : bool
        Whether nobody saw the color there: it is from likeness alone.
    """

    name: str
    label: str
    help: str
    said: str
    counted: str
    color: tuple[int, int, int]
    found: bool = True
    guessed: bool = False


HAND, SCAN = "hand", "scan"
# A .blend keeps the number of a source: new ones go to the end.
SOURCES = {
    source.name: source
    for source in (
        Source(
            HAND,
            "Hand",
            "Picked by a person",
            "color given by hand",
            "{count} seeds with a color given by hand",
            (240, 70, 200),
            found=False,
        ),
        Source(
            "pose",
            "Camera",
            "Where a photo's verified camera saw the pixel",
            "found by a photo's camera",
            "{count} seeds found by a photo's camera",
            (60, 200, 90),
        ),
        Source(
            "homography",
            "Homography",
            "Where a verified photo shows the pixel",
            "found by a photo's homography",
            "{count} seeds found by a photo's homography",
            (60, 160, 240),
        ),
        Source(
            "appearance",
            "Appearance",
            "By likeness with what a photo shows",
            "found by likeness",
            "{count} seeds found by likeness",
            (240, 180, 40),
            guessed=True,
        ),
        Source(
            SCAN,
            "Scan",
            "Measured by the scanner itself",
            "from the scan's own colors",
            "{count} seeds in the scan's own colors",
            (40, 200, 210),
        ),
    )
}
FOUND = frozenset(name for name, source in SOURCES.items() if source.found)
"""Sources of the program's own."""
GUESSED = frozenset(name for name, source in SOURCES.items() if source.guessed)
"""Sources that are no evidence."""
IN_PHOTO = "photo"
"""What a report calls seeds that a person picked in a photo."""
PICKED_IN_PHOTO = Source(
    IN_PHOTO,
    "Photo",
    "Picked in a photo by a person",
    "picked in a photo",
    "{count} seeds picked in a photo",
    SOURCES[HAND].color,
    found=False,
)
EVIDENCE = {IN_PHOTO: PICKED_IN_PHOTO, **SOURCES}
"""The sources that a report tells apart, in its order."""
