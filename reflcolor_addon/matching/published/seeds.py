"""Seeds from photos as published: by the similarity of superpixels."""

import numpy as np

from ...messages import Message
from ...seeds.seeds import Seeds
from ..scan_image import reflectance_image
from .hog_matching import described_photo, described_scan, hog_matches, scan_superpixels, square_image


def published_seeds(scan, photos, settings, step):
    """Return Seeds for every superpixel of a scan, of the color of the most similar superpixel of any photo.

    Parameters
    ----------
    scan : Scan
    photos : list of PhotoImage
    settings : Settings
    step : callable
        Called as ``step(fraction, text)``; may raise to end the work.

    References
    ----------
    .. [1] S. Oishi, R. Kurazume, Y. Iwashita, T. Hasegawa, "Colorization of 3D Geometric Model utilizing Laser
       Reflectivity", ICRA 2013.
    """
    step(0.05, Message("Superpixels of the scan"))
    image = square_image(scan, reflectance_image(scan, "percentiles"))
    own = described_scan(scan, image, scan_superpixels(scan, image, settings), settings)
    others = []
    for index, photo in enumerate(photos):
        step(0.3 + 0.5 * index / len(photos), Message("{photo}: superpixels", photo=photo.name))
        others.append(described_photo(photo.rgb, max(image.shape), settings))
    step(0.85, Message("Comparing superpixels"))
    matches = hog_matches(own, others)
    rows, cols = own.superpixels.centers.T
    xy = matches.xy * np.array([(photo.width, photo.height) for photo in photos])[matches.photo]
    return Seeds(
        rows=image.rows[rows],
        cols=image.cols[cols],
        rgb=matches.rgb,
        photos=tuple(photos[index].name for index in matches.photo),
        photo_xy=xy,
        confidence=matches.similarity,
        reason=("appearance",) * len(rows),
    )
