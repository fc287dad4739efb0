"""Build the geodesic kernel with ``python -m ziglang cc`` and pack it into wheels.

    python kernel/build.py --host [DIRECTORY]     only for the machine it runs on
    python kernel/build.py [DIRECTORY]            for all six platforms; into build/kernel-wheels/ by default

One wheel per platform, ``reflcolor_kernel-VERSION-py3-none-PLATFORM.whl``: the library and a module that says where it
is. The same sources and the same compiler give the same bytes.
"""

import argparse
import base64
import hashlib
import platform
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

HERE = Path(__file__).parent
WHEELS = HERE.parent / "build" / "kernel-wheels"
VERSION = "1.1.0"

# Wheel platform: compiler target and file name of the library.
TARGETS = {
    "manylinux_2_17_x86_64": ("x86_64-linux-gnu.2.17", "libreflcolor_kernel.so"),
    "manylinux_2_17_aarch64": ("aarch64-linux-gnu.2.17", "libreflcolor_kernel.so"),
    "win_amd64": ("x86_64-windows-gnu", "reflcolor_kernel.dll"),
    "win_arm64": ("aarch64-windows-gnu", "reflcolor_kernel.dll"),
    "macosx_11_0_x86_64": ("x86_64-macos.11.0", "libreflcolor_kernel.dylib"),
    "macosx_11_0_arm64": ("aarch64-macos.11.0", "libreflcolor_kernel.dylib"),
}

# No contraction of a * b + c: it would round differently where the processor has such an instruction. No x86
# instructions beyond the base set, which every 64-bit processor has, but where src/wide.h looks up what there is.
# Nobody asks for errno, which would keep square roots from being taken several at once.
FLAGS = ["-std=c11", "-O2", "-ffp-contract=off", "-fno-math-errno", "-fno-sanitize=all", "-fvisibility=hidden"]
FLAGS += ["-shared", "-s", "-g0"]
_EPOCH = (1980, 1, 1, 0, 0, 0)


def sources():
    """Every C file of the kernel, in a fixed order."""
    return sorted((HERE / "src").glob("*.c"))


def host_platform():
    """Wheel platform of the machine this runs on."""
    machine = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "arm64", "aarch64": "arm64"}.get(
        platform.machine().lower()
    )
    names = {
        ("linux", "x86_64"): "manylinux_2_17_x86_64",
        ("linux", "arm64"): "manylinux_2_17_aarch64",
        ("win32", "x86_64"): "win_amd64",
        ("win32", "arm64"): "win_arm64",
        ("darwin", "x86_64"): "macosx_11_0_x86_64",
        ("darwin", "arm64"): "macosx_11_0_arm64",
    }
    try:
        return names[sys.platform, machine]
    except KeyError:
        raise SystemExit(f"no kernel for {sys.platform} {platform.machine()}; built for {', '.join(TARGETS)}") from None


def compile_library(wheel_platform, library):
    """Compile the kernel for one platform into the file ``library``."""
    target, _ = TARGETS[wheel_platform]
    # Relative names, and none of them absolute: the compiler writes what it is given into the library.
    command = [sys.executable, "-m", "ziglang", "cc", "-target", target, *FLAGS]
    command += ["-o", str(library), *(source.name for source in sources())]
    done = subprocess.run(command, cwd=HERE / "src", capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{wheel_platform}: the compiler failed\n{done.stderr.strip()}")


def module_source(wheel_platform):
    """The text of the module that says where the library is."""
    module = (HERE / "reflcolor_kernel" / "__init__.py").read_text("utf-8")
    return module.replace("@VERSION@", VERSION).replace("@LIBRARY@", TARGETS[wheel_platform][1])


def pack_wheel(wheel_platform, library_bytes, directory):
    """Write one wheel and return its path; the bytes depend on nothing but the arguments."""
    _, library_name = TARGETS[wheel_platform]
    info = f"reflcolor_kernel-{VERSION}.dist-info"
    files = {
        "reflcolor_kernel/__init__.py": module_source(wheel_platform).encode(),
        f"reflcolor_kernel/{library_name}": library_bytes,
        f"{info}/METADATA": (
            f"Metadata-Version: 2.1\nName: reflcolor_kernel\nVersion: {VERSION}\n"
            "Summary: Native geodesic kernel of the reflcolor extension\nLicense: GPL-3.0-or-later\n"
        ).encode(),
        f"{info}/WHEEL": (
            f"Wheel-Version: 1.0\nGenerator: reflcolor\nRoot-Is-Purelib: false\nTag: py3-none-{wheel_platform}\n"
        ).encode(),
    }
    record = "".join(
        f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}\n"
        for name, data in files.items()
    )
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    path = Path(directory) / f"reflcolor_kernel-{VERSION}-py3-none-{wheel_platform}.whl"
    unfinished = path.with_suffix(".unfinished")
    with zipfile.ZipFile(unfinished, "w") as wheel:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = 0o644 << 16
            wheel.writestr(entry, data, compresslevel=9)
    return unfinished.replace(path)


def build_wheel(wheel_platform, directory):
    """Compile and pack for one platform; returns the wheel's path."""
    with tempfile.TemporaryDirectory() as scratch:
        library = Path(scratch) / TARGETS[wheel_platform][1]
        compile_library(wheel_platform, library)
        return pack_wheel(wheel_platform, library.read_bytes(), directory)


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Build the geodesic kernel's wheels.")
    parser.add_argument("directory", type=Path, nargs="?", default=WHEELS, help="where the wheels go")
    parser.add_argument("--host", action="store_true", help="only the wheel of this machine")
    options = parser.parse_args(arguments)
    options.directory.mkdir(parents=True, exist_ok=True)
    for wheel_platform in [host_platform()] if options.host else TARGETS:
        path = build_wheel(wheel_platform, options.directory)
        print(f"{path.name}  {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
