"""Directions of a grid of angles."""

import numpy as np


def directions(azimuths_deg, elevations_deg):
    """Return the (H, W, 3) float64 unit vectors of a grid of (W,) azimuths and (H,) elevations in degrees."""
    elevation, azimuth = np.meshgrid(np.radians(elevations_deg), np.radians(azimuths_deg), indexing="ij")
    horizontal = np.cos(elevation)
    return np.stack([horizontal * np.sin(azimuth), horizontal * np.cos(azimuth), np.sin(elevation)], axis=-1)
