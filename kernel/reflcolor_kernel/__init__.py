"""The shared library of the geodesic kernel; reflcolor_addon/geodesic/kernel.py calls it through ctypes."""

from pathlib import Path

__version__ = "@VERSION@"


def library_path():
    """Path of the shared library."""
    return Path(__file__).parent / "@LIBRARY@"
