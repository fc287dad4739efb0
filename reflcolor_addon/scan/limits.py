"""What a scan can plausibly hold. A file that claims more is damaged, or made to break what reads it."""

FARTHEST_M = 1e9
"""Greatest coordinate, in meters: every way of counting places on a planet stays far below."""

NEAREST_M = 1e-6
"""Least distance of a return from the scanner."""

STRONGEST = 1e30
"""Greatest reflectance; differences of such numbers, and their squares in double precision, are still numbers."""

MOST_PIXELS = 500_000_000
"""Pixels of a scan: their places are counted in 32 bits, the corners of their faces, too."""

SCALES = (1e-6, 1e6)
"""By how much a pose may shrink or stretch; only odd files do it at all."""

LONGEST_NAME = 200
"""Characters of a scan's name."""
