"""A process that works for a batch: it is given one piece of work after another, and answers line by line.

Requests are lines of JSON on standard input, answers are lines on standard output that begin with `MARK`; any other
line there is somebody's who prints, and goes into the log. At the end of standard input the process ends, whatever it
is doing: its parent is gone, or has no more use for it.
"""

import json
import os
import sys
import threading
import time
from pathlib import Path

from ...errors import Cancelled, ReflcolorError, UsageError
from ...threads import limit_threads
from ..pipeline import run_plan
from ..plan_document import from_document
from ..session import Session
from .folder import BatchFolder
from .looks import look_at
from .matches import match_at
from .overlap_blocks import overlaps_at
from .passing import may_pass
from .registrations import Registrations

MARK = "\x1e"
_SHOW_EVERY_S = 0.2
# How long a file that is being written may take to be finished after the parent has ended.
_ENDS_WITHIN_S = 10


def serve(session, lines=None):
    """Do what standard input asks for until it ends.

    Parameters
    ----------
    session : Session
        Of the command line; tells what can be done in Blender, and when to end.
    lines : iterable of str, optional
        Read instead of standard input.
    """
    worker = _Worker(session)
    threading.Thread(target=worker.listen, args=(lines or sys.stdin,), daemon=True).start()
    while (request := worker.next()) is not None:
        worker.answer(_WORK[request["do"]](worker, request))


class _Worker:
    def __init__(self, session):
        self._outer = session
        self._requests, self._more = [], threading.Condition()
        self._ended = False
        self._shown_at, self._furthest = 0.0, 0.0

    def listen(self, lines):
        for line in lines:
            with self._more:
                self._requests.append(json.loads(line))
                self._more.notify()
        with self._more:
            self._ended = True
            self._more.notify()
        time.sleep(_ENDS_WITHIN_S)
        os._exit(1)

    def next(self):
        """The next request; None at the end."""
        while True:
            with self._more:
                if self._ended or self._outer.cancelled():
                    return None
                if self._requests:
                    return self._requests.pop(0)
                # A signal does not wake it.
                self._more.wait(0.1)

    def cancelled(self):
        return self._ended or self._outer.cancelled()

    def show(self, fraction, text):
        # Every file that is written begins at 0 again.
        self._furthest = max(self._furthest, fraction)
        if time.monotonic() - self._shown_at >= _SHOW_EVERY_S:
            self._shown_at = time.monotonic()
            self.answer({"progress": self._furthest, "text": str(text)})

    def answer(self, document):
        sys.stdout.write(f"{MARK}{json.dumps(document)}\n")
        sys.stdout.flush()

    def run(self, request):
        """Do one item of a batch."""
        lines, plan = [], from_document(request["plan"])
        session = self._session(request, plan, lines)
        outcome = self._outcome(lambda: run_plan(plan, session))
        photos = [
            {"scan": label, "path": str(path), "verified": photo.verified, "tested": photo.tested}
            | {"evidence": round(photo.evidence, 3), "note": str(photo.note)}
            for label, matching in session.matchings.items()
            for path, photo in zip(plan.photos, matching.photos, strict=True)
        ]
        return outcome | {
            "photos": photos,
            "lines": lines,
            "warnings": [str(warning) for warning in session.warnings],
            "left_out": session.left_out,
            "written": [str(path) for path in session.written],
        }

    def match(self, request):
        """Match photos with the scans of an item."""
        lines, plan, found = [], from_document(request["plan"]), {}
        session = self._session(request, plan, lines)
        outcome = self._outcome(lambda: found.update(match_at(plan, session, request["names"], request["helpers"])))
        pairs = max(1, sum(map(len, found.get("pairs", {}).values())))
        return outcome | {"found": found | {"worked": 1 - min(session.registrations.recalled / pairs, 1.0)}}

    def _session(self, request, plan, lines):
        limit_threads(request["threads"])
        return Session(
            say=lambda line: lines.append(str(line)),
            show=self.show,
            cancelled=self.cancelled,
            blender=self._outer.blender,
            registrations=Registrations(
                BatchFolder(Path(request["folder"])), request["hashes"], plan.reading, request.get("placed_by")
            ),
        )

    def look(self, request):
        """Take a first look at what photos may show a scan."""
        return self._found(look_at, request)

    def overlap(self, request):
        """Find out which photos overlap."""
        return self._found(overlaps_at, request)

    def _found(self, find, request):
        limit_threads(request["threads"])
        found = {}

        def act():
            found.update(find(request, progress=self.show, cancelled=self.cancelled))

        return self._outcome(act) | {"found": found}

    def _outcome(self, act):
        self._furthest = 0.0
        start = time.perf_counter()
        try:
            act()
            outcome = {"done": True}
        except Cancelled:
            outcome = {"done": False, "cancelled": True, "error": "interrupted"}
        except (ReflcolorError, UsageError) as error:
            outcome = {"done": False, "error": str(error), "may_pass": may_pass(error)}
        except MemoryError:
            outcome = {"done": False, "error": "not enough memory"}
        return outcome | {"seconds": round(time.perf_counter() - start, 3), "peak_bytes": _peak_bytes()}


_WORK = {"run": _Worker.run, "look": _Worker.look, "overlap": _Worker.overlap, "match": _Worker.match}


def _peak_bytes():
    """The peak memory of this process; None where the system does not report it."""
    try:
        import resource
    except ImportError:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
