"""Images of a scan's grid, reduced for what changes slowly over it or is decided for whole regions."""

import numpy as np

_LONGEST = 800


class Reduced:
    """The grid of a scan brought to at most 800 pixels a side.

    Parameters
    ----------
    scan : Scan

    Attributes
    ----------
    shape : (h, w)
    rows, cols : (h,) and (w,) int
        The pixel of the grid in the middle of each reduced one.
    """

    def __init__(self, scan):
        height, width = scan.shape
        factor = max(1.0, max(height, width) / _LONGEST)
        self.shape = max(1, round(height / factor)), max(1, round(width / factor))
        self.grid_shape, self._wrap = scan.shape, scan.full_turn
        self.rows, self.cols = (
            np.minimum(((np.arange(count) + 0.5) * whole / count).astype(int), whole - 1)
            for count, whole in zip(self.shape, scan.shape, strict=True)
        )

    def share(self, mask):
        """Return (h, w) float32: which share of each reduced pixel is in an (H, W) mask."""
        return self._averaged(mask.astype(np.float32))

    def mean(self, values, mask, share):
        """Return the (h, w, C) float32 means of (H, W, C) values over a mask, whose `share` is given; 0 where none."""
        sums = self._averaged(np.where(mask[..., None], values, 0).astype(np.float32))
        return np.divide(sums, share[..., None], out=np.zeros_like(sums), where=share[..., None] > 0)

    def lab(self, rgb, mask, share):
        """Return the (h, w, 3) float32 CIELAB of the mean of (H, W, 3) uint8 sRGB over a mask."""
        from skimage.color import rgb2lab

        return rgb2lab(self.mean(rgb, mask, share) / np.float32(255)).astype(np.float32)

    def blurred(self, image, sigma):
        """Return an (h, w) or (h, w, C) float32 image blurred by a Gaussian; beyond the grid it is zero."""
        import cv2

        margin = min(int(np.ceil(3 * sigma)), self.shape[1])
        sides = ((margin, margin), (margin, margin), *((0, 0),) * (image.ndim - 2))
        padded = np.pad(image, ((0, 0), *sides[1:]), mode="wrap" if self._wrap else "constant")
        padded = np.pad(padded, (sides[0], (0, 0), *sides[2:]))
        blurred = cv2.GaussianBlur(padded, (0, 0), sigma, borderType=cv2.BORDER_CONSTANT)
        return blurred[margin:-margin, margin:-margin]

    def whole(self, image):
        """Return an (h, w) or (h, w, C) float32 image at the grid's size, interpolated."""
        import cv2

        return cv2.resize(image, self.grid_shape[::-1], interpolation=cv2.INTER_LINEAR)

    def whole_nearest(self, image):
        """Return an (h, w) or (h, w, C) image at the grid's size, each pixel as the reduced one that it lies in."""
        height, width = self.grid_shape
        rows, cols = (
            np.arange(whole) * count // whole for whole, count in zip((height, width), self.shape, strict=True)
        )
        return image[rows[:, None], cols]

    def _averaged(self, image):
        import cv2

        return cv2.resize(image, self.shape[::-1], interpolation=cv2.INTER_AREA)
