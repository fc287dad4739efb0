"""A hall as files hold it, whose intensity names the pixel, for tests of what exporters write."""

import numpy as np
from e57_samples import write_e57
from sample_scans import intensity_of, room_points

from reflcolor_addon.files.readers import ReadOptions, read_scans

HALL = room_points(40, 90, step_deg=(3.0, 4.0), top_deg=60.0, left_deg=178.0)
# A floor and a ceiling, so that a column of the grid is more than one upright line.
HALL = HALL * np.minimum(1, np.where(HALL[..., 2] < 0, 1.2, 1.8) / np.maximum(np.abs(HALL[..., 2]), 1e-9))[..., None]
NAMES = intensity_of(HALL)
COLOR = np.random.default_rng(1).integers(0, 256, HALL.shape, np.uint8)


def ptx(tmp_path, text):
    path = tmp_path / "hall.ptx"
    path.write_text(text)
    return read_scans(path)


def e57(tmp_path, *scans, **options):
    write_e57(tmp_path / "hall.e57", *scans)
    return read_scans(tmp_path / "hall.e57", options=ReadOptions(**options))


def fields(points=HALL, rows=None, cols=None, keep=None, **more):
    """Columns of an E57: of every pixel that is kept, in the order of the grid."""
    row, col = np.mgrid[: points.shape[0], : points.shape[1]]
    columns = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), np.moveaxis(points, -1, 0), strict=True))
    columns |= {
        "intensity": NAMES,
        "rowIndex": row if rows is None else rows,
        "columnIndex": col if cols is None else cols,
    }
    columns |= more
    keep = slice(None) if keep is None else np.ravel(keep)
    return {"fields": {name: np.ravel(values)[keep] for name, values in columns.items() if values is not None}}
