"""Long work of operators: blocking in scripts and in background, with progress and ESC in the window."""

import threading
import time
from inspect import isgenerator

import bpy
from bpy.app.handlers import persistent

from ...reflcolor_addon.errors import Cancelled
from ...reflcolor_addon.threads import letting_others_run
from ..scene.editors import redraw_editors, redraw_sidebars
from ..scene.reports import reported
from ..scene.steps import complete
from ..scene.texts import label, report_text, shown

# Seconds between two updates of a job.
_INTERVAL_S = 0.1
# Seconds between two steps of writing a result, and how long one goes on before events have their turn.
_WRITING_INTERVAL_S, _WRITING_S = 0.01, 0.005
_running = []


def running():
    """Return the job that runs in the window, or None."""
    return _running[-1] if _running else None


def unregister():
    """End the running job and wait for it; called before the extension is unregistered."""
    for job in _running:
        job.cancel(wait=True)
    _running.clear()


class Job:
    """One piece of long work in the window.

    Parameters
    ----------
    name : str
        What it does, for the status bar.

    Attributes
    ----------
    fraction : float
    text : str
        How far it is.
    result : object
    error : BaseException or None
        What came of it, when it is no longer ``alive``.
    overtaken : bool
        Whether something was undone since its result began to be written.
    """

    def __init__(self, name):
        self.name = name
        self.fraction, self.text = 0.0, ""
        self.result = self.error = None
        self.overtaken = False

    def advance(self):
        """Called by the window now and then, until the job is no longer alive."""


class ThreadJob(Job):
    """Work in a thread of its own; it touches no bpy.

    Parameters
    ----------
    work : callable
        Called as ``work(progress, cancelled)``.
    """

    def __init__(self, name, work):
        super().__init__(name)
        self._work = work
        self._cancel = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"reflcolor {name}", daemon=True)

    @staticmethod
    def complete(work):
        """Do all of the work now and return its result."""
        return work(None, None)

    def _run(self):
        try:
            with letting_others_run():
                self.result = self._work(self._progress, self._cancel.is_set)
        except BaseException as error:  # every exception goes to the window's thread, which raises it
            self.error = error

    def _progress(self, fraction, text):
        self.fraction, self.text = fraction, text

    def advance(self):
        """Start the thread; by now the window has been drawn, which takes long while all processors work."""
        if not self._started:
            self._thread.start()

    @property
    def _started(self):
        return self._thread.ident is not None

    @property
    def alive(self):
        """Whether the work still goes on, or is yet to begin."""
        return not self._started or self._thread.is_alive()

    @property
    def stopping(self):
        """Whether it was asked to end."""
        return self._cancel.is_set()

    def cancel(self, *, wait=False):
        """Ask the work to end; with ``wait``, return when it has."""
        self._cancel.set()
        if wait and self._started:
            self._thread.join()


class StepJob(Job):
    """Work that needs Blender itself, done step by step between the window's events.

    Parameters
    ----------
    steps : generator
        Yields (fraction, text) before each step; what it returns is the result.
    """

    def __init__(self, name, steps):
        super().__init__(name)
        self._steps = steps
        self.alive, self.stopping = True, False

    @staticmethod
    def complete(steps):
        """Do all of the work now and return its result."""
        while True:
            try:
                next(steps)
            except StopIteration as end:
                return end.value

    def advance(self):
        """Do one step, and more as long as they are short."""
        end = time.monotonic() + _INTERVAL_S
        try:
            while True:
                self.fraction, self.text = next(self._steps)
                if time.monotonic() >= end:
                    return
        except StopIteration as stop:
            self.alive, self.result = False, stop.value
        except BaseException as error:
            self.alive, self.error = False, error

    def cancel(self, *, wait=False):
        """End the work."""
        self._steps.close()
        self.alive, self.stopping = False, True


