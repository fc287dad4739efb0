"""The processes that work for a batch, from their parent's side: started, given work, watched, and ended."""

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from dataclasses import dataclass, replace
from pathlib import Path

from ...errors import Cancelled, ReflcolorError
from ...files.confined.python_program import python_program
from .worker import MARK

_LOOK_EVERY_S = 0.1
_ENDS_WITHIN_S = 15
# Libraries start threads of their own; how many is set before they are loaded.
_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True, eq=False, kw_only=True)
class Task:
    """A piece of work for a worker.

    Parameters
    ----------
    name : str
    request : dict
        What `worker.serve` understands.
    needs_blender : bool
        Whether only a worker inside Blender can do it.
    memory : int
        Bytes that it will take at most, as far as can be known.
    cost : float
        Seconds of one processor that it probably takes.
    log : Path
        Where the worker's other lines go.
    not_before : float
        When it may begin, as `time.monotonic` counts.
    alone : bool
        Whether nothing else may run meanwhile.
    """

    name: str
    request: dict
    needs_blender: bool = False
    memory: int = 0
    cost: float = 1.0
    log: Path | None = None
    not_before: float = 0.0
    alone: bool = False

    def again(self, wait_s, alone=False):
        """Return the same task for another try after so many seconds."""
        return replace(self, not_before=time.monotonic() + wait_s, alone=alone)


@dataclass(eq=False)
class _Process:
    """One worker."""

    process: subprocess.Popen
    in_blender: bool
    task: Task | None = None
    progress: tuple[float, str] = (0.0, "")
    log: object = None
    listener: threading.Thread | None = None

    def end_log(self):
        """Close the log; one that nothing was written to is removed."""
        if self.log is not None:
            log, self.log = self.log, None
            with contextlib.suppress(OSError):
                log.close()
                if Path(log.name).stat().st_size == 0:
                    Path(log.name).unlink()


