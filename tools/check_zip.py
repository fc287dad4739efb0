"""Checks the wheels in a zip of the extension against their publishers': python tools/check_zip.py ZIP

Fetches the wheels that requirements/wheels.txt pins by hash and compares file by file: what is in the zip must be
theirs, to the byte in all that a system loads, and nothing may be missing but what tools/trim_wheels.py leaves out.
"""

import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

from build_extension import PYTHONS, pinned_wheels, sha256
from trim_wheels import faults, trimmed_name


def main(zip_file: Path) -> int:
    """Print a line for each wheel of a zip and return 1 where one is not in order."""
    with tempfile.TemporaryDirectory() as scratch, zipfile.ZipFile(zip_file) as archive:
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
        wheels = {Path(wheel).name: Path(archive.extract(wheel[2:], scratch)) for wheel in manifest["wheels"]}
        (platform,) = manifest["platforms"]
        pythons = [
            version for version in PYTHONS if any(f"-cp{version.replace('.', '')}-cp3" in name for name in wheels)
        ]
        pinned = {trimmed_name(wheel.name): wheel for version in pythons for wheel in pinned_wheels(platform, version)}
        bad = 0
        for name, wheel in wheels.items():
            if name.startswith("reflcolor_kernel-"):
                print(f"{name}: made here, of kernel/src; sha256 {sha256(wheel)}")
                continue
            found = faults(pinned[name], wheel) if name in pinned else ["requirements/wheels.txt has no such wheel"]
            bad += bool(found)
            size, whole = wheel.stat().st_size / 1e6, pinned[name].stat().st_size / 1e6 if name in pinned else 0
            print(f"{name}: {'; '.join(found) or f'in order, {size:.1f} MB of {whole:.1f}'}")
        missing = set(pinned) - set(wheels)
        for name in sorted(missing):
            print(f"{name}: missing")
    return 1 if bad or missing else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(Path(sys.argv[1])))
