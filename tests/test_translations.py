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
    known = {"seed {}: no return at row {}": "Saatpunkt {}: keine Messung in Zeile {}", "Seed {} of {}": "S {} / {}"}
    monkeypatch.setattr(module, "pgettext_rpt", lambda text: known.get(text, text))
    return module


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("seed 3: no return at row 12", "Saatpunkt 3: keine Messung in Zeile 12"),
        ("Seed 1 of 50", "S 1 / 50"),
        ("wall 2: Seed 1 of 50", "wall 2: S 1 / 50"),
        ("scan {1} has 3 {holes}", "scan {1} has 3 {holes}"),
        ("garage2.ptx: line 12: expected 4 or 7 values", "garage2.ptx: line 12: expected 4 or 7 values"),
        ("", ""),
    ],
)
def test_lines_of_the_core_are_looked_up_without_their_numbers(texts, line, expected):
    assert texts.core_line(line) == expected


def test_german_words_do_not_hold_english_ones(german):
    """A slip of the hand: a text that was copied and not translated."""
    same = {text for (_, text), found in german.items() if text == found and re.search(r"[a-z]{4}", text)}
    assert same <= {"1. Scan", "Sensor", "Alpha", "Beta", "Block", "Kriging", "Sigma", "Text", "Lasso", "L-Alpha-Beta"}
