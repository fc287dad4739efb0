"""The extension's texts in German: complete, with the same parts, and none that is asked for no more."""

import importlib
import re
import string
import sys

import pytest
import ui_strings
from blender_session import EXTENSION

TEXTS = f"{EXTENSION}.panels.translations"


@pytest.fixture
def german(installed_blender):
    return importlib.import_module(TEXTS)._LANGUAGES["de_DE"]


@pytest.fixture
def asked(blender):
    """(context, text) of all that is looked up, but lines of the core."""
    return ui_strings.class_strings(blender) | ui_strings.source_strings()


@pytest.fixture
def core_lines(installed_blender):
    return importlib.import_module(f"{TEXTS}.german_texts").CORE


def parts(text):
    """What is put into a template, with its format."""
    return sorted((name, style) for _, name, style, _ in string.Formatter().parse(text) if name is not None)


def test_every_text_has_its_german(german, asked):
    assert sorted(asked - set(german)) == []


def test_no_german_is_left_of_texts_that_are_gone(german, asked, core_lines):
    assert sorted(set(german) - asked - {("*", line) for line in core_lines}) == []


def test_lines_of_the_core_are_said_there(core_lines):
    said = ui_strings.core_templates()
    assert [line for line in core_lines if line not in said] == []


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


def test_texts_that_are_put_together_go_through_the_catalogue():
    assert ui_strings.unsaid_parts() == []


def test_the_catalogue_is_taken_off_with_the_extension(installed_blender):
    catalogue = importlib.import_module(TEXTS)
    catalogue.unregister()
    catalogue.register()


@pytest.fixture
def texts(installed_blender, monkeypatch):
    """The helpers, with a catalogue that knows two lines of the core."""
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
    same = {text for (_, text), found in german.items() if text == found and re.search(r"[a-z]{4}", text)}
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
