"""Blender's own rules for texts in its window, over every class the extension registers."""

import re

import pytest
import ui_strings
from blender_session import EXTENSION

SMALL_WORDS = {
    "a",
    "an",
    "and",
    "as",
    "at",
    "but",
    "by",
    "for",
    "from",
    "in",
    "into",
    "of",
    "on",
    "or",
    "the",
    "to",
    "with",
}


@pytest.fixture
def classes(blender):
    """The registered classes of the extension, by name."""
    found = {name: getattr(blender.types, name) for name in dir(blender.types)}
    return {name: cls for name, cls in found.items() if getattr(cls, "__module__", "").startswith(f"{EXTENSION}.")}


@pytest.fixture
def properties(blender):
    """(place, property) for every property that the extension's operators and property groups declare."""
    return ui_strings.properties(blender)


def _operator(bpy, idname: str):
    group, name = idname.split(".")
    return getattr(getattr(bpy.ops, group), name)


def _in_title_case(text: str) -> bool:
    words = re.findall(r"[^\s/()-]+", text)
    return all(
        any(char.isupper() for char in word[:3]) or not word[0].isalpha() or (word in SMALL_WORDS and index > 0)
        for index, word in enumerate(words)
    )


def _tooltip_fault(text: str) -> str:
    if not text.strip():
        return "is empty"
    if text != text.strip() or "  " in text.replace("\n", " "):
        return "has blanks to spare"
    if text.endswith(".") and not text.endswith("..."):
        return "ends with a full stop"
    if text[0].isalpha() and not text[0].isupper():
        return "does not begin with a capital"
    return ""


def test_the_extension_registers_classes(classes):
    assert any(name.startswith("REFLCOLOR_OT_") for name in classes)


def test_operators_and_panels_are_named_in_title_case(classes):
    labels = {name: cls.bl_label for name, cls in classes.items() if getattr(cls, "bl_label", "")}
    assert not {name: label for name, label in labels.items() if not _in_title_case(label) or label.endswith(".")}


def test_operators_have_tooltips_without_a_full_stop(blender, classes):
    operators = {name: cls.bl_idname for name, cls in classes.items() if "_OT_" in name}
    tooltips = {name: _operator(blender, idname).get_rna_type().description for name, idname in operators.items()}
    assert not {name: (text, fault) for name, text in tooltips.items() if (fault := _tooltip_fault(text))}


def test_the_extension_declares_properties(properties):
    places = {place for place, _ in properties}
    assert {"reflcolor.colorize.alpha", "ReflcolorSettings.alpha", "ReflcolorSeed.row", "ReflcolorWipe.show"} <= places


def test_properties_are_named_in_title_case(properties):
    named = {place: prop.name for place, prop in properties if not prop.is_hidden}
    assert not {place: name for place, name in named.items() if not name or not _in_title_case(name)}


def test_properties_have_tooltips_without_a_full_stop(properties):
    tooltips = {place: prop.description for place, prop in properties if not prop.is_hidden}
    assert not {place: (text, fault) for place, text in tooltips.items() if (fault := _tooltip_fault(text))}


def test_choices_are_named_and_explained(properties):
    choices = {
        f"{place}={item.identifier}": (item.name, item.description)
        for place, prop in properties
        if prop.type == "ENUM"
        for item in prop.enum_items
    }
    assert not {
        place: texts for place, texts in choices.items() if not _in_title_case(texts[0]) or _tooltip_fault(texts[1])
    }
