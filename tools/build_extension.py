"""Builds the extension's zip: python tools/build_extension.py [--platform NAME]... [--python VERSION]...

For every platform one zip in dist/, with the wheels of all the Pythons asked for: by default this machine's platform
and the running Python, the quick build that the tests install; `--python all` makes the zip to hand out. The wheels are
those that requirements/wheels.txt pins by hash (kept in build/wheels/), trimmed by tools/trim_wheels.py (kept in
build/trimmed/), and the geodesic kernel's from build/kernel-wheels/. Blender's own builder packs and validates; the
zip's bytes depend on the sources alone. A zip above its budget is an error.
"""

import argparse
import hashlib
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from dataclasses import dataclass
from pathlib import Path

import trim_wheels
from blender_cli import blender_ext

ROOT = Path(__file__).resolve().parent.parent
MANIFEST = ROOT / "blender_manifest.toml"
PINS = ROOT / "requirements" / "wheels.txt"
WHEELS = ROOT / "build" / "wheels"
TRIMMED = ROOT / "build" / "trimmed"
KERNEL_WHEELS = ROOT / "build" / "kernel-wheels"
STAGES = ROOT / "build" / "stage"
DIST = ROOT / "dist"

# Blender 4.5 and 5.0 run Python 3.11, from 5.1 on 3.13; Debian builds Blender 5.2 with its own 3.14.
PYTHONS = ("3.11", "3.13", "3.14")
# The most that a zip may weigh, in MB (10^6 bytes), by how many Pythons it is for.
BUDGETS = {1: 100, 2: 140, 3: 175}


@dataclass(frozen=True)
class Platform:
    """What fits a platform: tags of wheels, best first, the tag of the kernel's, and the packages without a wheel."""

    tags: tuple[str, ...]
    kernel: str
    without: tuple[str, ...] = ()


# Blender itself is not released for linux-arm64, but distributions build it. Where pye57 is missing the extension does
# all but read E57.
PLATFORMS = {
    "linux-x64": Platform(tuple(f"manylinux_2_{n}_x86_64" for n in range(28, 16, -1)), "manylinux_2_17_x86_64"),
    "linux-arm64": Platform(
        tuple(f"manylinux_2_{n}_aarch64" for n in range(28, 16, -1)),
        "manylinux_2_17_aarch64",
        without=("pye57", "pyquaternion"),
    ),
    "windows-x64": Platform(("win_amd64",), "win_amd64"),
    "macos-arm64": Platform(tuple(f"macosx_{n}_0_arm64" for n in (13, 12, 11)), "macosx_11_0_arm64"),
    "macos-x64": Platform(
        (*(f"macosx_{n}_0_x86_64" for n in (14, 13, 12, 11)), *(f"macosx_10_{n}_x86_64" for n in range(16, 8, -1))),
        "macosx_11_0_x86_64",
        without=("pye57", "pyquaternion"),
    ),
}
UNAVAILABLE = {"windows-arm64": "OpenCV has no wheel for it"}


class BuildError(Exception):
    """The zip cannot be made; the message says what to do."""


def main() -> None:
    """Build what the command line asks for and print where each zip is."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--platform", action="append", metavar="NAME", help=f"all, or {', '.join(PLATFORMS)}")
    parser.add_argument("--python", action="append", choices=[*PYTHONS, "all"])
    parser.add_argument("--unpack", action="store_true", help="the trimmed wheels into a folder, for tests; prints it")
    args = parser.parse_args()
    if args.unpack:
        print(unpacked())
        return
    platforms = tuple(PLATFORMS) if "all" in (args.platform or ()) else tuple(args.platform or (host_platform(),))
    pythons = PYTHONS if "all" in (args.python or ()) else tuple(args.python or (running_python(),))
    try:
        for name in platforms:
            zip_file = build(name, pythons)
            size = zip_file.stat().st_size / 1e6
            print(f"{zip_file.relative_to(ROOT)}: {size:.0f} MB, sha256 {sha256(zip_file)}")
            if PLATFORMS[name].without:
                print(f"  without {' and '.join(PLATFORMS[name].without)} (no wheels): cannot read E57 there")
    except BuildError as error:
        sys.exit(f"build: {error}")


def host_platform() -> str:
    """Blender's name for the platform this runs on."""
    machine = platform.machine().lower()
    system = {"darwin": "macos"}.get(platform.system().lower(), platform.system().lower())
    return f"{system}-{ {'x86_64': 'x64', 'amd64': 'x64', 'aarch64': 'arm64'}.get(machine, machine) }"


