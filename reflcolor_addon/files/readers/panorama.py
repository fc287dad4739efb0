"""A spherical image as pictures of 90 degrees, which ordinary cameras could have taken."""

import numpy as np

_SIDES = ("front", "left", "back", "right", "up", "down")
_SEEN = 0.5
"""Share of a picture that the image must cover."""

_LONGEST_SIDE = 2048


def faces(rgb, step_across, step_down):
    """Return the pictures that a spherical image covers: the sides of a cube around the camera.

    Parameters
    ----------
    rgb : (H, W, 3) uint8
        Its middle looks along +X; azimuth grows to the left, elevation up (ASTM E2807).
    step_across, step_down : float
        Angles of a pixel, radians.

    Returns
    -------
    list of (str, (N, N, 3) uint8, (3, 3) float64)
        Name of the side, the picture (black where the image has nothing), and its axes in the camera's frame: to the
        right, down, ahead.
    """
    import cv2

    height, width = rgb.shape[:2]
    side = int(np.clip(round((np.pi / 2) / step_across), 64, _LONGEST_SIDE))
    plane = (np.arange(side) + 0.5) * (2 / side) - 1
    right, down = np.meshgrid(plane, plane)
    whole_turn = abs(width * step_across - 2 * np.pi) < 1.5 * step_across
    found = []
    for name, axes in zip(_SIDES, _axes(), strict=True):
        ray = right[..., None] * axes[0] + down[..., None] * axes[1] + axes[2]
        azimuth = np.arctan2(ray[..., 1], ray[..., 0])
        elevation = np.arctan2(ray[..., 2], np.hypot(ray[..., 0], ray[..., 1]))
        x, y = width / 2 - azimuth / step_across - 0.5, height / 2 - elevation / step_down - 0.5
        inside = (y > -0.5) & (y < height - 0.5)
        if not whole_turn:
            inside &= (x > -0.5) & (x < width - 0.5)
        if inside.mean() < _SEEN:
            continue
        # At the left and right edges a full turn continues at the other edge; elsewhere the image ends.
        x = x % width if whole_turn else x
        padded = cv2.copyMakeBorder(rgb, 0, 0, 1, 1, cv2.BORDER_WRAP if whole_turn else cv2.BORDER_REPLICATE)
        maps = (x + 1).astype(np.float32), y.astype(np.float32)
        picture = cv2.remap(padded, *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        picture[~inside] = 0
        found.append((name, picture, axes))
    return found


def _axes():
    """(3, 3) axes of each side: to the right, down, ahead."""
    z = np.array([0.0, 0.0, 1.0])
    around = [np.array([np.cos(turn), np.sin(turn), 0.0]).round(12) for turn in np.radians([0, 90, 180, 270])]
    level = [np.stack([np.cross(ahead, z), -z, ahead]) for ahead in around]
    right = np.array([0.0, -1.0, 0.0])
    return [*level, np.stack([right, around[0], z]), np.stack([right, -around[0], -z])]
