"""Small valid files of every kind that is read, and what reads them."""

import json
from dataclasses import dataclass
from io import BytesIO

import cv2
import numpy as np
import tifffile
from e57_samples import e57_with_photo
from e57_samples import write_e57 as write_raw_e57
from sample_scans import intensity_of, ptx_text, room_points
from small_scans import random_scan
from test_image_files import exr
from test_readers_formats import lzf, packed_rgb

from reflcolor_addon import Seeds, Settings, colorize, read_scans
from reflcolor_addon.batch.archive.check import check_manifest
from reflcolor_addon.batch.archive.manifest_file import load_manifest
from reflcolor_addon.batch.archive.pairs import read_pairs
from reflcolor_addon.files.images import read_image, read_measured
from reflcolor_addon.files.photo_files import photos_of
from reflcolor_addon.files.readers import ReadOptions
from reflcolor_addon.files.readers.las import imported_laspy
from reflcolor_addon.files.writers import write_e57, write_ply, write_ptx
from reflcolor_addon.report.provenance import outline, read_report
from reflcolor_addon.report.report import build_report, input_entry, output_entry, scan_entry, stamped
from reflcolor_addon.report.verification import verify_outputs
from reflcolor_addon.scan.surface import ScanSurface

POINTS = room_points(6, 9)
NAMES = intensity_of(POINTS)
COLOR = np.random.default_rng(1).integers(0, 256, POINTS.shape, np.uint8)
ANGLE = ReadOptions(grid="angle", position=(0, 0, 0))


@dataclass(frozen=True)
class Sample:
    """A valid file.

    Parameters
    ----------
    name : str
        Of the file, with its suffix.
    data : bytes
    read : callable
        Called with the path of the file.
    """

    name: str
    data: bytes
    read: object


def samples(folder):
    """Return {kind: list of Sample}; files that others name are written into the folder, and stay there."""
    return {
        "PTX": [Sample("a.ptx", data, read_scans) for data in _ptx(folder)],
        "PCD": [Sample("a.pcd", data, read_scans) for data in _pcd()],
        "PLY": [Sample("a.ply", data, read_scans) for data in _ply(folder)],
        "LAS": [Sample("a.las", data, _read_by_angle) for data in _las(folder, ".las")],
        "LAZ": [Sample("a.laz", data, _read_by_angle) for data in _las(folder, ".laz")],
        "NumPy": [Sample(name, data, read_scans) for name, data in _numpy()],
        "text": [Sample(name, data, _read_by_angle) for name, data in _texts()],
        "image pair": [Sample("a.scan.json", data, read_scans) for data in _pairs(folder)],
        "PNG": [Sample("a.png", data, read) for data in _encoded(".png") for read in (_photo, read_measured)],
        "JPEG": [Sample("a.jpg", data, _photo) for data in _encoded(".jpg")],
        "WebP": [Sample("a.webp", data, _photo) for data in _encoded(".webp")],
        "BMP": [Sample("a.bmp", data, _photo) for data in _encoded(".bmp")],
        "TIFF": [Sample("a.tif", data, read) for data in _tiff() for read in (_photo, read_measured)],
        "EXR": [Sample("a.exr", data, read) for data in _exr() for read in (_photo, read_measured)],
        "seeds": [Sample("a.json", data, Seeds.load) for data in _seeds()],
        "report": [Sample("a.json", data, _verify) for data in _reports(folder)],
        "manifest": [Sample("a.toml", data, _manifest) for data in _manifests(folder)],
        "pairs": [Sample("pairs.csv", data, read_pairs) for data in _tables_of_pairs()],
        "E57": [Sample("a.e57", data, read_scans) for data in _e57(folder)]
        + [Sample("a.e57", data, read) for data in _e57_with_photo(folder) for read in (read_scans, photos_of)],
    }


def _photo(path):
    return read_image(path, [])


def _read_by_angle(path):
    return read_scans(path, options=ANGLE)


def _verify(path):
    report = read_report(path)
    outline(report)
    return verify_outputs(report, path)


def _manifest(path):
    faults = []
    manifest = load_manifest(path, faults.append)
    if not faults:
        check_manifest(manifest, None, faults.append)
    if faults:
        raise max(faults, key=lambda fault: len(str(fault)))


def _manifests(folder):
    Seeds([1, 4], [2, 5], [[200, 80, 40], [20, 80, 220]]).save(folder / "sample.seeds.json")
    head = 'format = "reflcolor-batch"\nversion = 1\noutput = "colored"\nwrite = ["png", "ply"]\n'
    one = '[[scan]]\nfile = "sample.ptx"\nseeds = "sample.seeds.json"\nname = "yard"\n'
    yield (head + one).encode()
    yield f'{head}photos = ["*.png"]\nscans = ["sample.ptx"]\n[settings]\nalpha = 3.0\nbeta = 1\n'.encode()


def _tables_of_pairs():
    rows = (("scan", "photo", "shows"), ("yard", "rgb.png", "yes"), ("yard", "ir.png", "no"), ("hall", "a, b.jpg", ""))
    for between in ",;":
        lines = (between.join(f'"{cell}"' if "," in cell else cell for cell in row) for row in rows)
        yield "\n".join(lines).encode()


