"""The main job on the example that ships, as a user would give it to Blender; the results go to demo/."""

import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from reflcolor_addon import Seeds, Settings, colorize, read_scans  # noqa: E402
from reflcolor_addon.scan.normalization import normalize  # noqa: E402

EXAMPLE = ROOT / "examples" / "cones"
OUTPUT = ROOT / "demo"
GAP_PX = 12


def main() -> None:
    """Colorize the example through the installed zip, make the picture of before and after, say where all is."""
    OUTPUT.mkdir(exist_ok=True)
    results = [OUTPUT / f"cones.{suffix}" for suffix in ("blend", "glb", "png")]
    picture, report = OUTPUT / "cones_render.png", OUTPUT / "cones.json"
    scan = EXAMPLE / "cones.scan.json"
    command = ["colorize", scan, "--seeds", EXAMPLE / "cones.seeds.json", "--photo", EXAMPLE / "photo.jpg"]
    command += [part for result in results for part in ("-o", result)]
    command += ["--render", picture, "--report", report]
    print("demo: blender -b --command reflcolor", *(shown(part) for part in command), flush=True)

    started = time.monotonic()
    line = [sys.executable, ROOT / "tools" / "blender_command.py", "--", *command]
    # Blender and its exporters talk on stdout; what is wrong is said on stderr.
    with (OUTPUT / "blender.log").open("w") as log:
        done = subprocess.run([str(part) for part in line], stdout=log, check=False)
    if done.returncode:
        sys.exit(done.returncode)
    compared = OUTPUT / "cones_before_after.png"
    write_before_after(scan, OUTPUT / "cones.png", compared)

    print(f"demo: done in {time.monotonic() - started:.0f} s")
    for path, what in (
        (results[0], "the colorized mesh, to open in Blender"),
        (results[1], "the same for any viewer of glTF"),
        (results[2], "the colorized reflectance image"),
        (compared, "the reflectance, with the preset Paper, and as it comes"),
        (picture, "the mesh rendered"),
        (report, "sizes, settings, times, hashes"),
    ):
        print(f"  {shown(path):28} {what}")


def write_before_after(scan_path: Path, colorized: Path, target: Path) -> None:
    """Put the gray reflectance image, the colors of the preset Paper and the colorized image side by side."""
    scan = read_scans(scan_path)[0]
    gray, _ = normalize(scan.reflectance, scan.valid)
    before = cv2.cvtColor(np.rint(gray).astype(np.uint8), cv2.COLOR_GRAY2BGR)
    seeds = Seeds.load(EXAMPLE / "cones.seeds.json", [EXAMPLE / "photo.jpg"])
    paper = colorize(scan, seeds, Settings.preset("Paper")).rgb[..., ::-1]
    after = cv2.imread(str(colorized), cv2.IMREAD_COLOR)
    gap = np.full((before.shape[0], GAP_PX, 3), 255, np.uint8)
    cv2.imwrite(str(target), np.hstack([before, gap, paper, gap, after]))


def shown(path) -> str:
    """A path as seen from the project's folder."""
    return str(path.relative_to(ROOT)) if isinstance(path, Path) else path


if __name__ == "__main__":
    main()
