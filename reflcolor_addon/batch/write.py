"""Writes what a run has made: each scan's own files, then scenes that hold all scans, reports last."""

from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import ReflcolorError
from ..files.images import png_bytes, write_jpeg, write_png
from ..files.writers import MESH_WRITERS
from ..files.writers.scans_back import ColoredScan, write_scans_back
from ..matching import draw_matches
from ..messages import Message
from ..report.report import (
    REPORT_OPTION,
    build_report,
    input_entry,
    output_entry,
    photo_entry,
    scan_entry,
    stamped,
    write_report,
)
from ..view.preview import preview, uncolored_preview
from .paths import tracked
from .plan import IMAGE, MATCHES, MESH, PREVIEW, RENDER, REPORT, SCANS, SCENE, SEEDS
from .scan_job import surface_of
from .session import timed


@contextmanager
def writing(plan, jobs, session):
    """Within the block, ``write(job)`` writes what belongs to one job; at its end the rest is written and told.

    Parameters
    ----------
    plan : Plan
    jobs : list of ScanJob
        All that there will be. One that was written holds no scan and no colors any more, unless a scene is still to
        be made of all of them.
    session : Session
        Its list ``written`` tells what is there, whether the block ends well or not.
    """
    writer = _Writer(plan, jobs, session)
    with tracked(writer.paths, session.written):
        yield writer.write
        writer.finish()
    for line in writer.lines:
        session.say(line)


def write_uncolored(plan, job):
    """Write the preview of a job that gets no colors, where the plan asks for previews."""
    for output in plan.outputs:
        if output.kind == PREVIEW:
            write_jpeg(output.of(job.label).path, uncolored_preview(job.opened()))


@contextmanager
def pictured(plan, jobs):
    """Where the block fails, write the previews of the jobs that have none from an earlier time: a person wants to see
    which scan it was that failed."""
    try:
        yield
    except ReflcolorError:
        paths = [output for output in plan.outputs if output.kind == PREVIEW]
        for job in jobs:
            missing = not all(output.of(job.label).path.exists() for output in paths)
            # What made the block fail, a full disk for example, may also prevent this.
            with suppress(ReflcolorError):
                if missing and job.scan is not None:
                    write_uncolored(plan, job)
        raise


