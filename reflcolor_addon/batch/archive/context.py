"""What all stages of a batch have in common."""

from collections.abc import Callable
from dataclasses import dataclass, field

from ...errors import ReflcolorError
from ...messages import Message
from ..session import Session
from .costs import Costs
from .done import Done
from .duplicates import Duplicates
from .fingerprints import Fingerprints
from .folder import BatchFolder
from .manifest import Manifest
from .options import Options
from .progress_lines import WholeProgress
from .workers import Task, Workers


@dataclass(eq=False, kw_only=True)
class Context:
    """One run over a batch.

    Parameters
    ----------
    manifest : Manifest
    options : Options
    costs : Costs
    session : Session
    fingerprints : Fingerprints
    done : Done
    workers : Workers
    same : Duplicates
    whole : WholeProgress
    problems : dict of str to str
        Why photos cannot be used, by their paths, as far as that was found.
    """

    manifest: Manifest
    options: Options
    costs: Costs
    session: Session
    fingerprints: Fingerprints
    done: Done
    workers: Workers
    same: Duplicates
    whole: WholeProgress
    problems: dict[str, str] = field(default_factory=dict)

    @property
    def folder(self) -> BatchFolder:
        """Where everything is written."""
        return self.manifest.folder

    def hashes(self, paths):
        """Return the hash of each file by its path as text."""
        return {str(path): hashed(self.fingerprints, path, self.session.cancelled) for path in paths}

    def tell(self, text):
        """Show what is done between steps."""
        self.session.progress(self.whole.share(), text)

    def work(
        self,
        stage: str,
        tasks: list[Task],
        finished: Callable,
        what: str,
        begin: Callable = lambda task: True,
        only: bool = False,
    ):
        """Run the tasks of one step of a stage, and show how far the whole batch is.

        Parameters
        ----------
        stage : str
        tasks : list of Task
        finished, begin : callable
            As `Workers.work`.
        what : str
            What is done, for the line of progress.
        only : bool
            Whether the stage has no other step.
        """
        whole, count, done = self.whole, len(tasks), 0
        whole.begin(stage, sum(task.cost for task in tasks), only)

        def show(running):
            share = sum(task.cost * fraction for task, fraction, _ in running)
            parts = [f"{what} {done} of {count}", whole.text(share)]
            parts += [f"{task.name}: {text}" for task, _, text in running if text]
            self.session.progress(whole.share(share), "; ".join(parts))

        def counted(task, outcome):
            nonlocal done
            waiting = len(tasks)
            stop = finished(task, outcome)
            # Tasks to be tried again were put back into the queue.
            if len(tasks) == waiting:
                # What was known from before takes no time, and tells nothing of how long the rest will take.
                worked = outcome.get("found", {}).get("worked", 1.0)
                whole.drop((1 - worked) * task.cost)
                whole.add(worked * task.cost)
                done += 1
            return stop

        def begun(task):
            nonlocal count
            if begin(task):
                return True
            whole.drop(task.cost)
            count -= 1
            return False

        self.workers.work(tasks, counted, show, begun)
        whole.pause()
        self.tell(f"{what} {done} of {count}")

    def work_again(self, stage: str, tasks: list[Task], done: Callable, failed: Callable, what: str):
        """Run tasks, those again that failed for something that may pass.

        Parameters
        ----------
        stage : str
        tasks : list of Task
        done : callable
            Called as ``done(task, outcome)``.
        failed : callable
            Called as ``failed(task)`` for each that was not done in the end.
        what : str
            As `work`.
        """
        tries = dict.fromkeys((task.name for task in tasks), 1)

        def finished(task, outcome):
            if outcome["done"]:
                done(task, outcome)
            elif outcome.get("may_pass") and tries[task.name] < self.options.tries:
                tries[task.name] += 1
                alone = outcome.get("alone", False)
                tasks.append(task.again(0.0 if alone else self.options.wait_s, alone))
            else:
                failed(task)

        self.work(stage, tasks, finished, what)

    def tell_problem(self, path, problem):
        """Say why a photo cannot be used, and remember it."""
        self.problems[path] = problem
        self.session.warnings.append(Message("{photo}: {problem}", photo=self.manifest.name_of(path), problem=problem))


def hashed(fingerprints, path, cancelled):
    """Return the hash of a file; an empty text where it cannot be read, as its reader says."""
    try:
        return fingerprints.of(path, cancelled)
    except ReflcolorError:
        return ""
