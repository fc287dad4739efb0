"""A virtual terrestrial laser scanner: what it would measure where its rays hit.

The geometry comes from a ``cast`` function (closed forms in tests, a renderer in Blender); here is the grid of ray
directions and the sensor: signal strength, noise, lost returns, mixed pixels and quantization.

The scanner's frame has Z up and looks along +Y; azimuth grows to the right, elevation upward:
``x = r cos(el) sin(az), y = r cos(el) cos(az), z = r sin(el)``.
"""

import math
from dataclasses import dataclass, fields, replace
from numbers import Integral

import numpy as np

from ..errors import Cancelled, SettingsError
from ..messages import Message
from ..scan.directions import directions
from ..scan.scan import Scan
from ..srgb import linear_to_srgb8, srgb8_to_linear

# Where in the beam its energy is sampled, in beam widths from the center (right, up), and the share of the energy.
_BEAM = ((0.0, 0.0, 0.4), (-0.35, -0.35, 0.15), (0.35, -0.35, 0.15), (-0.35, 0.35, 0.15), (0.35, 0.35, 0.15))
# Very close to the scanner the 1/r of the signal law would grow without bound.
_LEAST_RANGE_M = 0.1
_MOST_NOISE_GROWTH = 4.0
_MAX_PIXELS = 2**26
# Linear light of every sRGB value.
_LINEAR = srgb8_to_linear(np.arange(256, dtype=np.uint8))


