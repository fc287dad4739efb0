"""Drafts a manifest from what lies in a folder."""

import os
from collections import Counter
from pathlib import Path

from ...errors import ReflcolorError, ScanError
from ...files.images import IMAGE_SUFFIXES, image_size
from ...files.readers import SCAN_SUFFIXES, scan_pixels, text_cloud
from ..paths import scan_files
from .folder import files_below

_HEAD = """\
# Drafted by reflcolor manifest. Look it through, change what is wrong, then run:
#   blender -b --command reflcolor batch {name} --check
#   blender -b --command reflcolor batch {name}
# Paths are seen from this file's folder; * stands for any name, ** for any folders.
format = "reflcolor-batch"
version = 1

# Everything that is made goes into this folder.
output = {output}

# What is written of each scan: png (its image, colorized), glb, ply, e57, ptx, usd, blend; Blender makes the last two.
write = ["png", "glb"]

# A rendered picture of each scan; needs Blender.
render = false

# How scans are read: every second row and column of large ones (step); a grid laid over points that have none (grid).
# reading = {{ step = 2, grid = "angle" }}

# An image with the photos' own detail, of so many pixels along its longer side, instead of colors at the vertices.
# texture = 4096

# Light meshes, of so many triangles at most for each scan; needs Blender.
# faces = 200000

# Natural, Enhanced or Paper; and single settings.
# preset = "Natural"
# settings = {{ tone = 1.2 }}

# After a run: a corrected copy of pairs.csv, which says which photo shows which scan.
# pairs = "pairs-corrected.csv"
"""
_SCANS = "\n# The scans.\nscans = [\n{lines}]\n"
_PHOTOS = """
# Photos. Which of them shows which scan is found out; the table pairs.csv in the output folder tells it afterwards.
photos = [
{lines}]
"""
_COLORIZED = "\n# Left out, because they seem to be colorized images of the scans beside them:\n"
_ONE_SCAN = """
# What counts for one scan, or for the scans of a site, which are colored together: docs/manifest.md lists all keys.
# [[scan]]
# file = {file}
# site = "hall"
# photos = ["of the hall/*.jpg"]
# hand = "picked pairs.json"
"""
_SEEDS = "\n# Seeds that lie beside their scan are used as they are.\n"
_ONE = """\
[[scan]]
file = {file}
seeds = {seeds}
"""


def draft(folder, path):
    """Return the text of a manifest for all scans and photos below a folder.

    Parameters
    ----------
    folder : Path
    path : Path
        Where the manifest is going to lie.

    Raises
    ------
    ScanError
        If it holds no scan, or is no folder.
    """
    if not folder.is_dir():
        raise ScanError("{folder}: is not a folder; name the one that holds the scans", folder=folder)
    files = sorted(files_below(folder), key=lambda file: file.as_posix())
    scans = [file for file in files if file.name.lower().endswith(SCAN_SUFFIXES) and not _is_other_text(file)]
    if not scans:
        raise ScanError(
            "{folder}: holds no scan; expected files that end in one of {known}",
            folder=folder,
            known=", ".join(SCAN_SUFFIXES),
        )
    parts = set()
    for scan in scans:
        try:
            parts.update(file.resolve() for file in scan_files(scan) if file != scan)
        except (OSError, ReflcolorError):
            continue
    images = [file for file in files if file.suffix.lower() in IMAGE_SUFFIXES and file.resolve() not in parts]
    colorized = [file for file in images if _is_colorized(file, scans)]
    photos = [file for file in images if file not in colorized]
    seen_from = path.absolute().parent

    def named(file):
        return _quoted(Path(os.path.relpath(file, seen_from)).as_posix())

    def patterns(chosen):
        """The fewest patterns that match the chosen files and no others; the plain name for a single file."""
        folders = Counter((file.parent, _suffix(file)) for file in chosen)
        lines = []
        for (parent, suffix), count in folders.items():
            same = [file for file in chosen if (file.parent, _suffix(file)) == (parent, suffix)]
            others = [
                file for file in files if file.parent == parent and file.name.endswith(suffix) and file not in same
            ]
            if count > 1 and not others and not set("*?[") & set(str(parent)):
                lines.append(f"  {named(parent / f'*{suffix}')},  # {count} files\n")
            else:
                lines += [f"  {named(file)},\n" for file in same]
        return "".join(lines)

    text = _HEAD.format(name=path.name, output=_quoted("colored")) + _SCANS.format(lines=patterns(scans))
    if photos:
        text += _PHOTOS.format(lines=patterns(photos))
    if colorized:
        text += _COLORIZED + "".join(f"#   {named(file)}\n" for file in colorized)
    seeds = {scan: _seeds_of(scan) for scan in scans}
    tables = [_ONE.format(file=named(scan), seeds=named(own)) for scan, own in seeds.items() if own is not None]
    return text + _ONE_SCAN.format(file=named(scans[0])) + (_SEEDS + "\n".join(tables) if tables else "")


def _is_other_text(file):
    """Whether a file is a text without points, such as notes."""
    return file.suffix.lower() in text_cloud.FORMAT.suffixes and not text_cloud.begins_with_points(file)


def _suffix(file):
    lower = file.name.lower()
    known = next((suffix for suffix in SCAN_SUFFIXES if lower.endswith(suffix)), file.suffix)
    return file.name[-len(known) :] if known else ""


def _stem(scan):
    return scan.name[: -len(_suffix(scan))]


def _is_colorized(file, scans):
    """Whether an image is a colorized scan that was written beside it: a PNG of the scan's name, as large as its
    grid."""
    beside = [scan for scan in scans if (scan.parent, _stem(scan)) == (file.parent, file.stem)]
    if not beside or file.suffix.lower() != ".png":
        return False
    try:
        rows, columns = image_size(file)
        return any(rows * columns in scan_pixels(scan) for scan in beside)
    except (OSError, ReflcolorError):
        return False


def _seeds_of(scan):
    """The file of seeds that lies beside a scan and has its name."""
    for name in (f"{_stem(scan)}.seeds.json", f"{scan.name}.seeds.json"):
        if (scan.parent / name).is_file():
            return scan.parent / name
    return None


def _quoted(text):
    """A text as TOML writes it."""
    if "'" not in text and all(char.isprintable() for char in text) and ("\\" in text or '"' in text):
        return f"'{text}'"
    escaped = "".join(char if char.isprintable() and char not in '"\\' else f"\\U{ord(char):08X}" for char in text)
    return f'"{escaped}"'
