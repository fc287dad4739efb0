"""The user's own presets, in Blender through the installed zip."""

from pathlib import Path

import pytest

KINDS = {
    "colorize": {
        "alpha": 2.5,
        "beta": 0.0,
        "color_space": "cielab",
        "neighbors": "4",
        "blend": "nearest",
        "nearest": 5,
    },
    "match": {"matching": "paper", "slic_segments": 77, "hog_window": 40},
}


@pytest.fixture(autouse=True)
def labels(blender):
    """Blender writes the name of the preset that was used last into the label of its menu."""
    menus = [getattr(blender.types, f"REFLCOLOR_PT_{kind}_presets") for kind in KINDS]
    before = [menu.bl_label for menu in menus]
    yield
    for menu, label in zip(menus, before, strict=True):
        menu.bl_label = label


@pytest.mark.parametrize("kind", KINDS)
def test_settings_are_kept_taken_over_and_removed(blender, kind):
    act = getattr(blender.ops.reflcolor, f"add_{kind}_preset")
    settings = blender.context.scene.reflcolor
    for name, value in KINDS[kind].items():
        setattr(settings, name, value)
    assert act(name="Dark Halls") == {"FINISHED"}
    path = blender.utils.preset_find("Dark_Halls", f"reflcolor/{kind}", ext=".py")
    assert path is not None and path.startswith(blender.utils.resource_path("USER"))
    blender.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    settings = blender.context.scene.reflcolor
    assert {name: getattr(settings, name) for name in KINDS[kind]} != KINDS[kind]
    blender.ops.script.execute_preset(filepath=path, menu_idname=f"REFLCOLOR_PT_{kind}_presets")
    assert {name: getattr(settings, name) for name in KINDS[kind]} == KINDS[kind]
    act(name="Dark Halls", remove_name=True)
    assert blender.utils.preset_find("Dark_Halls", f"reflcolor/{kind}", ext=".py") is None


def test_a_preset_of_the_colorization_leaves_the_search_alone(blender):
    settings = blender.context.scene.reflcolor
    settings.slic_segments = 321
    blender.ops.reflcolor.add_colorize_preset(name="Mine")
    settings.slic_segments, settings.alpha = 123, 9.0
    path = blender.utils.preset_find("Mine", "reflcolor/colorize", ext=".py")
    blender.ops.script.execute_preset(filepath=path, menu_idname="REFLCOLOR_PT_colorize_presets")
    assert (settings.slic_segments, settings.alpha) == (123, 3.0)
    blender.ops.reflcolor.add_colorize_preset(name="Mine", remove_name=True)


def test_a_preset_kept_before_the_light_could_be_chosen_takes_it_from_the_reflectance(blender):
    settings = blender.context.scene.reflcolor
    blender.ops.reflcolor.add_colorize_preset(name="Older")
    path = Path(blender.utils.preset_find("Older", "reflcolor/colorize", ext=".py"))
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join(line for line in lines if "settings.light" not in line), encoding="utf-8")
    assert settings.light == 1
    blender.ops.script.execute_preset(filepath=str(path), menu_idname="REFLCOLOR_PT_colorize_presets")
    assert settings.light == 0
    blender.ops.reflcolor.add_colorize_preset(name="Older", remove_name=True)
