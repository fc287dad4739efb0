"""Photos made small, kept in the folder of a batch: looks need no more of them."""

from ...files.images import read_image, write_png

_SIDE = 640


def sketch_of(folder, path, key):
    """Return a photo made small.

    Parameters
    ----------
    folder : BatchFolder
        Where it is kept.
    path : path-like
    key : str
        The hash of the photo; empty if it could not be hashed. Then it is not kept.

    Returns
    -------
    (h, w, 3) uint8

    Raises
    ------
    ReflcolorError
        If the photo cannot be read.
    """
    import cv2

    kept = folder.sketch(key) if key else None
    if kept is not None and kept.is_file():
        return read_image(kept)
    rgb = read_image(path)
    scale = max(rgb.shape) / _SIDE
    if scale > 1:
        size = max(1, round(rgb.shape[1] / scale)), max(1, round(rgb.shape[0] / scale))
        rgb = cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)
    if kept is not None:
        write_png(kept, rgb)
    return rgb