def _e57_with_photo(folder):
    e57_with_photo(folder / "sample.e57", np.random.default_rng(6).integers(0, 256, (12, 17, 3), np.uint8))
    yield (folder / "sample.e57").read_bytes()


def _e57(folder):
    path = folder / "sample.e57"
    row, column = np.mgrid[: POINTS.shape[0], : POINTS.shape[1]]
    fields = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), np.moveaxis(POINTS, -1, 0), strict=True))
    fields |= {"intensity": NAMES, "rowIndex": row, "columnIndex": column}
    plain = {"fields": {name: values.ravel() for name, values in fields.items()}, "name": "yard"}
    distance = np.linalg.norm(POINTS, axis=-1)
    spherical = {
        "sphericalRange": distance,
        "sphericalAzimuth": np.arctan2(POINTS[..., 1], POINTS[..., 0]),
        "sphericalElevation": np.arcsin(POINTS[..., 2] / distance),
        "sphericalInvalidState": np.zeros(NAMES.shape, int),
        "rowIndex": row,
        "columnIndex": column,
    }
    turned = {"fields": {name: values.ravel() for name, values in spherical.items()}, "guid": "{x}"}
    for scans in ([plain], [turned], [plain, turned]):
        write_raw_e57(path, *scans)
        yield path.read_bytes()
    write_e57(random_scan(), path)
    yield path.read_bytes()


def _ptx(folder):
    yield ptx_text(POINTS, NAMES).encode()
    yield ptx_text(POINTS, NAMES, COLOR, end="\r\n", between="\t").encode()
    yield (ptx_text(POINTS[:2, :2], NAMES[:2, :2]) * 3).encode()
    write_ptx(random_scan(), folder / "sample.ptx")
    yield (folder / "sample.ptx").read_bytes()


def _pcd():
    table = np.empty(NAMES.shape, [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("rgb", "<f4")])
    for axis, name in enumerate("xyz"):
        table[name] = POINTS[..., axis]
    table["intensity"], table["rgb"] = NAMES, packed_rgb(COLOR)
    head = (
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity rgb\nSIZE 4 4 4 4 4\n"
        f"TYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH {NAMES.shape[1]}\nHEIGHT {NAMES.shape[0]}\n"
        f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {NAMES.size}\nDATA "
    ).encode()
    rows = (" ".join(repr(float(number)) for number in record) for record in table.ravel())
    yield head + b"ascii\n" + "\n".join(rows).encode() + b"\n"
    yield head + b"binary\n" + table.tobytes()
    columns = b"".join(np.ascontiguousarray(table[name]).tobytes() for name in table.dtype.names)
    packed = lzf(columns)
    sizes = np.array([len(packed), len(columns)], "<u4").tobytes()
    yield head + b"binary_compressed\n" + sizes + packed


def _las(folder, suffix):
    for version, point_format in (("1.2", 2), ("1.4", 7)):
        laspy = imported_laspy()
        header = laspy.LasHeader(version=version, point_format=point_format)
        header.scales, header.offsets = np.full(3, 1e-4), np.zeros(3)
        header.add_extra_dim(laspy.ExtraBytesParams(name="grid_row", type=np.uint16))
        cloud = laspy.LasData(header)
        cloud.x, cloud.y, cloud.z = POINTS.reshape(-1, 3).T
        cloud.intensity = cloud.grid_row = np.arange(NAMES.size)
        cloud.red, cloud.green, cloud.blue = COLOR.reshape(-1, 3).astype(np.uint16).T * 257
        cloud.write(folder / f"sample{suffix}")
        yield (folder / f"sample{suffix}").read_bytes()


def _ply(folder):
    scan = random_scan()
    rgb = np.random.default_rng(2).integers(0, 256, (*scan.shape, 3), np.uint8)
    write_ply([ScanSurface(scan, rgb)], folder / "sample.ply")
    yield (folder / "sample.ply").read_bytes()
    height, width = NAMES.shape
    vertices = "".join(f"{x} {y} {z} {i}\n" for (x, y, z), i in zip(POINTS.reshape(-1, 3), NAMES.ravel(), strict=True))
    properties = "property float x\nproperty float y\nproperty float z\nproperty float intensity\n"
    cells = "".join(f"1 {number}\n" if number % 5 else "0\n" for number in range(NAMES.size))
    yield (
        f"ply\nformat ascii 1.0\nobj_info num_cols {width}\nobj_info num_rows {height}\nelement vertex {NAMES.size}\n"
        f"{properties}element range_grid {NAMES.size}\nproperty list uchar int vertex_indices\nend_header\n"
        f"{vertices}{cells}"
    ).encode()


