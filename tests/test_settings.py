"""What can be chosen, and what is refused."""

import dataclasses

import numpy as np
import pytest
import settings_page

from reflcolor_addon import ReflcolorError, Settings, SettingsError
from reflcolor_addon.settings import SETTINGS


def test_the_defaults_are_those_of_the_paper():
    settings = Settings()
    assert (settings.alpha, settings.beta, settings.color_space) == (6.0, 1.0, "ycbcr")
    assert settings.nearest is None
    assert settings == Settings.preset("Paper")


def test_the_ends_of_the_ranges_are_allowed():
    for alpha, beta in ((0.1, 0.0), (64, 1e6)):
        assert Settings(alpha=alpha, beta=beta).as_dict()["alpha"] == alpha


@pytest.mark.parametrize(
    "change",
    [
        {"alpha": 0},
        {"alpha": -1.0},
        {"alpha": 65},
        {"alpha": float("nan")},
        {"alpha": float("inf")},
        {"alpha": "6"},
        {"alpha": True},
        {"beta": -0.1},
        {"beta": 1e7},
        {"beta": float("nan")},
        {"beta": None},
        {"color_space": "rgb"},
        {"color_space": None},
        {"neighbors": 6},
        {"neighbors": "8"},
        {"nearest": 0},
        {"nearest": 2.5},
        {"nearest": True},
    ],
    ids=str,
)
def test_a_value_out_of_range_is_refused_in_one_line_that_names_it(change):
    (name,) = change
    with pytest.raises(SettingsError, match=f"^{name}: expected [^\n]*found [^\n]*$") as raised:
        Settings(**change)
    assert isinstance(raised.value, ReflcolorError)


def test_a_number_of_hundreds_of_digits_is_out_of_range():
    with pytest.raises(SettingsError, match="alpha"):
        Settings(alpha=10**400)


def test_settings_cannot_be_changed_afterwards():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Settings().alpha = 3


def test_a_preset_takes_changes():
    assert Settings.preset("Paper", beta=0.0) == Settings(beta=0.0)


def test_an_unknown_preset_is_refused_with_the_names_there_are():
    with pytest.raises(SettingsError, match=r"preset: expected one of .*\bPaper\b.*found 'paper'"):
        Settings.preset("paper")


def test_as_dict_holds_every_setting_in_order():
    assert list(Settings().as_dict()) == [field.name for field in dataclasses.fields(Settings)]


@pytest.mark.parametrize("setting", SETTINGS.values(), ids=lambda setting: setting.name)
def test_a_setting_takes_its_whole_range_and_choices_and_no_more(setting):
    ranged = setting.kind in (int, float)
    numbers = [setting.low, setting.high] if ranged else []
    for value in [setting.default, *numbers, *(choice.value for choice in setting.choices)]:
        setting.check(value)
        assert setting.named(setting.name_of(value)) == value
    beyond = [setting.low - 1e-9, setting.high * (1 + 1e-9)] if ranged else [6]
    for value in [*beyond, "poster", [], np.array([1, 2]), object()]:
        with pytest.raises(SettingsError, match=f"^{setting.name}: expected [^\n]+, found [^\n]+$"):
            setting.check(value)


def test_the_page_of_settings_is_as_the_declarations_are():
    assert settings_page.PAGE.read_text(encoding="utf-8") == settings_page.page(), "run tools/settings_page.py"


def test_the_window_of_the_descriptor_holds_a_block():
    Settings(hog_cell=16, hog_block=3, hog_window=48)
    with pytest.raises(SettingsError, match=r"^hog_window: expected at least a block, .* = 64 pixels, found 48$"):
        Settings(hog_cell=16, hog_block=4, hog_window=48)
