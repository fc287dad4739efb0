"""What an accepted photo shows of a scan at every pixel of its grid: which it saw, their colors, and how well."""

from dataclasses import dataclass

import numpy as np

from .occlusion import DepthBuffer

# A photo must see a surface less slantwise than this cosine, or half as squarely as the scanner saw it.
_GRAZING, _AS_SCANNER = 0.2, 0.5
_BORDER_SHARE = 0.005
_BEHIND = 0.1
# From behind and from this far above or below, sine of the angle, another part of the thing is seen than its back.
_LEVEL = 0.2
# What lies nearer or farther than this share beside a pixel in the photo is another thing; and how near to its outline
# a camera that is slightly off sees it: cells of the depth buffer, and pixels of the scan, whichever is farther.
_OTHER_THING, _OUTLINE, _OFF = 0.1, 3, 2.0
# From nearer to the scanner than this share of the median range a photo shows hardly anything behind a thing.
_ASIDE = 0.02
# The steepest surface, tangent of the angle between normal and view, whose slope is allowed for.
_STEEPEST = 5.0
# A photo is halved again and again, and colors are taken from the size whose interpolated pixels blur most nearly as a
# pixel of the scan does: a square of side s has a variance of s^2 / 12, interpolated pixels have one of 1 / 4.
_AS_BLURRED = np.float32(np.sqrt(2 / 3))
# Files hold black where they have nothing: in parts of at least this share of the photo.
_DARKEST, _LEAST_NOTHING = 6, 1e-3
# Levels of contrast that tell nothing of how sharp a photo is.
_FAINT = 0.5
_CHUNK_PIXELS, _ROW = 1 << 17, 1024


@dataclass(frozen=True, eq=False)
class View:
    """One photo on the pixels of a scan.

    usable : (H, W) bool
        Seen, not at a grazing angle.
    doubtful : (H, W) bool
        Usable, but beside an outline in the photo, where a camera that is slightly off sees another thing; or beyond
        space that the scanner did not see into.
    behind : (H, W) bool
        Usable, but the camera was behind the surface: it saw the other side of the same thing, which is most often of
        the same color. Of low quality, for where nothing better is.
    rgb : (H, W, 3) uint8
        sRGB of the photo at the detail of the scan; black where not usable.
    quality : (H, W) float32
        Cosine of the viewing angle times pixels of the photo per pixel of the scan (at most 1), times the sharpness.
    aside : bool
        Whether the photo was taken from beside the scanner's place, so that things hide other parts of the scan.
    """

    usable: np.ndarray
    doubtful: np.ndarray
    behind: np.ndarray
    rgb: np.ndarray
    quality: np.ndarray
    aside: bool

    @property
    def sure(self):
        """(H, W) bool: usable without a doubt."""
        return self.usable & ~self.doubtful


def seen_by(photo, model, surface):
    """Return the `View` of a photo with an accepted model on a `GridSurface`."""
    scan = surface.scan
    sight = sighted(model, surface)
    border = np.float32(_BORDER_SHARE * max(model.width, model.height))
    usable = (sight.xy >= border).all(axis=-1)
    usable &= (sight.xy <= np.array([model.width, model.height], np.float32) - border).all(axis=-1)
    doubtful = surface.edge
    if model.kind == "pose":
        usable &= ~sight.grazing
        buffer = DepthBuffer.of(model, sight.xy, sight.depth, surface.quads)
        # By how much a surface's depth changes over a cell.
        incline = np.sqrt(np.maximum(1 - sight.cosine**2, 0)) / np.maximum(np.abs(sight.cosine), 1 / _STEEPEST)
        slope = sight.depth * incline * np.float32(1.5 * buffer.cell / model.focal_px)
        usable[usable] = buffer.sees(sight.xy[usable], sight.depth[usable], slope[usable])
        hidden, perhaps = surface.unknown.between(model, sight, usable)
        usable &= ~hidden & ~(sight.rise > _LEVEL)
        doubtful = doubtful | perhaps | _at_outline(buffer, sight, slope, usable)
    usable[usable] = ~_in_nothing(photo, sight.xy[usable])
    rgb = np.zeros((*scan.shape, 3), np.uint8)
    rgb[usable] = colors_at(photo, sight.xy[usable], sight.footprint[usable])
    behind = usable & (sight.cosine < 0)
    quality = np.abs(sight.cosine) * np.where(behind, np.float32(_BEHIND), np.float32(1))
    quality *= np.minimum(sight.footprint, 1)
    quality *= _sharpness(photo, float(np.median(sight.footprint[usable])) if usable.any() else 1.0)
    aside = model.kind == "pose" and np.linalg.norm(model.center) > _ASIDE * np.median(scan.range[scan.valid])
    return View(usable, doubtful & usable, behind, rgb, np.where(usable, quality, 0).astype(np.float32), bool(aside))