class _Writer:
    def __init__(self, plan, jobs, session):
        self._plan, self._session = plan, session
        self._shared = [output for output in plan.outputs if len(jobs) > 1 and not output.is_of_each]
        self._reported = any(output.is_scene or output.kind == REPORT for output in plan.outputs)
        self._hashed, self._rest = {}, []
        places = [(output, job) for output in plan.outputs for job in jobs]
        own = [(output.of(job.label).path, output.kind, job) for output, job in places]
        self.paths = list(dict.fromkeys(path for path, *_ in own))
        self._written_from = {path: (kind, job) for path, kind, job in own}

    @property
    def lines(self):
        """What is there, one line for each file."""
        for path, (kind, job) in self._written_from.items():
            if kind == SEEDS:
                yield Message("wrote {path}: {count} seeds", path=path, count=len(job.seeds))
            else:
                yield Message("wrote {path}", path=path)

    def write(self, job):
        """Write the scenes that hold one job alone, and what tells of its seeds."""
        with timed(job.times, "write"):
            for output in job.outputs:
                if output.kind in _SEED_WRITERS:
                    self._show_writing(output)
                    _SEED_WRITERS[output.kind](job, self._plan, output.path)
            if self._reported:
                job.report = self._report(job)
            for output in job.outputs:
                if output.kind == PREVIEW:
                    write_jpeg(output.path, preview(job.scan, job.colorization))
            self._write_meshes([job], job.outputs)
            # Larger arrays are not kept until all scans are colorized, and no scene needs them once it is built.
            self._rest.append((job, self._image(job)))
            self._write_scenes([job] if self._shared else _let_go([job]), job.outputs)
        if not self._shared:
            job.let_go()

    def _image(self, job):
        if self._plan.texture:
            return job.texture
        return None if job.colorization is None else job.colorization.rgb

    def finish(self):
        """Write the scenes that hold all scans, images, and last the reports: those say how long the rest took."""
        with timed(shared := {}, "write"):
            self._write_meshes([job for job, _ in self._rest], self._shared)
            self._write_scenes(_let_go([job for job, _ in self._rest]), self._shared)
        for job, rgb in self._rest:
            with timed(job.times, "write"):
                for output in job.outputs:
                    if output.kind == IMAGE:
                        self._show_writing(output)
                        write_png(output.path, rgb)
            job.times["write"] = round(job.times["write"] + shared["write"], 3)
        # Each names the hashes of its outputs, so it comes after all of them.
        for job, _ in self._rest:
            for output in job.outputs:
                if output.kind == REPORT:
                    self._write_report(job, output)

    def _write_report(self, job, output):
        self._show_writing(output)
        with timed(job.times, "write"):
            outputs = [self._output_entry(entry, output.path) for entry in job.report["outputs"]]
        write_report(output.path, job.report | {"outputs": outputs, "times_s": job.times})

    def _output_entry(self, entry, report_path):
        """What a report says of one of its outputs; of itself only where it is."""
        if entry["option"] == REPORT_OPTION:
            return entry
        return output_entry(entry["option"], Path(entry["path"]), report_path, self._session.cancelled)

    def _show_writing(self, output):
        self._session.progress(1.0, Message("Writing {name}", name=output.path.name))

    def _report(self, job):
        for role, path in job.inputs:
            if (role, path) not in self._hashed:
                self._hashed[role, path] = input_entry(role, path, self._session.cancelled)
        outputs = [output.of(job.label) for output in self._plan.outputs]
        report = build_report(
            scan_entry(job.scan, job.index, reading=self._plan.reading),
            job.colorization,
            self._plan.settings,
            given_seeds=job.seeds,
            light=job.light,
            photos=[photo_entry(photo) for photo in job.matching.photos] if job.matching else [],
            inputs=[self._hashed[entry] for entry in job.inputs],
            outputs=[(output.option, output.path) for output in outputs],
            noticed=job.scan.warnings,
            blender=self._session.blender_version,
        )
        return stamped(report)

    def _write_meshes(self, jobs, outputs):
        for output in outputs:
            if output.kind == SCANS:
                self._write_back(jobs, output.path)
            if output.kind == MESH:
                write = MESH_WRITERS[output.path.suffix.lower()]
                surfaces = [surface_of(job) for job in jobs]
                session, options = self._session, {}
                if output.path.suffix.lower() == ".glb":
                    options = {"textures": [self._embedded(job, output.path) for job in jobs]}
                write(surfaces, output.path, progress=session.progress, cancelled=session.cancelled, **options)

    @staticmethod
    def _embedded(job, path):
        return None if job.texture is None else png_bytes(job.texture, path)

    def _write_back(self, jobs, path):
        colored = [
            ColoredScan(
                scan=job.scan,
                rgb=job.colorization.rgb,
                source=job.path,
                index=job.index,
                options=self._plan.reading,
            )
            for job in jobs
        ]
        session = self._session
        session.warnings += write_scans_back(colored, path, progress=session.progress, cancelled=session.cancelled)

    def _write_scenes(self, jobs, outputs):
        paths = [output.path for output in outputs if output.kind == SCENE]
        render = next((output.path for output in outputs if output.kind == RENDER), None)
        if paths or render is not None:
            self._session.blender.write_scene(jobs, paths, render, self._plan.picture, self._session.progress)


def _let_go(jobs):
    """Each job, which holds no larger arrays any more when the next one is asked for."""
    for job in jobs:
        yield job
        job.let_go()


def _write_seeds(job, _plan, path):
    job.seeds.save(path)


def _write_matches(job, plan, path):
    write_png(path, draw_matches(job.scan, plan.photos, job.seeds))


_SEED_WRITERS = {SEEDS: _write_seeds, MATCHES: _write_matches}
