"""Find seeds of a scan in the photos."""

import bpy
import numpy as np

from ..reflcolor_addon.errors import SeedsError
from ..reflcolor_addon.matching import draw_matches, match_photos
from ..reflcolor_addon.seeds import Seeds
from . import polls
from .images import read_pixels, write_image
from .jobs import JobOperator
from .notices import tell
from .properties import MATCH_NAMES, MatchSettings, core_settings
from .provenance import record_matching
from .scan_object import own_image, scan_reader
from .seed_list import append_seeds, remove_seeds, seeds_of
from .texts import told


class REFLCOLOR_OT_match_photos(JobOperator, MatchSettings, bpy.types.Operator):
    """Find seeds in the photos; those picked by hand and locked ones stay, and four to six picked pairs help"""

    bl_idname = "reflcolor.match_photos"
    bl_label = "Match Photos"
    bl_options = {"REGISTER", "UNDO"}
    job_name = "Match Photos"

    @classmethod
    def poll(cls, context):
        return polls.has_own_scan(cls, context) and polls.has_photos(cls, context)

    def prepare(self, context):
        obj, listed = polls.scan_object(context), context.scene.reflcolor.photos
        self._object_name = obj.name
        self._photo_names = [photo.image.name for photo in listed if photo.image is not None]
        photos = [read_pixels(bpy.data.images[name]) for name in self._photo_names]
        if any(pixels is None for pixels in photos):
            raise SeedsError(told("a photo of the list cannot be read; remove it and load it again"))
        read_scan, settings = scan_reader(obj), core_settings(self, context.scene.reflcolor, MATCH_NAMES)
        self._settings = settings
        numbered = {name: f"photo {number}" for number, name in enumerate(self._photo_names, 1)}
        hand = renamed(seeds_of(obj, wanted=lambda seeds: seeds.by_hand), numbered)
        kept = renamed(seeds_of(obj, wanted=lambda seeds: ~seeds.by_hand & seeds.locked), numbered)

        def work(progress, cancelled):
            scan = read_scan()
            matching = match_photos(
                scan, photos, settings, hand=hand, kept=kept, progress=progress, cancelled=cancelled
            )
            return matching, draw_matches(scan, photos, matching.seeds)

        return work

    def finish(self, context, result):
        matching, picture = result
        obj = bpy.data.objects.get(self._object_name)
        if obj is None or not obj.reflcolor.rows:
            self.report({"WARNING"}, told("{name} is gone; its seeds were dropped", name=self._object_name))
            return
        names = {f"photo {number}": name for number, name in enumerate(self._photo_names, 1)}
        replaced = [i for i, seed in enumerate(obj.reflcolor.seeds) if seed.reason != "hand" and not seed.locked]
        remove_seeds(obj, replaced)
        locked = {(seed.row, seed.col) for seed in obj.reflcolor.seeds if seed.locked}
        places = zip(matching.seeds.rows.tolist(), matching.seeds.cols.tolist(), strict=True)
        found = [
            index
            for index, (place, reason) in enumerate(zip(places, matching.seeds.reason, strict=True))
            if reason != "hand" and place not in locked
        ]
        append_seeds(obj, renamed(matching.seeds.chosen(found), names))
        record_matching(obj, matching, names, self._settings, MATCH_NAMES)
        state = obj.reflcolor
        state.matches_image = write_image(
            own_image(obj, "matches_image"), f"{obj.name} Matches", picture, is_data=False
        )
        notes = {names[photo.name]: photo.note for photo in matching.photos}
        verified = {names[photo.name] for photo in matching.photos if photo.verified}
        for photo in context.scene.reflcolor.photos:
            if photo.image is not None and photo.image.name in notes:
                photo.note, photo.verified = notes[photo.image.name], photo.image.name in verified
        warnings = []
        for warning in matching.warnings:
            for number, name in names.items():
                warning = warning.replace(f"{number}:", f"{name}:")
            warnings.append(warning)
        said = told("Found {count} seeds for {name}", count=len(matching.seeds), name=obj.name)
        tell(self, obj, said, warnings, details=[f"{name}: {note}" for name, note in notes.items()])


def renamed(seeds, names):
    """Return the seeds with other names of their photos; a photo that has none there counts as not known."""
    photos = tuple(names.get(photo) for photo in seeds.photos)
    known = np.array([photo is not None for photo in photos], bool)
    return Seeds(
        rows=seeds.rows,
        cols=seeds.cols,
        rgb=seeds.rgb,
        photos=photos,
        photo_xy=np.where(known[:, None], seeds.photo_xy, np.nan),
        confidence=seeds.confidence,
        reason=seeds.reason,
    )


classes = (REFLCOLOR_OT_match_photos,)
