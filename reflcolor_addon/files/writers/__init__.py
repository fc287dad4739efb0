"""Scans into files: PTX, structured E57, image pairs; colored scans into meshes."""

from .e57 import write_e57
from .glb import write_glb
from .image_pair import write_image_pair
from .ply import write_ply
from .ptx import write_ptx

__all__ = ["MESH_WRITERS", "write_e57", "write_glb", "write_image_pair", "write_ply", "write_ptx"]

MESH_WRITERS = {".ply": write_ply, ".glb": write_glb}
"""What writes surfaces, by the suffix of the file."""
