"""The extension's texts in German: all of them, with the same parts, and none of a text that is gone."""

import importlib
import re
import string
import sys

import core_texts
import pytest
import ui_strings
from blender_session import EXTENSION

TEXTS = f"{EXTENSION}.panels.translations"


@pytest.fixture
def german(installed_blender):
    return importlib.import_module(TEXTS)._LANGUAGES["de_DE"]


@pytest.fixture
def asked(blender):
    """(context, text) of everything that is looked up, except the lines of the core."""
    return ui_strings.class_strings(blender) | ui_strings.source_strings()


@pytest.fixture
def core_german(installed_blender):
    return importlib.import_module(TEXTS).CORE


def parts(text):
    """What is put into a template, with its format."""
    return sorted((name, style) for _, name, style, _ in string.Formatter().parse(text) if name is not None)


def test_every_text_has_its_german(german, asked):
    assert sorted(asked - set(german)) == []


def test_no_german_is_left_of_texts_that_are_gone(german, asked, core_german):
    core = {("*", form) for template in core_german for form in (template, template.removeprefix("{file}: "))}
    assert sorted(set(german) - asked - core) == []


def test_every_line_of_the_core_that_the_window_can_show_has_its_german(core_german):
    templates = core_texts.window_templates()
    assert {text: places for text, places in templates.items() if text not in core_german} == {}


def test_no_german_is_left_of_lines_of_the_core_that_are_gone(core_german):
    assert sorted(core_german.keys() - core_texts.window_templates().keys()) == []


def test_every_template_of_the_core_is_written_out():
    """One that is put together of parts would never be found in the catalog."""
    assert core_texts.unknown_templates() == []


def test_lines_about_a_file_begin_with_it_in_german_too(core_german):
    """What the readers say about one of several scans is shown without the file."""
    begins = "{file}: "
    assert [text for text, german in core_german.items() if text.startswith(begins) > german.startswith(begins)] == []


def test_a_translation_has_the_parts_of_its_text(german):
    assert {text: found for (_, text), found in german.items() if parts(text) != parts(found)} == {}


def test_translations_end_and_begin_like_their_texts(german):
    def shape(text):
        return text.endswith("."), text == text.strip(), text.count("\n")

    messages = {text: found for (_, text), found in german.items()}
    assert {text: found for text, found in messages.items() if shape(text) != shape(found)} == {}
    # A German noun has a capital anywhere.
    small = {text: found for text, found in messages.items() if text[0].isupper() and found[0].islower()}
    assert small == {}


def test_texts_that_are_put_together_go_through_the_catalog():
    assert ui_strings.unsaid_parts() == []


def test_the_catalog_is_taken_off_with_the_extension(installed_blender):
    catalog = importlib.import_module(TEXTS)
    catalog.unregister()
    catalog.register()


@pytest.fixture
def texts(installed_blender, monkeypatch):
    """The helpers, with a catalog that knows two lines of the core."""
    module = sys.modules[f"{EXTENSION}.operators.scene.texts"]
    known = {
        "seed {seed}: no return at row {row}": "Saatpunkt {seed}: keine Messung in Zeile {row}",
        "{name}: {text}": "{name} - {text}",
    }
    monkeypatch.setattr(module, "pgettext_rpt", lambda text: known.get(text, text))
    return module


@pytest.fixture
def message(installed_blender):
    """The Message of the installed extension."""
    return sys.modules[f"{EXTENSION}.reflcolor_addon.messages"].Message


def test_lines_of_the_core_are_looked_up_by_their_template(texts, message):
    line = message("seed {seed}: no return at row {row}", seed=3, row=12)
    assert texts.shown(line) == "Saatpunkt 3: keine Messung in Zeile 12"
    assert texts.shown(message("{name}: {text}", name="wall {1}", text=line)) == f"wall {{1}} - {texts.shown(line)}"
    assert texts.shown(message("{file} is no scan", file="{holes}.ptx")) == "{holes}.ptx is no scan"


def test_german_words_do_not_hold_english_ones(german):
    """A slip of the hand: a text that was copied and not translated."""
    same = {
        text
        for (_, text), found in german.items()
        if text == found and re.search(r"[a-z]{4}", re.sub(r"\{.*?\}", "", text))
    }
    assert same <= {
        "1. Scan",
        "Scan",
        "Sensor",
        "Alpha",
        "Beta",
        "Block",
        "Kriging",
        "Sigma",
        "Text",
        "Lasso",
        "L-Alpha-Beta",
    }
