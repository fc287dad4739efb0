"""Scans into files: PTX, structured E57, image pairs."""

from .e57 import write_e57
from .image_pair import write_image_pair
from .ptx import write_ptx

__all__ = ["write_e57", "write_image_pair", "write_ptx"]
