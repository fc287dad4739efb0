"""Takes out of the bundled wheels what no program uses (tools/check_zip.py shows what that was).

Left out are the tests of the packages, scikit-image's sample images, the Cython sources of scipy's compiled modules,
and the symbols for debuggers in Linux libraries. Nothing that can be imported or called is taken away: Blender shares a
package among all extensions that bring it. Each trimmed wheel has the build tag `0trimmed`, so that Blender prefers a
whole wheel of the same version where another extension has one. What is left is compressed by libdeflate, whose bytes
depend on its pinned version alone.
"""

import base64
import hashlib
import re
import struct
import zipfile
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import deflate

BUILD_TAG = "0trimmed"
# Beyond this level libdeflate takes twice the time for a thousandth of the size.
LEVEL = 10
LEFT_OUT = re.compile(r"(^|/)tests/|^skimage/data/.*\.(?!pyi?$)[^.]+$|^scipy/.*\.pyx$")


def trim_wheel(wheel: Path, folder: Path) -> Path:
    """Write the trimmed copy of a wheel into a folder and return its path; the bytes depend on the wheel alone."""
    with zipfile.ZipFile(wheel) as archive:
        files = {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}
    files = {name: without_symbols(data) for name, data in files.items() if not LEFT_OUT.search(name)}
    info = _dist_info(files)
    files[f"{info}/WHEEL"] = files[f"{info}/WHEEL"].rstrip(b"\n") + f"\nBuild: {BUILD_TAG}\n".encode()
    files[f"{info}/RECORD"] = _record(files, f"{info}/RECORD")
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / trimmed_name(wheel.name)
    unfinished = path.with_suffix(".unfinished")
    write_zip(files, unfinished)
    return unfinished.replace(path)


def trimmed_name(name: str) -> str:
    """The file name of a wheel with the build tag after its version."""
    package, version, tags = name.split("-", 2)
    return f"{package}-{version}-{BUILD_TAG}-{tags}"


def without_symbols(data: bytes) -> bytes:
    """A Linux library with zeros in place of its symbols for debuggers; anything else as it is.

    Zeros weigh nothing in a zip, and as nothing moves, the library stays what its linker and auditwheel made it. A
    section that the system would load is never touched, whatever its name.
    """
    if data[:6] != b"\x7fELF\x02\x01":
        return data
    emptied = bytearray(data)
    loaded = loaded_parts(data)
    for name, start, size in _sections(data):
        if not name.startswith((".debug_", ".symtab", ".strtab")):
            continue
        if all(start + size <= first or start >= first + length for first, length in loaded):
            emptied[start : start + size] = bytes(size)
    return bytes(emptied)


def loaded_parts(data: bytes) -> list[tuple[int, int]]:
    """Where in the file of a 64-bit ELF library the parts lie that the system loads: (offset, length)."""
    offset, size, count = *struct.unpack_from("<Q", data, 32), *struct.unpack_from("<HH", data, 54)
    headers = [struct.unpack_from("<IIQQQQ", data, offset + size * index) for index in range(count)]
    load = 1
    return [(start, length) for kind, _, start, _, _, length in headers if kind == load]


def faults(original: Path, trimmed: Path) -> list[str]:
    """What a trimmed wheel lacks or has beyond what it may; nothing when it is in order."""
    with zipfile.ZipFile(original) as before, zipfile.ZipFile(trimmed) as after:
        names = {name for name in before.namelist() if not name.endswith("/") and not LEFT_OUT.search(name)}
        found = [f"{name} is not in the original" for name in set(after.namelist()) - names]
        info = _dist_info(names)
        for name in sorted(names):
            if name not in after.namelist():
                found.append(f"{name} is missing")
            elif name not in (f"{info}/RECORD", f"{info}/WHEEL") and not _same(before.read(name), after.read(name)):
                found.append(f"{name} is not the original's")
    return found


def _same(original: bytes, trimmed: bytes) -> bool:
    """Whether two files are the same in all that a system loads."""
    if original == trimmed:
        return True
    if original[:6] != b"\x7fELF\x02\x01" or len(original) != len(trimmed):
        return False
    parts = loaded_parts(original)
    return parts == loaded_parts(trimmed) and all(
        original[start : start + length] == trimmed[start : start + length] for start, length in parts
    )


def _sections(data: bytes):
    """Name, offset and size of every section of a 64-bit ELF library that takes room in its file."""
    (offset,) = struct.unpack_from("<Q", data, 40)
    size, count, names_at = struct.unpack_from("<HHH", data, 58)
    headers = [struct.unpack_from("<IIQQQQ", data, offset + size * index) for index in range(count)]
    nothing, without_bytes = 0, 8
    for index, (name, kind, _, _, start, length) in enumerate(headers):
        if kind not in (nothing, without_bytes) and index != names_at:
            first = headers[names_at][4] + name
            yield data[first : data.index(b"\0", first)].decode(), start, length


def _dist_info(names) -> str:
    """The folder of a wheel that describes it."""
    (folder,) = {name.split("/")[0] for name in names if name.split("/")[0].endswith(".dist-info")}
    return folder


def _record(files: dict[str, bytes], record: str) -> bytes:
    lines = []
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(data)}" if name != record else f"{name},,")
    return ("\n".join(lines) + "\n").encode()


def write_zip(files: dict[str, bytes], path: Path) -> None:
    """Write a zip with libdeflate's streams in it, which zipfile reads but does not make; wheels are stored."""

    def pack(item: tuple[str, bytes]) -> bytes:
        name, data = item
        return data if name.endswith(".whl") else bytes(deflate.deflate_compress(data, LEVEL))

    with ThreadPoolExecutor() as pool, path.open("wb") as out:
        packed = pool.map(pack, files.items())
        directory = b""
        for (name, data), stream in zip(files.items(), packed, strict=True):
            method = zipfile.ZIP_DEFLATED if len(stream) < len(data) else zipfile.ZIP_STORED
            stream = stream if method == zipfile.ZIP_DEFLATED else data
            encoded, place = name.encode(), out.tell()
            # 20: the version of the format that is needed; 0x800: the name is UTF-8; the date is 1980-01-01.
            head = struct.pack("<HHHHH", 20, 0x800, method, 0, 33)
            head += struct.pack("<IIIHH", zlib.crc32(data), len(stream), len(data), len(encoded), 0)
            out.write(b"PK\3\4" + head + encoded + stream)
            directory += b"PK\1\2" + struct.pack("<H", 0x0314) + head
            directory += struct.pack("<HHHII", 0, 0, 0, 0o100644 << 16, place) + encoded
        place = out.tell()
        out.write(directory)
        out.write(b"PK\5\6" + struct.pack("<HHHHIIH", 0, 0, len(files), len(files), len(directory), place, 0))
