"""A virtual photographer's camera: where a point falls in its picture, and how the picture is exposed."""

from dataclasses import dataclass, field, replace

import numpy as np

from ..srgb import linear_to_srgb8

# Share of the noise variance of a white pixel that comes from reading out; the rest are photons, fewer in the shadows.
_READ_NOISE_SHARE = 0.25
_UNDISTORT_STEPS = 12


@dataclass(frozen=True, eq=False, kw_only=True)
class VirtualCamera:
    """A pinhole camera with radial distortion, exposure, white balance and noise of its own.

    Parameters
    ----------
    width, height : int
        Pixels.
    focal_px : float
        Focal length in pixels.
    pose : (4, 4) float64
        Camera frame (x right, y down, z forward) to world, column-vector convention.
    distortion : (k1, k2) of float
        A point at radius r (in focal lengths from the middle) is seen at r (1 + k1 r^2 + k2 r^4).
    exposure_stops : float
        0 leaves the light as it is; 1 doubles it.
    white_balance : (red, green, blue) of float
        Gains.
    noise : float
        Standard deviation in a pixel that is just white, as a share of white.
    seed : int
        Of the noise.
    """

    width: int
    height: int
    focal_px: float
    pose: np.ndarray = field(default_factory=lambda: np.eye(4))
    distortion: tuple[float, float] = (0.0, 0.0)
    exposure_stops: float = 0.0
    white_balance: tuple[float, float, float] = (1.0, 1.0, 1.0)
    noise: float = 0.0
    seed: int = 0

    def project(self, points_world):
        """Project points into the picture.

        Parameters
        ----------
        points_world : (..., 3) float64

        Returns
        -------
        xy : (..., 2) float64
            Pixels from the top left corner (the first pixel's center is at 0.5, 0.5); NaN behind the camera.
        depth : (...) float64
            Meters along the viewing axis.
        """
        camera = (np.asarray(points_world, np.float64) - self.pose[:3, 3]) @ self.pose[:3, :3]
        depth = camera[..., 2]
        plane = camera[..., :2] / np.where(depth > 0, depth, np.nan)[..., None]
        return self._distorted(plane) * self.focal_px + self._center(), depth

    def undistorted_pixels(self):
        """Return the (height, width, 2) pixels at which a camera without distortion sees what this one's pixels see."""
        y, x = np.mgrid[: self.height, : self.width] + 0.5
        seen = (np.stack([x, y], axis=-1) - self._center()) / self.focal_px
        plane = seen
        for _ in range(_UNDISTORT_STEPS):
            plane = seen / self._gain(plane)
        return plane * self.focal_px + self._center()

    def margin_px(self):
        """How many pixels a picture without distortion needs beyond each edge to hold all that this camera sees."""
        outside = self.undistorted_pixels()
        beyond = np.maximum(-outside, outside - [self.width, self.height])
        return int(np.ceil(max(beyond.max(), 0))) + 2

    def distort(self, image, margin, *, blend=True):
        """Resample a picture without distortion, drawn ``margin`` pixels larger on every side.

        Parameters
        ----------
        image : (height + 2 margin, width + 2 margin, ...) float
        margin : int
        blend : bool
            Blend the four pixels around bilinearly, as light wants it; else take the nearest one, as depth does.

        Returns
        -------
        (height, width, ...) float
        """
        xy = self.undistorted_pixels() + margin - (0.5 if blend else 0.0)
        corner = np.floor(xy).astype(int)
        if not blend:
            return image[corner[..., 1], corner[..., 0]]
        right, down = np.moveaxis((xy - corner)[..., None], 2, 0)
        x = np.clip(corner[..., 0], 0, image.shape[1] - 2)
        y = np.clip(corner[..., 1], 0, image.shape[0] - 2)
        top = image[y, x] * (1 - right) + image[y, x + 1] * right
        bottom = image[y + 1, x] * (1 - right) + image[y + 1, x + 1] * right
        return top * (1 - down) + bottom * down

    def develop(self, light):
        """Turn light into a photo: exposure, white balance, noise, clipping and sRGB.

        Parameters
        ----------
        light : (H, W, 3) float
            Linear, 1 is white at exposure 0.

        Returns
        -------
        (H, W, 3) uint8
            sRGB.
        """
        exposed = np.asarray(light, np.float64) * 2.0**self.exposure_stops * self.white_balance
        if self.noise > 0:
            grain = np.random.RandomState(self.seed).standard_normal(exposed.shape)
            photons = np.clip(exposed, 0, 1) * (1 - _READ_NOISE_SHARE) + _READ_NOISE_SHARE
            exposed = exposed + self.noise * grain * np.sqrt(photons)
        return linear_to_srgb8(exposed)

    def as_dict(self):
        """Return what it takes to project a point: JSON-ready, angles and lengths as in the parameters."""
        return {
            "width": self.width,
            "height": self.height,
            "focal_px": self.focal_px,
            "distortion": list(self.distortion),
            "pose": np.asarray(self.pose).tolist(),
        }

    @classmethod
    def from_dict(cls, values):
        """Return the camera that `as_dict` described."""
        return cls(**values | {"pose": np.array(values["pose"]), "distortion": tuple(values["distortion"])})

    def _center(self):
        return np.array([self.width / 2, self.height / 2])

    def _gain(self, plane):
        k1, k2 = self.distortion
        squared = (plane**2).sum(axis=-1, keepdims=True)
        return 1 + squared * (k1 + squared * k2)

    def _distorted(self, plane):
        return plane * self._gain(plane)


@dataclass(frozen=True, eq=False)
class Photo:
    """A photo that a `VirtualCamera` took, and how deep the scene is in it.

    Parameters
    ----------
    camera : VirtualCamera
    image : (H, W, 3) uint8
        sRGB.
    depth : (H, W) float
        Meters along the viewing axis; infinite where there is nothing.
    """

    camera: VirtualCamera
    image: np.ndarray
    depth: np.ndarray

    def shows(self, points_world, *, tolerance_m=0.02):
        """Return where in the photo points are, (..., 2) pixels as `VirtualCamera.project` counts them.

        NaN where a point is outside the picture, or more than the tolerance behind or before what is seen there.
        """
        xy, depth = self.camera.project(points_world)
        with np.errstate(invalid="ignore"):
            inside = ((xy >= 0) & (xy < [self.camera.width, self.camera.height])).all(axis=-1)
        x, y = np.moveaxis(np.where(inside[..., None], xy, 0).astype(int), -1, 0)
        seen = inside & (np.abs(self.depth[y, x] - depth) < tolerance_m)
        return np.where(seen[..., None], xy, np.nan)


def with_own_look(camera, seed):
    """Return the camera with an exposure, white balance, lens distortion and noise of its own, as the seed has it."""
    chance = np.random.RandomState(seed)
    return replace(
        camera,
        distortion=(float(chance.uniform(-0.10, 0.04)), float(chance.uniform(0.0, 0.02))),
        exposure_stops=float(chance.uniform(-0.35, 0.25)),
        white_balance=(float(chance.uniform(0.94, 1.10)), 1.0, float(chance.uniform(0.86, 1.06))),
        noise=0.012,
        seed=seed,
    )


def look_at(position, target):
    """Return the (4, 4) float64 pose of a camera (x right, y down, z forward) that looks at a point, upright (Z up)."""
    position = np.asarray(position, np.float64)
    forward = np.asarray(target, np.float64) - position
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3] = np.column_stack([right, np.cross(forward, right), forward, position])
    return pose
