"""Makes what a release hands out, in dist/release/: python tools/release.py [--platform NAME]...

A zip per platform for every Python that a Blender runs, `SHA256SUMS` with their hashes, and `index.json`, which makes
the folder an extension repository: served as it is, or as a file:// address, Blender installs and updates from it.
A release without a section of its version in CHANGELOG.md fails.
"""

import argparse
import re
import shutil
import sys
from pathlib import Path

from blender_cli import blender_ext
from build_extension import DIST, PLATFORMS, PYTHONS, ROOT, BuildError, build, link_or_copy, sha256

sys.path.insert(0, str(ROOT))
from reflcolor_addon.version import __version__

RELEASE = DIST / "release"


def main() -> None:
    """Build every zip and lay out the release."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--platform", action="append", choices=PLATFORMS, help="by default all of them")
    args = parser.parse_args()
    if not has_section((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), __version__):
        sys.exit(f"release: CHANGELOG.md has no section of version {__version__}")
    try:
        zips = [build(platform, PYTHONS) for platform in args.platform or PLATFORMS]
    except BuildError as error:
        sys.exit(f"release: {error}")
    for line in lay_out(zips, RELEASE):
        print(line)
    print(f"In {RELEASE.relative_to(ROOT)}, with SHA256SUMS and index.json")


def has_section(changelog: str, version: str) -> bool:
    """Whether a changelog has a section of a version with anything in it."""
    return re.search(rf"^## {re.escape(version)}\b[^\n]*\n+(?!#)\S", changelog, re.MULTILINE) is not None


def lay_out(zips: list[Path], folder: Path) -> list[str]:
    """Fill an empty folder with zips, their hashes and the index of a repository; returns a line for each zip."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for zip_file in sorted(zips):
        link_or_copy(zip_file, folder / zip_file.name)
    names = sorted(zip_file.name for zip_file in zips)
    sums = "".join(f"{sha256(folder / name)}  {name}\n" for name in names)
    (folder / "SHA256SUMS").write_text(sums, encoding="utf-8", newline="\n")
    blender_ext("server-generate", "--repo-dir", folder)
    return [f"{(folder / name).stat().st_size / 1e6:.0f} MB  {name}" for name in names]


if __name__ == "__main__":
    main()
