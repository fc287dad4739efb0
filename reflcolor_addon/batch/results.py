"""Scans with seeds colorized, and all that was asked for written."""

import json
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ..color.colorizer import colorize
from ..files.atomic import written_atomically
from ..files.images import write_png
from ..report.report import build_report, input_entry, output_entry, photo_entry, scan_entry, stamped
from ..seeds.seeds import Seeds
from .outputs import IMAGE_SUFFIXES, SCENE_SUFFIXES, tracked
from .site import PLACEHOLDER, SiteScan, filled_for_all, named


@dataclass(frozen=True, eq=False)
class Job:
    """A scan to colorize.

    Parameters
    ----------
    place : SiteScan
    seeds : Seeds
    inputs : list of (str, Path)
        What for, and the file.
    photos : tuple of PhotoMatch
        What became of the photos that the seeds were found in.
    """

    place: SiteScan
    seeds: Seeds
    inputs: list
    photos: tuple = ()


def is_scene(option, path):
    """Whether an output shows a scene, in which there is room for several scans."""
    return option == "--render" or (option == "-o" and path.suffix.lower() in SCENE_SUFFIXES)


@contextmanager
def timed(times, name):
    """Add the seconds that the block takes to ``times[name]``."""
    start = time.perf_counter()
    yield
    times[name] = round(times.get(name, 0) + time.perf_counter() - start, 3)


def write_results(jobs, outputs, settings, session, times):
    """Colorize scan after scan and write what was asked for; a scan that nothing needs any more is let go.

    Parameters
    ----------
    jobs : list of Job
        Empty afterwards.
    outputs : list of (str, Path)
        The option that asks for it, and the file. The placeholder stands for a scan's label; a scene without it holds
        all scans.
    settings : Settings
    session : Session
    times : dict
        Seconds that were spent before.
    """
    places = [job.place for job in jobs]
    if len(places) == 1:
        outputs = filled_for_all(outputs, places)
    paths = list(dict.fromkeys(path for _, path in filled_for_all(outputs, places)))
    work = _Work(len(places), outputs, settings, session, times)
    del places
    with tracked(paths, session.written):
        while jobs:
            work.colorize(jobs.pop(0))
        work.write_together()
        work.write_files()
    for path in paths:
        session.console.print(f"wrote {path}")


class _Work:
    """What there is of a site's scans while they are colorized one after the other."""

    def __init__(self, count, outputs, settings, session, times):
        self._count, self._outputs, self._settings, self._session, self._times = (
            count,
            outputs,
            settings,
            session,
            times,
        )
        self._shared = [output for output in outputs if is_scene(*output) and PLACEHOLDER not in str(output[1])]
        self._reported = any(is_scene(*output) or output[0] == "--report" for output in outputs)
        self._hashed = {}
        self._together = []
        self._rest = []

    def colorize(self, job):
        """Colorize one scan, and write the scenes that hold nothing else."""
        scan, session, times = job.place.scan, self._session, dict(self._times)
        with timed(times, "colorize"):
            progress = session.part(len(self._rest), self._count, scan.name)
            colorization = colorize(scan, job.seeds, self._settings, progress=progress, cancelled=session.cancelled)
        head = named(scan, self._count)
        session.warnings += [*scan.warnings, *(f"{head}{warning}" for warning in colorization.warnings)]
        report = self._report(job, colorization) if self._reported else None
        own = filled_for_all([output for output in self._outputs if output not in self._shared], [job.place])
        with timed(times, "write"):
            self._write_scenes([(scan, colorization, report)], own)
        if self._shared:
            self._together.append((scan, colorization, report))
        self._rest.append((own, colorization.rgb, report, times))

    def write_together(self):
        """Write the scenes that hold all scans."""
        with timed(shared := {}, "write"):
            self._write_scenes(_let_go(self._together), self._shared)
        for *_, times in self._rest:
            times["write"] += shared["write"]

    def write_files(self):
        """Write images, then reports: each names the hashes of its outputs, so it comes after all of them."""
        progress = self._session.progress
        for own, rgb, _, times in self._rest:
            with timed(times, "write"):
                for option, path in own:
                    if option == "-o" and path.suffix.lower() in IMAGE_SUFFIXES:
                        progress(1.0, f"Writing {path.name}")
                        write_png(path, rgb)
        for own, _, report, times in self._rest:
            for path in [path for option, path in own if option == "--report"]:
                progress(1.0, f"Writing {path.name}")
                with timed(times, "write"):
                    outputs = [self._output(entry, path) for entry in report["outputs"]]
                _write_json(path, report | {"outputs": outputs, "times_s": times})

    def _output(self, entry, report_path):
        """What a report says of one of its outputs; of itself only where it is."""
        if entry["option"] == "--report":
            return entry
        return output_entry(entry["option"], Path(entry["path"]), report_path, self._session.cancelled)

    def _report(self, job, colorization):
        for role, path in job.inputs:
            if (role, path) not in self._hashed:
                self._hashed[role, path] = input_entry(role, path, self._session.cancelled)
        report = build_report(
            scan_entry(job.place.scan, job.place.index),
            colorization,
            self._settings,
            given_seeds=job.seeds,
            photos=[photo_entry(photo) for photo in job.photos],
            inputs=[self._hashed[entry] for entry in job.inputs],
            outputs=filled_for_all(self._outputs, [job.place]),
            noticed=job.place.scan.warnings,
            blender=self._session.blender_version,
        )
        return stamped(report)

    def _write_scenes(self, results, outputs):
        paths = [path for option, path in outputs if option == "-o" and is_scene(option, path)]
        render = next((path for option, path in outputs if option == "--render"), None)
        if paths or render is not None:
            self._session.blender.write_scene(results, paths, render, self._session.progress)


def _let_go(results):
    while results:
        yield results.pop(0)


def _write_json(path, document):
    text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    with written_atomically(path) as temporary:
        # A file name that is no text comes out as JSON's own escapes.
        temporary.write_bytes(text.encode("utf-8", "backslashreplace"))