def running_python() -> str:
    """The running Python as "3.13"."""
    return f"{sys.version_info.major}.{sys.version_info.minor}"


def zip_path(platform_name: str, pythons: tuple[str, ...]) -> Path:
    """Where the zip for a platform and a choice of Pythons belongs; the name tells both."""
    manifest = tomllib.loads(MANIFEST.read_text(encoding="utf-8"))
    parts = [manifest["id"], manifest["version"], platform_name.replace("-", "_")]
    if set(pythons) != set(PYTHONS):
        parts += [f"cp{version.replace('.', '')}" for version in pythons]
    return DIST / f"{'-'.join(parts)}.zip"


def build(platform_name: str, pythons: tuple[str, ...]) -> Path:
    """Stage the sources and the wheels, have Blender's builder pack and validate them, and give the zip's path."""
    if platform_name not in PLATFORMS:
        reason = UNAVAILABLE.get(platform_name, "Blender has no such platform")
        raise BuildError(f"no zip for {platform_name}: {reason}; there are {', '.join(PLATFORMS)}")
    output = zip_path(platform_name, pythons)
    pinned = {wheel.name: wheel for version in pythons for wheel in pinned_wheels(platform_name, version)}
    wheels = sorted(trimmed_wheel(wheel) for wheel in pinned.values()) + kernel_wheels(platform_name)
    stage = STAGES / output.stem
    shutil.rmtree(stage, ignore_errors=True)
    (stage / "wheels").mkdir(parents=True)
    for wheel in wheels:
        link_or_copy(wheel, stage / "wheels" / wheel.name)
    stage_sources(stage)
    names = sorted(f"./wheels/{wheel.name}" for wheel in wheels)
    (stage / MANIFEST.name).write_text(staged_manifest(platform_name, names), encoding="utf-8", newline="\n")

    output.parent.mkdir(exist_ok=True)
    packed = stage.with_suffix(".zip")
    blender_ext("build", "--source-dir", stage, "--output-filepath", packed)
    write_reproducibly(packed, output)
    packed.unlink()
    shutil.rmtree(stage)
    blender_ext("validate", output)
    require_budget(output, len(pythons))
    return output


def require_budget(zip_file: Path, pythons: int) -> None:
    """Raise a BuildError where a zip is heavier than it may be, and take it away."""
    size, most = zip_file.stat().st_size / 1e6, BUDGETS[pythons]
    if size > most:
        zip_file.unlink()
        raise BuildError(f"{zip_file.name} would be {size:.1f} MB, above its budget of {most} MB (BUDGETS)")


def trimmed_wheel(wheel: Path) -> Path:
    """The trimmed copy of a pinned wheel, kept until the wheel or the trimming changes."""
    rules = hashlib.sha256(Path(trim_wheels.__file__).read_bytes() + sha256(wheel).encode()).hexdigest()[:16]
    kept = TRIMMED / rules / trim_wheels.trimmed_name(wheel.name)
    return kept if kept.is_file() else trim_wheels.trim_wheel(wheel, kept.parent)


def stage_sources(stage: Path) -> None:
    """Copy the entries that the manifest lets in; what is left out below them is the builder's to decide.

    Of a folder with entries of its own, such as the examples, those are copied alone.
    """
    patterns = tomllib.loads(MANIFEST.read_text(encoding="utf-8"))["build"]["paths_exclude_pattern"]
    names = [pattern.removeprefix("!/").rstrip("/") for pattern in patterns if pattern.startswith("!/")]
    for name in names:
        source, target = ROOT / name, stage / name
        if name == "wheels" or any(other.startswith(f"{name}/") for other in names):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
        elif source.is_file():
            shutil.copyfile(source, target)


def staged_manifest(platform_name: str, wheels: list[str]) -> str:
    """The manifest's text with the platform and the wheels of one zip in it, before the first table."""
    text = MANIFEST.read_text(encoding="utf-8")
    head, tables = re.split(r"^(?=\[)", text, maxsplit=1, flags=re.MULTILINE)
    lines = "".join(f"  {json.dumps(wheel)},\n" for wheel in wheels)
    return f'{head}platforms = ["{platform_name}"]\nwheels = [\n{lines}]\n\n{tables}'


