"""Scans with known geometry, and PTX texts of them, for tests of what reads and shows scans."""

import numpy as np


def room_points(height=9, width=14, *, step_deg=(4.0, 6.0), top_deg=16.0, left_deg=40.0):
    """What a scanner in the middle of a round room, 5 to 6 m wide, measures: upright, not mirrored.

    Returns
    -------
    (height, width, 3) float64
        Row 0 is the top; azimuth (counterclockwise from +X) starts at `left_deg` and falls from column to column.
    """
    row, column = np.mgrid[:height, :width]
    elevation = np.radians(top_deg - step_deg[0] * row)
    azimuth = np.radians(left_deg - step_deg[1] * column)
    distance = 5.5 + 0.5 * np.sin(3 * azimuth) * np.cos(elevation)
    level = distance * np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)


def intensity_of(points):
    """(H, W) values that differ from pixel to pixel, each with an exact short decimal."""
    return np.arange(points.shape[0] * points.shape[1]).reshape(points.shape[:2]) / 64


def ptx_text(points, intensity, color=None, *, position=(0, 0, 0), axes=None, matrix=None, end="\n", between=" "):
    """A PTX scan of upright grids as scanners write it: column by column, each from the bottom to the top.

    Parameters
    ----------
    points, intensity, color : (H, W, 3), (H, W), (H, W, 3) arrays
    position, axes, matrix : array-like, optional
        As they stand in the header; the matrix in row-vector convention.
    end, between : str
        What ends lines, and what separates numbers.
    """
    height, width = intensity.shape
    axes, matrix = np.eye(3) if axes is None else axes, np.eye(4) if matrix is None else matrix
    lines = [[width], [height], position, *axes, *matrix]
    for column in range(width):
        for row in reversed(range(height)):
            numbers = [*points[row, column], intensity[row, column]]
            lines.append(numbers if color is None else [*numbers, *color[row, column]])
    return "".join(between.join(f"{float(number):.17g}" for number in line) + end for line in lines)
