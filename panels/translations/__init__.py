"""The extension's texts in other languages, for Blender's catalog.

A language is a dictionary from (context, text) to its translation, as `bpy.app.translations.register` takes it. Texts
that are missing are shown in English; ``tests/test_translations.py`` says which are.
"""

import bpy

from . import (
    german_core_files,
    german_core_grids,
    german_core_photos,
    german_core_readers,
    german_core_scans,
    german_data_tips,
    german_names,
    german_texts,
    german_tips,
)

_NAME = __name__
_FILE = "{file}: "

CORE = {
    **german_core_files.TEXTS,
    **german_core_grids.TEXTS,
    **german_core_photos.TEXTS,
    **german_core_readers.TEXTS,
    **german_core_scans.TEXTS,
}
"""The German of the core's templates."""

_LANGUAGES = {
    "de_DE": {
        **{("*", text): german for text, german in CORE.items()},
        # What is wrong with one scan of several is shown without the file's name.
        **{
            ("*", text.removeprefix(_FILE)): german.removeprefix(_FILE)
            for text, german in CORE.items()
            if text.startswith(_FILE)
        },
        **german_names.MESSAGES,
        **german_tips.MESSAGES,
        **german_data_tips.MESSAGES,
        **german_texts.MESSAGES,
    }
}


def register():
    """Add the languages to Blender's catalog."""
    bpy.app.translations.register(_NAME, _LANGUAGES)


def unregister():
    """Take them out again."""
    bpy.app.translations.unregister(_NAME)