def _numpy():
    def saved(**arrays):
        file = BytesIO()
        np.savez(file, **arrays)
        return file.getvalue()

    yield "a.npz", saved(points=POINTS, reflectance=NAMES)
    yield "a.npz", saved(xyz=POINTS.astype(np.float32), intensity=NAMES.astype(np.float32), rgb=COLOR)
    ranges = np.linalg.norm(POINTS, axis=-1)
    angles = {"azimuth_deg": np.linspace(40, -8, NAMES.shape[1]), "elevation_deg": np.linspace(16, -4, NAMES.shape[0])}
    yield "a.npz", saved(range=(ranges * 1000).astype(np.uint32), reflectivity=NAMES, **angles)
    file = BytesIO()
    np.savez_compressed(file, points=POINTS, reflectance=NAMES)
    yield "a.npz", file.getvalue()
    file = BytesIO()
    np.save(file, np.concatenate([POINTS, NAMES[..., None]], axis=-1))
    yield "a.npy", file.getvalue()


def _texts():
    rows = [(*point, value) for point, value in zip(POINTS.reshape(-1, 3), NAMES.ravel(), strict=True)]
    lines = [" ".join(f"{number:.5f}" for number in row) for row in rows]
    yield "a.xyz", ("# points\n" + "\n".join(lines)).encode()
    yield "a.pts", (f"{len(lines)}\n" + "\n".join(lines) + "\n").encode()
    yield "a.csv", ("x,y,z,i\n" + "\n".join(lines).replace(" ", ",")).encode()


def _pairs(folder):
    deep = (np.linalg.norm(POINTS, axis=-1) * 1000).astype(np.uint16)
    cv2.imwrite(str(folder / "depth.png"), deep)
    cv2.imwrite(str(folder / "ir.png"), (NAMES * 60).astype(np.uint16))
    cv2.imwrite(str(folder / "rgb.png"), COLOR)
    base = {"format": "reflcolor-scan", "version": 1, "range": "depth.png", "range_scale": 0.001}
    base |= {"reflectance": "ir.png"}
    pinhole = {"type": "pinhole", "fx": 8.0, "fy": 8.0, "cx": 4.0, "cy": 2.5, "distortion": [0.1, 0.01, 0, 0]}
    spherical = {"type": "spherical", "azimuth_deg": [-40, 40], "elevation_deg": [-20, 20]}
    pose = np.eye(4).tolist()
    yield json.dumps(base | {"model": spherical}).encode()
    yield json.dumps(base | {"model": pinhole, "color": "rgb.png", "color_order": "bgr", "pose": pose}).encode()
    table = {"range_table": [[1, 0.5], [9000, 9.0]], "range_type": "ray", "name": "yard"}
    del base["range_scale"]
    yield json.dumps(base | table | {"model": spherical}).encode()


def _encoded(suffix):
    chance = np.random.default_rng(3)
    shape = (12, 17)
    images = [chance.integers(0, 256, (*shape, 3), np.uint8)]
    if suffix == ".png":
        images += [chance.integers(0, 65536, shape, np.uint16), chance.integers(0, 256, (*shape, 4), np.uint8)]
    for image in images:
        yield cv2.imencode(suffix, image)[1].tobytes()


def _tiff():
    chance = np.random.default_rng(4)
    shape = (12, 17)
    made = [
        (chance.integers(0, 256, (*shape, 3), np.uint8), {"photometric": "rgb"}),
        (chance.integers(0, 65536, shape, np.uint16), {"compression": "zlib", "predictor": True}),
        (chance.random(shape, np.float32), {"compression": "zlib"}),
        (chance.integers(0, 65536, (3, *shape), np.uint16), {"photometric": "rgb", "planarconfig": "separate"}),
        (chance.integers(0, 256, (32, 32), np.uint8), {"tile": (16, 16), "compression": "zlib"}),
        (chance.integers(0, 256, shape, np.uint8), {"photometric": "miniswhite", "rowsperstrip": 4}),
    ]
    for image, options in made:
        file = BytesIO()
        tifffile.imwrite(file, image, **options)
        yield file.getvalue()


def _exr():
    values = np.random.default_rng(5).random((6, 9))
    yield exr(dict.fromkeys("RGB", values), 0)
    yield exr({"Z": values}, 2)
    yield exr({"Z": values}, 3, half=True)


def _seeds():
    yield json.dumps(
        {
            "format": "reflcolor-seeds",
            "version": 1,
            "seeds": [
                {"row": 1, "col": 2, "rgb": [200, 80, 40]},
                {"row": 5, "col": 7, "photo": "rgb.png", "x": 3.5, "y": 2.0},
                {"row": 4, "col": 3, "rgb": [1, 2, 3], "confidence": 0.5},
            ],
        }
    ).encode()


def _reports(folder):
    scan, seeds = random_scan(), Seeds([1, 4], [2, 8], [[200, 80, 40], [20, 80, 220]])
    (folder / "out.png").write_bytes(b"x")
    report = build_report(
        scan_entry(scan, 1),
        colorize(scan, seeds),
        Settings(),
        given_seeds=seeds,
        inputs=[input_entry("scan", folder / "depth.png")],
        outputs=[("-o", folder / "out.png")],
    )
    outputs = [output_entry("-o", folder / "out.png", folder / "a.json")]
    yield json.dumps(stamped(report) | {"outputs": outputs}).encode()
