"""A command run as a process of its own: what it takes, with all the processes that it starts. Linux only."""

import os
import subprocess
import threading
import time
from pathlib import Path

_EVERY_S = 0.02
_PAGE = os.sysconf("SC_PAGE_SIZE")


def measured(command):
    """Run a command to its end.

    Returns
    -------
    dict
        ``seconds`` by the clock; ``processor``: seconds of the processor; ``bytes``: the most that its processes held
        at once, looked at every 20 ms, and no less than the largest of them held at its own peak.

    Raises
    ------
    SystemExit
        With what the command printed, if it fails.
    """
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    peak, text = [0], []
    reader = threading.Thread(target=lambda: text.append(process.stdout.read()))
    watcher = threading.Thread(target=_watch, args=(process.pid, peak))
    reader.start()
    watcher.start()
    _, status, used = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    reader.join()
    watcher.join()
    if process.returncode:
        raise SystemExit(f"{' '.join(command)}: status {process.returncode}\n{text[0].decode(errors='replace')}")
    return {
        "seconds": seconds,
        "processor": used.ru_utime + used.ru_stime,
        "bytes": max(peak[0], used.ru_maxrss * 1024),
    }


def _watch(pid, peak):
    while held := _held(pid):
        peak[0] = max(peak[0], held)
        time.sleep(_EVERY_S)


def _held(pid):
    """Bytes of a process and all below it; 0 when it is gone."""
    try:
        held = int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * _PAGE
        children = [list(map(int, each.read_text().split())) for each in Path(f"/proc/{pid}/task").glob("*/children")]
    except (OSError, IndexError):
        return 0
    return held + sum(_held(child) for group in children for child in group)