def pinned_wheels(platform_name: str, python: str) -> list[Path]:
    """The wheels of requirements/wheels.txt for one platform and one Python, downloaded if need be."""
    pins = read_pins()
    target = PLATFORMS[platform_name]
    names = [name for name in pins if name not in target.without]
    folder = WHEELS / f"{platform_name}-cp{python.replace('.', '')}"
    folder.mkdir(parents=True, exist_ok=True)

    wheels = matching_wheels(folder, names, pins)
    if wheels is None:
        shutil.rmtree(folder)
        folder.mkdir()
        requirements = folder / "requirements.txt"
        requirements.write_text("".join(pins[name] for name in names), encoding="utf-8")
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
        command += ["--require-hashes", "--only-binary=:all:", "--python-version", python, "--implementation", "cp"]
        command += [part for tag in target.tags for part in ("--platform", tag)]
        command += ["--dest", str(folder), "--requirement", str(requirements)]
        if subprocess.run(command, check=False).returncode:
            raise BuildError(f"could not download the wheels for {platform_name}, Python {python}")
        wheels = matching_wheels(folder, names, pins)
        if wheels is None:
            raise BuildError(f"{folder} does not hold one pinned wheel of each of {', '.join(names)}")
    return wheels


def matching_wheels(folder: Path, names: list[str], pins: dict[str, str]) -> list[Path] | None:
    """One wheel per name whose hash is pinned, or None where the folder holds anything else."""
    wheels = sorted(folder.glob("*.whl"))
    found = {wheel.name.split("-")[0].lower().replace("_", "-"): wheel for wheel in wheels}
    if len(wheels) != len(names) or set(found) != set(names):
        return None
    if any(f"sha256:{sha256(wheel)}" not in pins[name] for name, wheel in found.items()):
        return None
    return wheels


def read_pins() -> dict[str, str]:
    """Each package of requirements/wheels.txt with its lines: the version and the hashes of its files."""
    blocks = re.split(r"^(?=[A-Za-z0-9])", PINS.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {block.split("==")[0]: block for block in blocks if "==" in block}


def kernel_wheels(platform_name: str) -> list[Path]:
    """The geodesic kernel's wheel for a platform."""
    wheels = sorted(KERNEL_WHEELS.glob(f"*-py3-none-{PLATFORMS[platform_name].kernel}.whl"))
    if len(wheels) != 1:
        raise BuildError(
            f"{KERNEL_WHEELS.relative_to(ROOT)} holds {len(wheels)} kernel wheels for {platform_name}, expected one:"
            " make kernel builds this machine's, make dist-all all"
        )
    return wheels


def unpacked() -> Path:
    """A folder with the packages of this machine's trimmed wheels, made anew where the wheels have changed."""
    wheels = [trimmed_wheel(wheel) for wheel in pinned_wheels(host_platform(), running_python())]
    folder = TRIMMED / f"cp{running_python().replace('.', '')}"
    stamp = folder / "wheels.txt"
    names = "\n".join(str(wheel.relative_to(TRIMMED)) for wheel in wheels)
    if not stamp.is_file() or stamp.read_text(encoding="utf-8") != names:
        shutil.rmtree(folder, ignore_errors=True)
        for wheel in wheels:
            with zipfile.ZipFile(wheel) as archive:
                archive.extractall(folder)
        stamp.write_text(names, encoding="utf-8")
    return folder


def link_or_copy(source: Path, target: Path) -> None:
    """Put a file at a second place, without a second copy where the file system allows it."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)


def write_reproducibly(source: Path, target: Path) -> None:
    """Rewrite a zip so that its bytes depend on its content alone: sorted, undated, and compressed by libdeflate."""
    with zipfile.ZipFile(source) as old:
        files = {name: old.read(name) for name in sorted(old.namelist())}
    temporary = target.with_suffix(".part")
    trim_wheels.write_zip(files, temporary)
    temporary.replace(target)


def sha256(path: Path) -> str:
    """The SHA-256 of a file's content, in hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


if __name__ == "__main__":
    main()
