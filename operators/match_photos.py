"""Find seeds of the selected scans in the photos."""

import bpy

from ..reflcolor_addon.batch.pipeline import find_seeds
from ..reflcolor_addon.batch.scan_job import ScanJob
from ..reflcolor_addon.errors import SeedsError
from ..reflcolor_addon.matching import draw_matches
from .scene import polls
from .scene.images import packed_pixels, write_packed
from .scene.notices import show_result, show_results
from .scene.photo_colors import ObservedArrays, keep_cameras, keep_observed_by_steps
from .scene.photo_list import listed_images
from .scene.photos import photo_of
from .scene.provenance import record_matching
from .scene.scan_object import SHIFT, grid_indices, own_image, scan_reader
from .scene.seed_list import append_seeds_by_steps, remove_seeds, seeds_of
from .scene.setting_properties import MATCH_NAMES, MatchArguments, core_settings, keep_used_settings
from .scene.steps import complete
from .scene.texts import report_text, shown
from .scene.verdicts import keep_verdicts
from .window.jobs import JobOperator


class REFLCOLOR_OT_match_photos(JobOperator, MatchArguments, bpy.types.Operator):
    """Find seeds of the selected scans in the photos; hand-picked and locked ones stay, four to six pairs help"""

    bl_idname = "reflcolor.match_photos"
    bl_label = "Match Photos"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Match Photos"

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context) and polls.has_photos(cls, context)

    def prepare(self, context):
        objects, self._skipped = polls.fitting_scans(context, polls.foreign_seeds)
        images = listed_images(context.scene)
        # The user may rename a photo while the work goes on.
        self._photos = {image.name: image.session_uid for image in images}
        shift = context.scene.get(SHIFT, (0.0, 0.0, 0.0))
        photos = [photo_of(image, shift) for image in images]
        if None in photos:
            raise SeedsError("a photo of the list cannot be read; remove it and load it again")
        settings = self._settings = core_settings(self, context.scene, MATCH_NAMES)
        jobs = [
            ScanJob(
                name=obj.name,
                scan=scan_reader(obj),
                hand=seeds_of(obj, wanted=lambda seeds: seeds.by_hand),
                kept=seeds_of(obj, wanted=lambda seeds: ~seeds.by_hand & seeds.locked),
            )
            for obj in objects
        ]

        places = {obj.name: grid_indices(obj) for obj in objects}

        def work(progress, cancelled):
            find_seeds(jobs, photos, settings, progress=progress, cancelled=cancelled)
            return [(job, *_ready(job, places[job.name], photos)) for job in jobs]

        return work

    def finish(self, context, results):
        keep_used_settings(self, context.scene, MATCH_NAMES)
        there, done = [], []
        images = {image.session_uid: image for image in bpy.data.images}
        images = {name: images.get(uid) for name, uid in self._photos.items()}
        for job, *ready in results:
            obj = bpy.data.objects.get(job.name)
            if obj is None or not obj.reflcolor.rows:
                self.report({"WARNING"}, report_text("{name} is gone; its seeds were dropped", name=job.name))
                continue
            # Raises if a mesh cannot take the observed colors, before any scan is changed.
            grid_indices(obj)
            there.append((obj, job, ready))
        for obj, job, (arrays, picture) in there:
            yield
            yield from keep_observed_by_steps(obj, job.observed, arrays)
            keep_cameras(obj, job.matching.photos, images)
            yield
            yield from take_over_seeds_by_steps(obj, job.seeds, images)
            yield
            found = [(images[photo.name], photo) for photo in job.matching.photos if images.get(photo.name)]
            keep_verdicts(obj, found)
            record_matching(obj, job.matching, self._settings, MATCH_NAMES)
            obj.reflcolor.matches_image = write_packed(
                own_image(obj, "matches_image"), f"{obj.name} Matches", picture, is_data=False
            )
            self._show_found(obj, job.matching, one_of_several=len(results) > 1)
            done.append((obj, job.matching))
        counts = ", ".join(f"{obj.name} ({len(matching.seeds)})" for obj, matching in done)
        together = report_text("Found seeds for {count} scans: {counts}", count=len(done), counts=counts)
        show_results(self, [obj for obj, _ in done], together, self._skipped)
        yield

    def _show_found(self, obj, matching, *, one_of_several):
        said = report_text("Found {count} seeds for {name}", count=len(matching.seeds), name=obj.name)
        details = [f"{photo.name}: {shown(photo.note)}" for photo in matching.photos]
        show_result(self, obj, said, matching.warnings, details=details, one_of_several=one_of_several)


def _ready(job, place, photos):
    """What can be made in the thread of that which is written."""
    arrays = None if job.observed is None else ObservedArrays.of(job.observed, place)
    return arrays, packed_pixels(draw_matches(job.scan, photos, job.seeds), job.name)


def take_over_seeds(obj, seeds):
    """Put the seeds that were found in place of those found before; those picked by hand and locked ones stay."""
    complete(take_over_seeds_by_steps(obj, seeds))


def take_over_seeds_by_steps(obj, seeds, images=None):
    """As `take_over_seeds`, by steps; ``images``, a dict, tells the photos that the seeds name, else their names do."""
    replaced = [i for i, seed in enumerate(obj.reflcolor.seeds) if seed.reason != "hand" and not seed.locked]
    remove_seeds(obj, replaced)
    locked = {(seed.row, seed.col) for seed in obj.reflcolor.seeds if seed.locked}
    places = zip(seeds.rows.tolist(), seeds.cols.tolist(), strict=True)
    found = [
        index
        for index, (place, reason) in enumerate(zip(places, seeds.reason, strict=True))
        if reason != "hand" and place not in locked
    ]
    yield from append_seeds_by_steps(obj, seeds.chosen(found), images)


classes = (REFLCOLOR_OT_match_photos,)
