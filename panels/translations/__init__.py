"""The extension's texts in other languages, for Blender's catalogue.

A language is a dictionary from (context, text) to its translation, as `bpy.app.translations.register` takes it. Texts
that are missing are shown in English; ``tests/test_translations.py`` says which are.
"""

import bpy

from . import german_data_tips, german_names, german_texts, german_tips

_NAME = __name__
_LANGUAGES = {
    "de_DE": {
        **german_names.MESSAGES,
        **german_tips.MESSAGES,
        **german_data_tips.MESSAGES,
        **german_texts.MESSAGES,
    }
}


def register():
    """Add the languages to Blender's catalogue."""
    bpy.app.translations.register(_NAME, _LANGUAGES)


def unregister():
    """Take them out again."""
    bpy.app.translations.unregister(_NAME)
