"""The transfer curve of sRGB, both ways (IEC 61966-2-1)."""

import numpy as np


def linear_to_srgb8(linear):
    """Encode linear light (..., 3), 0..1, as sRGB uint8; what lies outside is clipped."""
    linear = np.clip(np.asarray(linear, np.float64), 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.round(encoded * 255).astype(np.uint8)


def srgb8_to_linear(encoded):
    """Decode sRGB uint8 (...) as linear light, float64 in 0..1."""
    encoded = np.asarray(encoded, np.float64) / 255
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
