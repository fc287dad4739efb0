"""A real Blender with a window, for the tests: python tools/window_blender.py finds it and says which, or what to set.

BLENDER=/path/to/blender names one; it needs Xvfb, or an X display in DISPLAY, and scrot. Without it, the scripts of
REFLCOLOR_TOOLS (default ../shared/tools) make a root tree that holds a Blender, an X server and all else, where they
are there and this is root.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
from contextlib import nullcontext
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TOOLS = Path(os.environ.get("REFLCOLOR_TOOLS") or ROOT.parent / "shared" / "tools")

_ASK = "import sys, bpy; print('BLENDER-IS', bpy.app.version_string, '%d.%d' % sys.version_info[:2])"


class BlenderMissing(Exception):
    """There is no Blender with a window; the message says what to do."""


@dataclass(frozen=True)
class Blender:
    """A Blender, and how commands are run where it is.

    Attributes
    ----------
    program : str
        Its path, as seen from where it runs.
    tree : Path or None
        The root tree it lies in, or None where it is this machine's own.
    version, python : str
        Its own version and that of its Python, "3.14".
    """

    program: str
    tree: Path | None = None
    version: str = ""
    python: str = ""

    def command(self, arguments: list[str], folders: dict[Path, str], environment: dict[str, str]) -> list[str]:
        """Return the command line that runs ``arguments`` where this Blender is.

        Parameters
        ----------
        arguments : list of str
            Paths among them are written as ``seen()`` gives them.
        folders : dict
            Folder or file of this machine -> the path at which a root tree shows it.
        environment : dict
            Variables to set.
        """
        if self.tree is None:
            return ["env", *(f"{name}={value}" for name, value in environment.items()), *arguments]
        shown = [part for outer, inner in folders.items() for part in ("-b", f"{outer}:{inner}")]
        variables = [part for name, value in environment.items() for part in ("-e", f"{name}={value}")]
        return [str(TOOLS / "in-root.sh"), str(self.tree), *shown, *variables, "--", *arguments]

    def seen(self, path: Path, folders: dict[Path, str]) -> str:
        """Return a path of this machine as this Blender sees it."""
        if self.tree is None:
            return str(path)
        for outer, inner in folders.items():
            if path.is_relative_to(outer):
                return str(Path(inner) / path.relative_to(outer))
        raise ValueError(f"{path} is in no folder that the Blender sees")


@dataclass
class Ended:
    """How a process ended: its status, negative for a signal, and whether it had to be ended."""

    status: int
    timed_out: bool = False
    output: str = field(default="", repr=False)


def find_blender() -> Blender:
    """Return the Blender to test in; raise BlenderMissing with one line where there is none."""
    if named := os.environ.get("BLENDER"):
        program = shutil.which(named)
        if program is None:
            raise BlenderMissing(f"BLENDER={named} is no program")
        needed = [tool for tool in ("scrot",) if shutil.which(tool) is None]
        if shutil.which("Xvfb") is None and not os.environ.get("DISPLAY"):
            needed.append("xvfb")
        if needed:
            raise BlenderMissing(f"needs {' and '.join(needed)}: apt-get install {' '.join(needed)}")
        return _asked(Blender(program))
    if not (TOOLS / "get-blender.sh").is_file():
        raise BlenderMissing("set BLENDER=/path/to/blender, a Blender 5.1 or later that can open a window")
    tree = Path.home() / ".cache" / "blender-sid"
    done = subprocess.run(
        [str(TOOLS / "get-blender.sh"), "sid", str(tree)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise BlenderMissing(f"get-blender.sh failed: {(done.stderr or done.stdout).strip()[-400:]}")
    return _asked(Blender("blender", tree))


def run(line: list[str], limit_s: float, log: Path | None = None) -> Ended:
    """Run a command to its end, or for a time; then it is ended with all that it started.

    Its output goes to the file ``log``, or, where that is None, into what is returned.
    """
    with (
        log.open("wb") if log else nullcontext(subprocess.PIPE) as output_to,
        subprocess.Popen(
            line,
            stdin=subprocess.DEVNULL,
            stdout=output_to,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        ) as process,
    ):
        try:
            output, _ = process.communicate(timeout=limit_s)
            return Ended(process.returncode, output=(output or b"").decode(errors="replace"))
        except BaseException as error:
            os.killpg(process.pid, signal.SIGTERM)
            try:
                process.communicate(timeout=10)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
            if not isinstance(error, subprocess.TimeoutExpired):
                raise
            return Ended(-signal.SIGTERM, timed_out=True)


def _asked(blender: Blender) -> Blender:
    line = [blender.program, "-b", "--factory-startup", "--python-expr", _ASK]
    ended = run(blender.command(line, {}, {}), 60)
    answer = re.search(r"^BLENDER-IS (\S+).* (\d+\.\d+)$", ended.output, re.MULTILINE)
    if answer is None:
        raise BlenderMissing(f"{blender.program} does not start: {ended.output.strip()[-400:]}")
    return Blender(blender.program, blender.tree, *answer.groups())


def main() -> None:
    """Say which Blender it would be."""
    try:
        blender = find_blender()
    except BlenderMissing as missing:
        sys.exit(f"test-window: {missing}")
    where = f" in {blender.tree}" if blender.tree else ""
    print(f"test-window: Blender {blender.version}, Python {blender.python}: {blender.program}{where}", flush=True)


if __name__ == "__main__":
    main()
