"""Plausible limits of a scan. A file that claims more is damaged, or made to break its readers."""

FARTHEST_M = 1e9
"""Greatest coordinate, in meters: every coordinate system of a planet stays far below."""

NEAREST_M = 1e-6
"""Least distance of a return from the scanner."""

STRONGEST = 1e30
"""Greatest reflectance; differences of such numbers, and their squares in double precision, do not overflow."""

MOST_PIXELS = 500_000_000
"""Most pixels of a scan: pixels and corners of faces are numbered in 32 bits."""

SCALES = (1e-6, 1e6)
"""Scales that a pose may have; few files have any but 1."""

LONGEST_NAME = 200
"""Characters of a scan's name."""