class Workers:
    """Some workers; a context manager that ends them.

    Parameters
    ----------
    count : int
        How many there are at most.
    threads : int
        How many threads each may use.
    memory : int
        Bytes that all together may take; a task that needs more than that runs alone.
    blender : tuple of str or None
        The command that starts a worker inside Blender.
    cancelled : callable
    """

    def __init__(self, *, count, threads, memory, blender, cancelled):
        self._count, self._threads, self._memory = count, threads, memory
        self._blender, self._cancelled = blender, cancelled
        self._processes, self._answers = [], queue.SimpleQueue()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for worker in self._processes:
            with contextlib.suppress(OSError):
                worker.process.stdin.close()
            worker.process.terminate()
        end = time.monotonic() + _ENDS_WITHIN_S
        for worker in self._processes:
            try:
                worker.process.wait(max(0.1, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                worker.process.kill()
                worker.process.wait()
            # A process started by the worker may keep its output open.
            worker.listener.join(1.0)
            worker.end_log()
        self._processes.clear()

    def work(self, tasks, finished, progress, begin=lambda task: True):
        """Do tasks, as many at once as workers and memory allow.

        Parameters
        ----------
        tasks : list of Task
            In their order; ``finished`` may add more at the end.
        finished : callable
            Called as ``finished(task, outcome)``; the outcome is what the worker answered, or a failure that may pass
            where it died. True ends the work: what runs is finished, nothing more is started.
        progress : callable
            Called several times a second with a list of (task, fraction, text) of what runs.
        begin : callable
            Called as ``begin(task)`` before a task is given to a worker; False drops it.

        Raises
        ------
        Cancelled
            If ``cancelled()`` returned True.
        ReflcolorError
            If no worker can be started.
        """
        stopping = False
        while True:
            if self._cancelled():
                raise Cancelled
            if not stopping:
                self._start(tasks, begin)
            running = [worker for worker in self._processes if worker.task is not None]
            if not running and (stopping or not tasks):
                return
            progress([(worker.task, *worker.progress) for worker in running])
            with contextlib.suppress(queue.Empty):
                worker, answer = self._answers.get(timeout=_LOOK_EVERY_S)
                outcome = self._outcome(worker, answer)
                if outcome is not None:
                    task, worker.task = worker.task, None
                    worker.end_log()
                    stopping = bool(finished(task, outcome)) or stopping

    def _outcome(self, worker, answer):
        """What became of a worker's task; None while it goes on."""
        if answer is None:
            status = worker.process.wait()
            self._processes.remove(worker)
            with contextlib.suppress(OSError):
                worker.process.stdin.close()
            if worker.task is None:
                return None
            # A system that is short of memory kills what takes most of it: the next time it has all to itself.
            return {"done": False, "error": f"its process ended ({_ending(status)})", "may_pass": True, "alone": True}
        if worker.task is None:
            return None
        if "progress" in answer:
            worker.progress = answer["progress"], answer["text"]
            return None
        return answer

    def _start(self, tasks, begin):
        """Give tasks to workers that have none."""
        while tasks:
            running = [worker.task for worker in self._processes if worker.task is not None]
            task = self._next(tasks, running)
            if len(running) >= self._count or task is None:
                return
            tasks.remove(task)
            if begin(task):
                self._give(self._idle(task.needs_blender), task)

    def _next(self, tasks, running):
        """The first task that may begin beside those that run; None where there is none."""
        now, used = time.monotonic(), sum(task.memory for task in running)
        due = (task for task in tasks if task.not_before <= now)
        if not running:
            return next(due, None)
        if any(task.alone for task in running):
            return None
        return next((task for task in due if not task.alone and used + task.memory <= self._memory), None)

    def _idle(self, in_blender):
        # A worker whose input is closed is about to end, which is noticed like the end of any other.
        staying = [worker for worker in self._processes if not worker.process.stdin.closed]
        idle = [worker for worker in staying if worker.task is None]
        for worker in idle:
            if worker.in_blender == in_blender:
                return worker
        if len(staying) >= self._count:
            idle[0].process.stdin.close()
        return self._started(in_blender)

    def _started(self, in_blender):
        environment = os.environ | dict.fromkeys(_THREAD_VARIABLES, str(self._threads))
        if in_blender:
            command, first = [*self._blender, "work"], None
        else:
            program = python_program()
            if program is None:
                raise ReflcolorError("no Python was found to start a worker with; run the batch inside Blender")
            command = [str(program), "-B", str(Path(__file__).with_name("start_worker.py"))]
            first = {"path": [str(Path(__file__).resolve().parents[3]), *_module_folders()]}
            environment |= {"PYTHONSAFEPATH": "1"}
        options = {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {}
        if sys.platform != "win32":
            # In a group of its own, Ctrl-C reaches only the parent, which ends it.
            options = {"start_new_session": True}
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
        text = {"encoding": "utf-8", "errors": "backslashreplace"}
        try:
            process = subprocess.Popen(command, env=environment, **pipes, **text, **options)
        except OSError as error:
            raise ReflcolorError(
                "{file}: cannot be started ({reason})", file=command[0], reason=error.strerror
            ) from error
        worker = _Process(process, in_blender)
        self._processes.append(worker)
        if first is not None:
            self._send(worker, first)
        worker.listener = threading.Thread(target=self._listen, args=(worker,), name="reflcolor worker", daemon=True)
        worker.listener.start()
        return worker

    def _listen(self, worker):
        with worker.process.stdout as lines:
            for line in lines:
                if line.startswith(MARK):
                    with contextlib.suppress(ValueError):
                        self._answers.put((worker, json.loads(line[1:])))
                        continue
                # The log may be closed meanwhile.
                if (log := worker.log) is not None:
                    with contextlib.suppress(OSError, ValueError):
                        log.write(line)
        self._answers.put((worker, None))

    def _give(self, worker, task):
        worker.task, worker.progress = task, (0.0, "")
        if task.log is not None:
            with contextlib.suppress(OSError):
                worker.log = task.log.open("w", encoding="utf-8", errors="backslashreplace")
        self._send(worker, task.request | {"threads": self._threads})

    def _send(self, worker, document):
        # If the worker has ended, the end of its output shows that.
        with contextlib.suppress(OSError):
            worker.process.stdin.write(json.dumps(document) + "\n")
            worker.process.stdin.flush()


def _module_folders():
    """Where a worker finds its modules: where they are found here, but for Blender's own."""
    return [path for path in sys.path if path and "scripts" not in Path(path).parts]


def _ending(status):
    if status >= 0:
        return f"exit status {status}"
    try:
        return signal.Signals(-status).name
    except ValueError:
        return f"signal {-status}"
