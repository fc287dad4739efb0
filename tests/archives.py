"""A small archive of scans with seeds and a manifest, for tests of batches."""

import json
from pathlib import Path

from small_scans import random_scan

from reflcolor_addon import Seeds
from reflcolor_addon.files.writers import write_ptx

HEAD = 'format = "reflcolor-batch"\nversion = 1\noutput = "colored"\n'


def make_archive(folder, count=3, shape=(12, 16)):
    """Write ``count`` scans with seeds, and the manifest batch.toml that names them; return its path."""
    tables = []
    for number in range(count):
        write_ptx(random_scan(shape=shape, seed=number), folder / f"hall_{number}.ptx")
        seeds = Seeds([1, 8], [2, 13], [[200, 80, 40 + number], [20, 80, 220]])
        seeds.save(folder / f"hall_{number}.seeds.json")
        tables.append(f'[[scan]]\nfile = "hall_{number}.ptx"\nseeds = "hall_{number}.seeds.json"\n')
    path = folder / "batch.toml"
    path.write_text(HEAD + 'write = ["png", "ply"]\n' + "\n".join(tables), encoding="utf-8")
    return path


def outputs_of(folder):
    """The bytes of everything that a batch made for its user, by path; reports without their times."""
    found = {}
    for path in sorted(folder.rglob("*")):
        parts = path.relative_to(folder).parts
        if path.is_dir() or parts[0] in ("batch-state", "logs") or path.suffix in (".html", ".csv"):
            continue
        found["/".join(parts)] = _timeless(path) if path.suffix == ".json" else path.read_bytes()
    return found


def _timeless(path):
    report = json.loads(Path(path).read_text(encoding="utf-8"))
    return {key: value for key, value in report.items() if key not in ("times_s", "created")}
