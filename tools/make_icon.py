"""Makes the icon of the seed tools: python tools/make_icon.py

Blender's tool icons are triangles: a head of 8 bytes, then x and y of every corner, then its color, a byte each.
"""

import math
import struct
from pathlib import Path

TARGET = Path(__file__).resolve().parent.parent / "operators" / "window" / "seeds_icon.dat"
GRAY = (229, 229, 229, 255)


def disk(x, y, radius, color, corners=14):
    """Triangles of a disk."""
    rim = [
        (x + radius * math.cos(math.tau * k / corners), y + radius * math.sin(math.tau * k / corners))
        for k in range(corners)
    ]
    return [((x, y), rim[k], rim[(k + 1) % corners], color) for k in range(corners)]


def bar(start, end, width, color):
    """Two triangles of a straight line."""
    dx, dy = (b - a for a, b in zip(start, end, strict=True))
    length = math.hypot(dx, dy)
    nx, ny = -dy / length * width / 2, dx / length * width / 2
    a, b = (start[0] + nx, start[1] + ny), (start[0] - nx, start[1] - ny)
    c, d = (end[0] - nx, end[1] - ny), (end[0] + nx, end[1] + ny)
    return [(a, b, c, color), (a, c, d, color)]


def main():
    """Write the icon."""
    seeds = (
        ((66, 176), 30, (226, 96, 70, 255)),
        ((186, 150), 26, (70, 150, 230, 255)),
        ((108, 66), 30, (96, 190, 96, 255)),
    )
    places = [place for place, _, _ in seeds]
    triangles = [part for k in range(3) for part in bar(places[k], places[(k + 1) % 3], 9, GRAY)]
    for (x, y), radius, color in seeds:
        triangles += disk(x, y, radius + 10, GRAY) + disk(x, y, radius, color)
    corners = b"".join(
        struct.pack("6B", *(round(value) for point in triangle[:3] for value in point)) for triangle in triangles
    )
    colors = b"".join(struct.pack("12B", *triangle[3] * 3) for triangle in triangles)
    TARGET.write_bytes(b"VCO\0" + bytes([255, 255, 0, 0]) + corners + colors)


if __name__ == "__main__":
    main()