@dataclass(frozen=True, kw_only=True)
class ScannerModel:
    """What the scanner looks at, and how well.

    Parameters
    ----------
    rows, columns : int
        Size of the grid.
    azimuth_deg : (left, right) of float
        Outer edges of the image, at most 360 degrees apart; a full turn is ``(-180, 180)``. Pixel centers lie half a
        step inside.
    elevation_deg : (bottom, top) of float
        Outer edges of the image, within -90..90. Steps need not be square.
    range_limits_m : (least, greatest) of float
        Nothing is measured outside.
    range_noise_m : float
        Standard deviation at a signal of 1; it grows as 1/sqrt(signal), up to four times.
    range_step_m : float
        Ranges are multiples of this; 0 leaves them as they are.
    beam_deg : float
        Width of the beam. Rays across it meet different surfaces at a jump edge; 0 is a line without width.
    echo_length_m : float
        Surfaces in one beam whose ranges differ by less than this melt into one return between them (a mixed pixel);
        of surfaces farther apart the strongest is measured.
    reference_range_m : float
        Range at which a surface seen head-on has a signal equal to its near-infrared albedo.
    range_falloff, incidence_falloff : float
        Exponents: signal = albedo * cos(incidence) ** incidence_falloff * (reference / range) ** range_falloff.
        Physics says 1 and 2; scanners compensate part of the range.
    reflectance_noise : float
        Standard deviation of the signal, relative to it (speckle).
    reflectance_gain : float
        What a signal of 1 reads; readings end at 1.
    reflectance_bits : int
        Bits of a reading, 1 to 16.
    detection_limit : float
        A weaker signal gives no return.
    dropout_rate : float
        Share of pixels that give no return for no reason.
    seed : int
        Of the noise: the same seed gives the same scan.

    Raises
    ------
    SettingsError
        If a value is out of its range.
    """

    rows: int = 300
    columns: int = 450
    azimuth_deg: tuple[float, float] = (-45.0, 45.0)
    elevation_deg: tuple[float, float] = (-30.0, 30.0)
    range_limits_m: tuple[float, float] = (0.3, 80.0)
    range_noise_m: float = 0.001
    range_step_m: float = 0.0001
    beam_deg: float = 0.1
    echo_length_m: float = 0.4
    reference_range_m: float = 3.0
    range_falloff: float = 1.0
    incidence_falloff: float = 1.0
    reflectance_noise: float = 0.03
    reflectance_gain: float = 0.8
    reflectance_bits: int = 16
    detection_limit: float = 0.01
    dropout_rate: float = 0.001
    seed: int = 0

    def __post_init__(self):
        for name in ("rows", "columns", "reflectance_bits", "seed"):
            value = getattr(self, name)
            if not isinstance(value, Integral) or isinstance(value, bool):
                raise SettingsError("{name}: expected a whole number, found {value!r}", name=name, value=value)
        for field in fields(self):
            if not np.isfinite(np.asarray(getattr(self, field.name), np.float64)).all():
                raise SettingsError(
                    "{field}: expected a finite number, found {value!r}",
                    field=field.name,
                    value=getattr(self, field.name),
                )
        left, right = self.azimuth_deg
        bottom, top = self.elevation_deg
        near, far = self.range_limits_m
        rules = (
            (self.rows >= 1 and self.columns >= 1, "rows and columns", Message("1 or more each")),
            (
                self.rows * self.columns <= _MAX_PIXELS,
                "rows x columns",
                Message("at most {most:,} pixels", most=_MAX_PIXELS),
            ),
            (left < right <= left + 360, "azimuth_deg", Message("left before right, at most 360 degrees apart")),
            (-90 <= bottom < top <= 90, "elevation_deg", Message("bottom below top, within -90 to 90 degrees")),
            (0 <= near < far, "range_limits_m", Message("least below greatest, neither negative")),
            (self.reference_range_m > 0, "reference_range_m", Message("more than 0")),
            (self.reflectance_gain > 0, "reflectance_gain", Message("more than 0")),
            (1 <= self.reflectance_bits <= 16, "reflectance_bits", Message("1 to 16")),
            (0 <= self.dropout_rate <= 1, "dropout_rate", Message("0 to 1")),
            (0 <= self.seed < 2**32, "seed", Message("0 to {most}", most=2**32 - 1)),
        )
        for holds, name, expected in rules:
            if not holds:
                raise SettingsError("{name}: expected {expected}", name=name, expected=expected)
        for name in (
            "range_noise_m",
            "range_step_m",
            "beam_deg",
            "echo_length_m",
            "range_falloff",
            "incidence_falloff",
            "reflectance_noise",
            "detection_limit",
        ):
            if getattr(self, name) < 0:
                raise SettingsError("{name}: expected 0 or more, found {value!r}", name=name, value=getattr(self, name))

    @property
    def step_deg(self):
        """(vertical, horizontal) angle between neighboring pixels, degrees."""
        (left, right), (bottom, top) = self.azimuth_deg, self.elevation_deg
        return (top - bottom) / self.rows, (right - left) / self.columns

    def azimuths_deg(self):
        """(columns,) float64: azimuth of each column's center, left to right."""
        left, right = self.azimuth_deg
        return left + (np.arange(self.columns) + 0.5) * (right - left) / self.columns

    def elevations_deg(self):
        """(rows,) float64: elevation of each row's center, top to bottom."""
        bottom, top = self.elevation_deg
        return top - (np.arange(self.rows) + 0.5) * (top - bottom) / self.rows

    def ideal(self):
        """Return the same view by a scanner without noise, losses, beam width or quantization."""
        return replace(
            self,
            range_noise_m=0.0,
            range_step_m=0.0,
            beam_deg=0.0,
            reflectance_noise=0.0,
            detection_limit=0.0,
            dropout_rate=0.0,
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Hits:
    """What each ray of a grid meets first.

    Parameters
    ----------
    range : (H, W) float
        Meters; infinite where the ray meets nothing.
    cos_incidence : (H, W) float
        Cosine of the angle between the ray and the surface's normal; its sign does not matter.
    albedo : (H, W) float
        In the near infrared; above 1 for retroreflectors.
    color : (H, W, 3) uint8
        True sRGB of the surface.
    """

    range: np.ndarray
    cos_incidence: np.ndarray
    albedo: np.ndarray
    color: np.ndarray


def ray_grids(model):
    """Return the grids of rays that a scan needs: one ((W,) azimuths, (H,) elevations) in degrees per ray of the beam.

    Each is the whole grid, shifted by a part of the beam; an elevation beyond 90 degrees goes over the pole.
    """
    azimuths, elevations = model.azimuths_deg(), model.elevations_deg()
    return [(azimuths + right * model.beam_deg, elevations + up * model.beam_deg) for right, up, _ in _beam(model)]


def measure(hits, model, *, name="scan", pose=None):
    """Return what the scanner reports where its rays hit.

    Parameters
    ----------
    hits : sequence of Hits
        One for each of ``ray_grids(model)``.
    model : ScannerModel
    name : str
    pose : (4, 4) float, optional
        Scanner to world; goes into the scan as it is.

    Returns
    -------
    scan : Scan
        Reflectance reads 0..1; no color.
    truth : (H, W, 3) uint8
        True sRGB of the surfaces that the return came from, averaged as light over the beam; 0 where there is none.
    """
    shares = np.array([share for _, _, share in _beam(model)])
    ranges = np.array([np.asarray(ray.range, np.float64) for ray in hits])
    signals = np.array([share * _signal(ray, model) for share, ray in zip(shares, hits, strict=True)])
    together = _echo(ranges, signals, model)
    distance, reflectance, valid = _readings(*_return(ranges, signals, together), model)
    points = directions(model.azimuths_deg(), model.elevations_deg()) * distance[..., None]
    pose = np.eye(4) if pose is None else np.asarray(pose, np.float64)
    scan = Scan(name=name, points=points, reflectance=reflectance, valid=valid, pose=pose)
    return scan, _mean_color([ray.color for ray in hits], together * shares[:, None, None], valid)


def simulate_scan(cast, model, *, name="scan", pose=None, progress=None, cancelled=None):
    """Scan what ``cast`` describes.

    Parameters
    ----------
    cast : callable
        ``cast(azimuths_deg, elevations_deg) -> Hits`` for a grid of (W,) azimuths and (H,) elevations in the scanner's
        frame; called once for each of ``ray_grids(model)``.
    model, name, pose
        As in `measure`.
    progress : callable, optional
        ``progress(fraction, text)``.
    cancelled : callable, optional
        ``cancelled() -> bool``, asked between casts.

    Returns
    -------
    scan : Scan
    truth : (H, W, 3) uint8
        As in `measure`.

    Raises
    ------
    Cancelled
        If ``cancelled()`` returned True.
    """
    grids, hits = ray_grids(model), []
    for index, grid in enumerate(grids):
        if cancelled is not None and cancelled():
            raise Cancelled
        if progress is not None:
            progress(index / len(grids), Message("Scanning {name}", name=name))
        hits.append(cast(*grid))
    result = measure(hits, model, name=name, pose=pose)
    if progress is not None:
        progress(1.0, Message("Scanned {name}", name=name))
    return result


def _beam(model):
    return _BEAM if model.beam_deg > 0 else ((0.0, 0.0, 1.0),)


def _signal(hits, model):
    """(H, W) strength of the return along one ray; 0 where it meets nothing."""
    hit = np.isfinite(hits.range)
    distance = np.maximum(np.where(hit, hits.range, 1.0), _LEAST_RANGE_M)
    falloff = (model.reference_range_m / distance) ** model.range_falloff
    lambert = np.abs(hits.cos_incidence).astype(np.float64) ** model.incidence_falloff
    return np.where(hit, np.asarray(hits.albedo, np.float64) * lambert * falloff, 0.0)


def _echo(ranges, signals, model):
    """(B, H, W) bool: which rays across the beam make the return: the strongest, and those of about its range."""
    strongest = np.argmax(signals, axis=0)[None]
    with np.errstate(invalid="ignore"):
        near = np.abs(ranges - np.take_along_axis(ranges, strongest, axis=0)) <= model.echo_length_m
    return near & (signals > 0)


def _return(ranges, signals, together):
    """(H, W) range and signal of what the rays across the beam, (B, H, W), give together."""
    weights = np.where(together, signals, 0.0)
    signal = weights.sum(axis=0)
    weighted = (weights * np.where(together, ranges, 0.0)).sum(axis=0)
    return np.divide(weighted, signal, out=np.zeros_like(signal), where=signal > 0), signal


def _mean_color(colors, weights, valid):
    """(H, W, 3) uint8: sRGB colors of B rays averaged in linear light."""
    weights = weights / np.where(valid, weights.sum(axis=0), 1.0)
    light = sum(weight[..., None] * _LINEAR[color] for weight, color in zip(weights, colors, strict=True))
    return np.where(valid[..., None], linear_to_srgb8(light), 0).astype(np.uint8)


def _readings(distance, signal, model):
    """(H, W) range in meters, reflectance in 0..1 and validity as the scanner reports them."""
    # The legacy generator is the one whose stream numpy promises never to change.
    random = np.random.RandomState(model.seed)
    range_noise, speckle = random.standard_normal((2, *signal.shape))
    lost = random.random_sample(signal.shape) < model.dropout_rate
    signal = signal * np.maximum(1 + model.reflectance_noise * speckle, 0.0)
    near, far = model.range_limits_m
    valid = (signal > 0) & (signal >= model.detection_limit) & ~lost & (distance >= near) & (distance <= far)
    growth = np.minimum(1 / np.sqrt(np.where(valid, signal, 1.0)), _MOST_NOISE_GROWTH)
    distance = distance + model.range_noise_m * growth * range_noise
    if model.range_step_m > 0:
        distance = np.round(distance / model.range_step_m) * model.range_step_m
    valid &= distance > 0
    levels = math.ldexp(1, model.reflectance_bits) - 1
    reading = np.round(np.clip(signal * model.reflectance_gain, 0, 1) * levels) / levels
    return np.where(valid, distance, 0.0), np.where(valid, reading, 0.0).astype(np.float32), valid