class JobOperator:
    """An operator with long work.

    A subclass gives ``job_name``, ``prepare(context)``, which reads what it needs from Blender and returns what its
    ``job_type`` does, and ``finish(context, result)``, which writes the result as one step of undo. Where that takes
    long, ``finish`` is a generator: at each yield the window is drawn, but no other event has its turn.
    """

    job_type = ThreadJob
    # Whether other events must wait, because the work holds on to the scene.
    blocks_events = False
    _job = None
    # What the status bar says of it, and what ``finish`` still has to do, where it is a generator.
    _told, _writing = "", None
    _with_window = False

    def execute(self, context):
        # After the file browser or a dialog there is a window to show progress in. A script needs the result at once,
        # and so does the redo panel: Blender crashes if a repeated operator keeps running.
        with_window, self._with_window = self._with_window, False
        return self.start(context) if with_window else self.run_blocking(context)

    def browse(self, helper, context, event):
        """Open the file browser, by Blender's ImportHelper or ExportHelper; the work goes on in the window after it."""
        self._with_window = True
        return helper.invoke(self, context, event)

    def ask(self, context, _event):
        """Show the operator's properties in a dialog; the work goes on in the window after it."""
        self._with_window = True
        return context.window_manager.invoke_props_dialog(self, confirm_text=self.bl_label)

    def invoke(self, context, _event):
        return self.start(context)

    @reported
    def run_blocking(self, context):
        """Do all of it before returning, as scripts and background mode expect."""
        complete(self.finish(context, self.job_type.complete(self.prepare(context))))
        return {"FINISHED"}

    @reported
    def start(self, context):
        """Run in the window, going on with events; blocking where there is no window."""
        if bpy.app.background or context.window is None:
            return self.run_blocking(context)
        if running() is not None:
            self.report(
                {"WARNING"},
                report_text("{name} is still running; press ESC to cancel it", name=report_text(running().name)),
            )
            return {"CANCELLED"}
        self._job = self.job_type(self.job_name, self.prepare(context))
        _running.append(self._job)
        self._set_timer(context, _INTERVAL_S)
        context.window_manager.modal_handler_add(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if self._writing is not None:
            return self._write(context) if event.type == "TIMER" else {"RUNNING_MODAL"}
        if event.type == "ESC" and event.value == "PRESS" and self._job.alive:
            self._job.cancel()
        elif event.type != "TIMER":
            return {"RUNNING_MODAL"} if self.blocks_events else {"PASS_THROUGH"}
        if self._job.alive:
            self._job.advance()
        if self._job.alive:
            self._show(context)
            return {"RUNNING_MODAL"} if self.blocks_events or event.type == "ESC" else {"PASS_THROUGH"}
        self._end(context)
        return self._outcome(context)

    def cancel(self, context):
        """Blender ends the operator, because its window or file goes away, or its file browser was left."""
        if self._job is not None:
            self._job.cancel(wait=True)
            self._end(context)
            if not self._job.overtaken:
                # Nothing is left half written.
                complete(self._writing)

    @reported
    def _outcome(self, context):
        error = self._job.error
        if isinstance(error, Cancelled) or (error is None and self._job.stopping):
            self.report({"INFO"}, report_text("{name} cancelled; nothing was changed", name=report_text(self.job_name)))
            return {"CANCELLED"}
        if error is not None:
            raise error
        self._writing = self.finish(context, self._job.result)
        if not isgenerator(self._writing):
            return {"FINISHED"}
        self._job.overtaken = False
        _running.append(self._job)
        self._set_timer(context, _WRITING_INTERVAL_S)
        return {"RUNNING_MODAL"}

    @reported
    def _write(self, context):
        """Go on with what ``finish`` writes, for a moment."""
        end, goes_on = time.monotonic() + _WRITING_S, False
        try:
            if self._job.overtaken:
                self._tell_part_written()
                return {"CANCELLED"}
            for _ in self._writing:
                if goes_on := time.monotonic() >= end:
                    return {"RUNNING_MODAL"}
            return {"FINISHED"}
        except ReferenceError:
            # A script has removed an object between two steps; what was written until then is one step of undo.
            self._tell_part_written()
            return {"FINISHED"}
        finally:
            if not goes_on:
                self._end(context)

    def _tell_part_written(self):
        name = report_text(self.job_name)
        told = report_text("{name}: not all was written, because a scan was undone or removed meanwhile", name=name)
        self.report({"WARNING"}, told)

    def _set_timer(self, context, seconds):
        self._timer = context.window_manager.event_timer_add(seconds, window=context.window)

    def _show(self, context):
        job = self._job
        going_on = f"{job.fraction:.0%}  {shown(job.text)}   |   {label('ESC: Cancel')}"
        text = f"{label(job.name)}:  {label('Cancelling') if job.stopping else going_on}"
        # Drawing the window takes processors away from the work.
        if text != self._told:
            self._told = text
            if context.workspace is not None:
                context.workspace.status_text_set(text)
            redraw_sidebars()

    def _end(self, context):
        context.window_manager.event_timer_remove(self._timer)
        if self._job in _running:
            _running.remove(self._job)
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        redraw_editors()


@persistent
def _something_was_undone(_scene):
    """What was written of a result is gone, from another window or by a script: the rest is not written either."""
    for job in _running:
        job.overtaken = True


handlers = (
    (bpy.app.handlers.undo_post, _something_was_undone),
    (bpy.app.handlers.redo_post, _something_was_undone),
    (bpy.app.handlers.load_post, _something_was_undone),
)