@dataclass(frozen=True, eq=False)
class Sight:
    """Where the pixels of a scan fall into a photo; NaN where there is no return, or it lies behind the camera.

    xy : (H, W, 2) float32
        Pixels from the photo's top left corner.
    depth : (H, W) float32
        Meters along the camera's axis.
    cosine : (H, W) float32
        Between the surface's normal, which points to the scanner, and the way to the camera: negative where that was on
        the other side. 1 for a homography.
    rise : (H, W) float32
        Where the cosine is negative, the sine of the angle by which the way to the camera rises or falls; else 0.
    grazing : (H, W) bool
        Whether the surface is seen too slantwise to tell its color.
    footprint : (H, W) float32
        Pixels of the photo that a pixel of the scan covers, along one side.
    """

    xy: np.ndarray
    depth: np.ndarray
    cosine: np.ndarray
    rise: np.ndarray
    grazing: np.ndarray
    footprint: np.ndarray


def sighted(model, surface):
    """Return the `Sight` of a model on a `GridSurface`."""
    scan = surface.scan
    height, width = scan.shape
    xy = np.empty((height, width, 2), np.float32)
    depth, cosine, rise, footprint = (np.empty((height, width), np.float32) for _ in range(4))
    grazing = np.zeros((height, width), bool)
    rows = max(1, _CHUNK_PIXELS // width)
    for top in range(0, height, rows):
        strip = slice(top, min(top + rows, height))
        places = np.arange(strip.start, strip.stop)[:, None], np.arange(width)
        sites = model.sites_of(scan, *places)
        xy[strip], depth[strip] = model.project(sites)
        if model.kind == "pose":
            way = model.center - sites
            distance = np.maximum(np.sqrt(np.einsum("...i,...i->...", way, way)), 1e-12)
            normals = surface.normals[strip]
            facing = np.einsum("...i,...i->...", normals, way) / distance
            # At the rim of a thing a neighbor is missing and the normal unknown.
            cosine[strip] = np.where(normals.any(axis=-1), facing, 0.5)
            rise[strip] = np.where(cosine[strip] < 0, np.abs(way[..., 2]) / distance, 0)
            own = _scan_cosine(surface, strip)
            grazing[strip] = np.abs(cosine[strip]) < np.minimum(_GRAZING, _AS_SCANNER * own)
            area = surface.pixel_area * scan.range[strip] ** 2 * np.abs(cosine[strip]) / np.maximum(own, 1 / _STEEPEST)
            footprint[strip] = model.focal_px * np.sqrt(area) / distance
        else:
            cosine[strip], rise[strip] = 1, 0
            across, down = (model.project(model.sites_of(scan, *moved))[0] for moved in _moved(places))
            across, down = across - xy[strip], down - xy[strip]
            footprint[strip] = np.sqrt(np.abs(across[..., 0] * down[..., 1] - across[..., 1] * down[..., 0]))
        lost = ~scan.valid[strip] | ~(depth[strip] > 0)
        xy[strip][lost], depth[strip][lost] = np.nan, np.nan
    return Sight(xy, depth, cosine, rise, grazing, footprint)


def _moved(places):
    rows, cols = places
    return (rows, cols + 1), (rows + 1, cols)


def _scan_cosine(surface, strip):
    """(h, W): cosine of the angle at which the scanner saw the surface; 1 where that is unknown."""
    scan, normals = surface.scan, surface.normals[strip]
    cosine = -np.einsum("...i,...i->...", normals, scan.points[strip]) / np.maximum(scan.range[strip], 1e-12)
    return np.where(normals.any(axis=-1), cosine, 1)


def _at_outline(buffer, sight, slope, usable):
    """(H, W) bool: next to what is much nearer, farther or unknown in the photo."""
    result = np.zeros(usable.shape, bool)
    if not usable.any():
        return result
    pixel = float(np.median(sight.footprint[usable])) / buffer.cell
    radius = max(_OUTLINE, round(_OFF * pixel))
    farthest, nearest = buffer.outlines(radius)
    place, own, slack = buffer.at(sight.xy[usable]), sight.depth[usable], slope[usable] * radius
    result[usable] = (farthest[place] > own * (1 + _OTHER_THING) + slack) | (
        nearest[place] < own * (1 - _OTHER_THING) - slack
    )
    return result


def colors_at(photo, xy, footprint):
    """Return the (N, 3) uint8 colors of a photo at (N, 2) places, each averaged over about (N,) pixels along a side."""
    import cv2

    colors = np.zeros((len(xy), 3), np.uint8)
    level = np.floor(np.log2(np.maximum(footprint * _AS_BLURRED, 1))).astype(np.int8)
    image, last = photo.rgb, int(level.max(initial=0))
    for number in range(last + 1):
        own = np.flatnonzero(level == number)
        for start in range(0, len(own), _CHUNK_PIXELS):
            part = own[start : start + _CHUNK_PIXELS]
            colors[part] = _looked_up(photo, image, xy[part], cv2.INTER_LINEAR)
        if min(image.shape[:2]) > 1:
            half = image.shape[1] // 2, image.shape[0] // 2
            image = cv2.resize(image, half, interpolation=cv2.INTER_AREA)
    return colors


def _looked_up(photo, image, xy, how):
    """The values of an image of a photo, (h, w, ...) uint8, at (N, 2) places in pixels of the photo."""
    import cv2

    if not len(xy):
        return np.zeros((0, *image.shape[2:]), image.dtype)
    places = xy / np.array([photo.width / image.shape[1], photo.height / image.shape[0]], np.float32) - np.float32(0.5)
    # cv2.remap takes no image of more than 32,767 columns or rows.
    places = np.resize(places, (-(-len(xy) // _ROW), _ROW, 2))
    found = cv2.remap(image, places, None, how, borderMode=cv2.BORDER_REPLICATE)
    return found.reshape(-1, *image.shape[2:])[: len(xy)]


def _in_nothing(photo, xy):
    """(N,) bool: which places lie where a photo has nothing: beyond its picture, or what its file makes invisible."""
    import cv2

    nothing = photo.once("nothing", lambda: _nothing(photo.rgb))
    if nothing is None:
        return np.zeros(len(xy), bool)
    return _looked_up(photo, nothing, xy, cv2.INTER_NEAREST) > 0


def _nothing(rgb):
    """(h, w) uint8, 1 in large black parts that reach the border of a photo, or that are black without any noise."""
    import cv2

    # Many times faster than NumPy, and without copies of the photo.
    dark = cv2.inRange(rgb, (0, 0, 0), (_DARKEST - 1,) * 3)
    # Most photos are done here; labels take four bytes a pixel.
    if np.count_nonzero(dark) < _LEAST_NOTHING * dark.size:
        return None
    number, label, stats, _ = cv2.connectedComponentsWithStats(dark, connectivity=4)
    large = stats[:, cv2.CC_STAT_AREA] >= _LEAST_NOTHING * label.size
    large[0] = False
    if not large.any():
        return None
    border = np.concatenate([label[0], label[-1], label[:, 0], label[:, -1]])
    reaching = np.isin(np.arange(number), border)
    noisy = np.zeros(number, bool)
    noisy[label[(dark > 0) & (cv2.inRange(rgb, (0, 0, 0), (0, 0, 0)) == 0)]] = True
    nothing = large & (reaching | ~noisy)
    return nothing[label].astype(np.uint8) if nothing.any() else None


def _sharpness(photo, detail):
    """How sharp a photo is at the scan's detail: a blurred one has no finer contrast than coarse."""
    import cv2

    image, _ = photo.level(detail)
    fine = np.abs(image - cv2.GaussianBlur(image, (0, 0), 1.0)).mean()
    coarse = np.abs(image - cv2.GaussianBlur(image, (0, 0), 3.0)).mean()
    return float((fine + np.float32(_FAINT)) / (coarse + np.float32(_FAINT)))
