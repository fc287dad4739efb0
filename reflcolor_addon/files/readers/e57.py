"""E57: scans of points that know their row and column, or the line that they are in."""

import numpy as np

from ...errors import Cancelled, ScanError
from ...messages import Message
from ..gate import size_of
from ..memory import require_memory
from .e57_columns import E57Columns
from .e57_file import read_structure, scan_name, scan_nodes
from .e57_header import GROUP, GROUPS, INDEX, require_structure, scan_header
from .e57_points import E57Points
from .formats import Format
from .grid import BYTES_PER_PIXEL, UnusableScan, finish_grid, with_problems
from .options import ANGLE, AS_IT_IS, LIGHTER, pixels_kept

# Pixels for each point of a grid whose bounds are believed before it is read.
_SPARSEST = 100


def read_e57(file, path, *, options=AS_IT_IS, outside=False, progress=None, cancelled=None):
    """Read every structured scan of an E57 file.

    Coordinates may be Cartesian or spherical and stay in the scan's own frame, apart from its pose. Pose, limits, index
    bounds and invalid states are all optional. Intensity is kept as it is; colors are brought to 8 bits by what their
    values are. Rows and columns are counted from the least that occurs, and may have holes; where there are none, lines
    of points will do.

    Parameters
    ----------
    file : binary file
    path : Path
        Its name, for messages.
    options : ReadOptions
    progress, cancelled : callable, optional

    Errors are those of `read_scans`; a file with none but unstructured scans is a ScanError.
    """
    asked = {"options": options, "progress": progress, "cancelled": cancelled}
    read = [scan for scan, *_ in each_scan(file, path, with_cells=False, **asked)]
    finished = [scan for scan in read if not isinstance(scan, UnusableScan)]
    problems = [scan for scan in read if isinstance(scan, UnusableScan)]
    return with_problems(finished, problems, len(read), path)


def each_scan(file, path, *, options=AS_IT_IS, with_cells=True, progress=None, cancelled=None):
    """Yield for every scan of an E57 file, in its order, (scan, order, cells).

    Parameters
    ----------
    with_cells : bool
        Without them a scan of which only every n-th row and column is read takes less memory.

    Others and errors are those of `read_scans`.

    Yields
    ------
    scan : Scan, or UnusableScan
        The error for one that cannot be used.
    order : GridOrder
        The way from the stored grid to the scan's; None for one that cannot be used.
    cells : callable or None
        Returns (N,) int64: the pixel of the stored grid that each point of the file is in, row by row; -1 for none.
    """
    root, xml_size = read_structure(file, path, cancelled)
    nodes = scan_nodes(root, path)
    headers = [
        _header(node, path, size_of(file), scan_name(node, path, index, len(nodes)), options)
        for index, node in enumerate(nodes)
    ]
    usable = [header for header in headers if not isinstance(header, UnusableScan)]
    if not usable:
        yield from ((header, None, None) for header in headers)
        return
    most = {
        "fields": max(max(len(header.fields), len(GROUP)) for header in usable),
        "count": max(max(header.count, header.group_count) for header in usable),
    }
    with E57Columns(file, path, **most, xml_size=xml_size, cancelled=cancelled) as columns:
        done = 0
        for index, header in enumerate(headers):
            if isinstance(header, UnusableScan):
                yield header, None, None
                continue

            def report(fraction, done=done, name=header.name):
                if cancelled and cancelled():
                    raise Cancelled
                if progress:
                    progress(
                        (done + fraction) / len(usable), Message("Reading {file}: {name}", file=path.name, name=name)
                    )

            done += 1
            if header.grouped_by is not None and not header.has(INDEX):
                parts = [
                    {name: values.copy() for name, values in part.items()}
                    for part in columns.read(index, header.group_count, GROUP, report, vector=GROUPS)
                ]
                header.groups = {name: np.concatenate([part[name] for part in parts]) for name in GROUP}
            points = E57Points(header, options, with_cells)
            for part in columns.read(index, header.count, header.fields, report):
                points.add(part)
            try:
                stored, cells = points.grids()
                del points
                yield (*finish_grid(source=path, **stored), cells)
            except UnusableScan as error:
                yield error, None, None


def e57_pixels(file, path, *, options=AS_IT_IS, outside=False):
    """Return the pixels of every scan of an E57 that can be used, by its index bounds, else its points; see
    `scan_pixels`."""
    root, _ = read_structure(file, path)
    nodes = scan_nodes(root, path)
    pixels, problems = [], []
    for index, node in enumerate(nodes):
        try:
            header = scan_header(node, path.name, size_of(file), scan_name(node, path, index, len(nodes)))
            if options.grid != ANGLE:
                require_structure(header)
        except UnusableScan as error:
            problems.append(error)
            continue
        bounds = [end for name in INDEX for end in header.limits[name]]
        grid = 0 if None in bounds else (bounds[1] - bounds[0] + 1) * (bounds[3] - bounds[2] + 1)
        # Bounds that are far beyond the points are not to be relied on.
        pixels.append(int(grid) if header.count <= grid <= header.count * _SPARSEST else header.count)
    if not pixels:
        with_problems([], problems, len(nodes), path)
    return pixels_kept(pixels, options)


def _header(node, path, file_size, name, options):
    """The ScanHeader of a scan, or the UnusableScan that says why it has none."""
    try:
        header = scan_header(node, path.name, file_size, name)
    except UnusableScan as error:
        return error
    thinned = options.step if header.has(INDEX) and options.grid != ANGLE else 1
    require_memory(
        header.count // thinned**2 * (4 * len(header.fields) + BYTES_PER_PIXEL),
        Message("{file}: scan '{scan}': {count:,} points", file=path.name, scan=name, count=header.count),
        way=LIGHTER,
        error=ScanError,
    )
    return header


FORMAT = Format(
    name="E57",
    suffixes=(".e57",),
    read=read_e57,
    pixels=e57_pixels,
    sniff=lambda start: start.startswith(b"ASTM-E57"),
    about="scans whose points know their row and column, or their line; others with --grid angle",
)
