"""What grows with the number of scans in a batch, beside the work itself: python -m benchmarks.scale [COUNT ...]

For archives of so many scans (by default 1,000 and 10,000), which are links to one of 104 pixels: processor time of
reading and checking a manifest, of reading the headers of all scans, as --check does, of hashing the files, of choosing
pairs, of the report page; the size of what is kept, and the most memory. The report and the picture of one small scan
stand for all. Before that, what one scan of a megapixel takes with 200 seeds, as a run of its own: processor time and
memory. What a pair of scan and photo takes is printed by benchmarks.archive.
"""

import argparse
import resource
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from benchmarks.rooms import Room
from benchmarks.run_apart import measured
from reflcolor_addon import Scan, Seeds
from reflcolor_addon.batch.archive.candidates import for_second_looks, ranks
from reflcolor_addon.batch.archive.check import check_manifest
from reflcolor_addon.batch.archive.check_files import check_files
from reflcolor_addon.batch.archive.fingerprints import Fingerprints
from reflcolor_addon.batch.archive.manifest_file import load_manifest
from reflcolor_addon.cli.main import main as command_line
from reflcolor_addon.files.writers import write_e57, write_ptx
from reflcolor_addon.report.archive import write_page

_PHOTOS = 100
# File systems allow a file only so many names.
_LINKS = 30_000
_HEAD = 'format = "reflcolor-batch"\nversion = 1\noutput = "colored"\nseeds = "seeds.json"\nscans = "*.ptx"\n'


def main():
    """Measure, and print a line for each step."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("counts", metavar="COUNT", nargs="*", type=int, default=[1000, 10_000])
    counts = parser.parse_args().counts
    _megapixel()
    for count in counts:
        with tempfile.TemporaryDirectory() as folder:
            print(f"{count:,} scans", flush=True)
            _measure(Path(folder), count)


def _megapixel():
    """What the cost of colorizing is made of, beside photos."""
    with tempfile.TemporaryDirectory() as name:
        folder, rng = Path(name), np.random.default_rng(0)
        azimuth, elevation = np.meshgrid(np.linspace(-2.5, 2.5, 1250), np.linspace(0.7, -0.7, 800))
        distance = 4 + np.sin(3 * azimuth) * np.cos(2 * elevation)
        level = distance * np.cos(elevation)
        points = np.stack([np.sin(azimuth) * level, np.cos(azimuth) * level, distance * np.sin(elevation)], axis=-1)
        strength = np.sin(40 * azimuth) * np.sin(30 * elevation) + rng.normal(0, 0.02, azimuth.shape)
        scan = Scan(name="wave", points=points, reflectance=strength, valid=np.ones(azimuth.shape, bool))
        write_e57(scan, folder / "wave.e57")
        rows, columns = (rng.integers(size, size=200) for size in scan.shape)
        Seeds(rows, columns, rng.integers(0, 256, (200, 3))).save(folder / "seeds.json")
        line = [
            sys.executable,
            "-m",
            "reflcolor_addon",
            "colorize",
            f"{name}/wave.e57",
            "--seeds",
            f"{name}/seeds.json",
        ]
        used = measured([*line, "-o", f"{name}/wave.png", "-o", f"{name}/wave.glb", "--report", f"{name}/wave.json"])
        sizes = ", ".join(f"{path.suffix} {path.stat().st_size / 1e6:.1f} MB" for path in sorted(folder.glob("wave.*")))
        print(f"1 megapixel, 200 seeds: {used['processor']:.1f} s of processor, {used['bytes'] / 1e6:.0f} MB; {sizes}")


def _measure(root, count):
    scan = Room(0).scan()
    rows, columns = (np.random.default_rng(0).integers(size, size=20) for size in scan.shape)
    Seeds(rows, columns, scan.color[rows, columns]).save(root / "seeds.json")
    write_ptx(scan, root / "scan.ptx")
    (root / "batch.toml").write_text(_HEAD)
    if command_line(["batch", str(root / "batch.toml"), "--jobs", "1"]):
        sys.exit("the small batch failed")
    report, picture = ((root / "colored" / "reports" / f"scan{end}").read_bytes() for end in (".json", ".jpg"))
    (root / "scan.ptx").unlink()
    for number in range(count):
        path = root / f"scan_{number:06d}.ptx"
        if number % _LINKS == 0:
            first = path
            write_ptx(Room(0).scan(8, 13, 6.0), path)
        else:
            path.hardlink_to(first)
        for data, end in ((report, ".json"), (picture, ".jpg")):
            (root / "colored" / "reports" / f"scan_{number:06d}{end}").write_bytes(data)
    manifest = _timed("reading the manifest", lambda: load_manifest(root / "batch.toml", sys.exit))
    _timed("checking it", lambda: check_manifest(manifest, None, sys.exit))
    quiet = {"decode": True, "progress": lambda *_: None}
    _timed("reading the headers of all scans", lambda: check_files(manifest, manifest.items, sys.exit, **quiet))
    hashes = Fingerprints(manifest.folder)
    _timed("hashing the files", lambda: [hashes.of(item.plan.scans[0]) for item in manifest.items])
    _timed("writing down the hashes", hashes.save)
    photos = [f"photo_{number}.jpg" for number in range(_PHOTOS)]
    scores = {item.name: dict(zip(photos, np.random.random(_PHOTOS).tolist(), strict=True)) for item in manifest.items}
    _timed(f"choosing pairs of {_PHOTOS} photos with all scans", lambda: for_second_looks(ranks(scores)))
    scores.clear()
    session = SimpleNamespace(progress=lambda *_: None, warnings=[])
    _timed("the report page", lambda: write_page(manifest.folder.root, session))
    for name in ("batch-state/hashes.json", "report.html", "report.csv"):
        print(f"  {name}: {(manifest.folder.root / name).stat().st_size / 1e6:.1f} MB")
    print(f"  a scan's report {len(report):,} bytes, its picture {len(picture):,} bytes")
    print(f"  most memory so far {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB", flush=True)


def _timed(what, act):
    start = time.process_time()
    found = act()
    print(f"  {what}: {time.process_time() - start:.2f} s", flush=True)
    return found


if __name__ == "__main__":
    main()
