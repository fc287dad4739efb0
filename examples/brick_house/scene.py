"""A small brick house with a tiled roof in a garden, made to be looked at from all sides."""

import numpy as np

from examples.scenes.building import ball, box, courses, empty_scene, lathe, paint, panel, rod, sky, sun

# Half the house's length along X and depth along Y; height of eaves and ridge.
_HALF_X, _HALF_Y, _EAVES, _RIDGE = 4.0, 3.0, 2.9, 5.0


def build():
    """Build the scene in an empty Blender; return it."""
    scene = empty_scene()
    _garden()
    _walls()
    _roof()
    _openings()
    _around()
    sky("#9fc0ea", 0.85)
    sun("sun", (0.45, 0.75, -0.85), 3.2, angle_deg=1.0, color="#fff2dc")
    return scene


def _garden():
    lawn = paint("lawn", "#567f35", 0.62, roughness=1.0, variation=0.30, grain_per_m=1.6)
    gravel = paint("gravel", "#b3a58d", 0.55, roughness=1.0, variation=0.22, grain_per_m=30.0)
    box("lawn", (0, 0, -0.05), (44, 44, 0.1), lawn)
    box("path", (-1.2, -9.0, 0.005), (1.3, 12.0, 0.01), gravel)
    box(
        "plinth",
        (0, 0, 0.15),
        (2 * _HALF_X + 0.12, 2 * _HALF_Y + 0.12, 0.3),
        paint("plinth", "#8c8a84", 0.42, variation=0.1),
    )


def _walls():
    colors, nirs, size = ("#8e3b2a", "#b25a3e", "#c9c0ae"), (0.48, 0.62, 0.78), (0.25, 0.083)
    along_x = courses("bricks along X", colors, nirs, size, joint_m=0.010, axes="XZ", roughness=0.9)
    along_y = courses("bricks along Y", colors, nirs, size, joint_m=0.010, axes="YZ", roughness=0.9)
    middle = (_EAVES + 0.3) / 2
    for side in (-1, 1):
        box("long wall", (0, side * (_HALF_Y - 0.1), middle), (2 * _HALF_X, 0.2, _EAVES - 0.3), along_x)
        x = side * (_HALF_X + 0.004)
        corners = [(x, -_HALF_Y, 0.3), (x, _HALF_Y, 0.3), (x, _HALF_Y, _EAVES), (x, 0, _RIDGE), (x, -_HALF_Y, _EAVES)]
        panel("gable", corners[::side], along_y)


def _roof():
    tiles = courses(
        "roof tiles", ("#5a3a34", "#7a4b3c", "#2e1f1c"), (0.34, 0.46, 0.16), (0.28, 0.32), joint_m=0.014, roughness=0.7
    )
    white = paint("white wood", "#e9e6dc", 0.88)
    slope = np.hypot(_HALF_Y, _RIDGE - _EAVES)
    angle = np.arctan2(_RIDGE - _EAVES, _HALF_Y)
    for side in (-1, 1):
        length = slope + 0.5
        item = box("roof", (0, 0, 0), (2 * _HALF_X + 0.7, length, 0.12), tiles)
        item.rotation_euler = (-side * angle, 0, 0)
        item.location = (0, side * length / 2 * np.cos(angle), _RIDGE + 0.08 - length / 2 * np.sin(angle))
        box("gutter", (0, side * (_HALF_Y + 0.40), _EAVES - 0.22), (2 * _HALF_X + 0.7, 0.12, 0.12), white)
    bricks = courses(
        "chimney bricks", ("#8e3b2a", "#b25a3e", "#c9c0ae"), (0.48, 0.62, 0.78), (0.25, 0.083), joint_m=0.01, axes="XZ"
    )
    box("chimney", (2.3, 0.7, 4.9), (0.6, 0.6, 1.6), bricks)


def _openings():
    white, glass = paint("window frame", "#f0eee6", 0.90), paint("glass", "#1c2730", 0.006, roughness=0.05)
    blue, red = paint("shutters", "#2f5f96", 0.60), paint("shutters red", "#9c2a2a", 0.70)
    green = paint("door", "#1f5c43", 0.56, roughness=0.4)
    for x in (-2.9, 0.6, 2.6):
        _window((x, -_HALF_Y, 1.75), "x", -1, white, glass, blue)
    for x in (-2.4, 0.0, 2.4):
        _window((x, _HALF_Y, 1.75), "x", 1, white, glass, red)
    for y in (-1.2, 1.3):
        _window((_HALF_X, y, 1.75), "y", 1, white, glass, blue)
    _window((-_HALF_X, 0.0, 1.75), "y", -1, white, glass, red)
    _window((-_HALF_X, 0.0, 3.55), "y", -1, white, glass, None)
    box("door", (-1.2, -_HALF_Y - 0.02, 1.30), (0.95, 0.08, 2.0), green)
    box("door frame", (-1.2, -_HALF_Y - 0.01, 1.33), (1.13, 0.06, 2.1), white)
    box("doorstep", (-1.2, -_HALF_Y - 0.35, 0.12), (1.5, 0.7, 0.24), paint("stone", "#a9a59b", 0.5, variation=0.1))
    ball("door knob", (-0.85, -_HALF_Y - 0.10, 1.25), (0.04, 0.04, 0.04), paint("brass", "#c9a23a", 0.85, metallic=1.0))
    box("back door", (3.3, _HALF_Y + 0.02, 1.25), (0.9, 0.08, 1.9), paint("back door", "#c28a2c", 0.72))


def _window(center, axis, side, frame, glass, shutter):
    def part(name, along, depth, up, size, material):
        x, y, z = center
        if axis == "x":
            box(name, (x + along, y + side * depth, z + up), (size[0], size[1], size[2]), material)
        else:
            box(name, (x + side * depth, y + along, z + up), (size[1], size[0], size[2]), material)

    part("pane", 0, 0.005, 0, (0.9, 0.01, 1.1), glass)
    for along in (-0.47, 0, 0.47):
        part("frame", along, 0.03, 0, (0.07, 0.06, 1.2), frame)
    for up in (-0.57, 0, 0.57):
        part("frame", 0, 0.03, up, (1.0, 0.06, 0.07), frame)
    part("sill", 0, 0.07, -0.64, (1.15, 0.16, 0.05), frame)
    if shutter is not None:
        for along in (-0.76, 0.76):
            part("shutter", along, 0.025, 0, (0.46, 0.05, 1.2), shutter)


def _around():
    bark, crown = (
        paint("bark", "#5b4632", 0.44, variation=0.2),
        paint("crown", "#3f6b2a", 0.74, variation=0.3, grain_per_m=5),
    )
    random = np.random.RandomState(11)
    for x, y, size in ((6.4, -2.6, 1.0), (-6.6, 3.8, 1.2), (5.6, 5.4, 0.8)):
        rod("trunk", (x, y, 0), (x, y, 2.0 * size), 0.16 * size, bark, end_radius=0.10 * size)
        for _ in range(9):
            offset = (random.rand(3) - 0.5) * (1.6, 1.6, 1.3) * size
            radius = (0.45 + 0.35 * random.rand()) * size
            ball("crown", (x + offset[0], y + offset[1], 2.6 * size + offset[2]), (radius, radius, radius), crown)
    hedge = paint("hedge", "#2f5a2c", 0.70, variation=0.35, grain_per_m=9.0)
    box("hedge", (-7.6, -2.0, 0.5), (0.7, 6.0, 1.0), hedge)
    box("hedge", (7.4, 1.5, 0.5), (0.7, 5.0, 1.0), hedge)
    flowers = (("#d8372f", 0.72), ("#e8c22c", 0.82), ("#8a4bb0", 0.62))
    paints = [paint(f"flower {color}", color, nir) for color, nir in flowers]
    for i in range(21):
        x, y = 0.2 + 0.17 * i, -_HALF_Y - 0.45 - 0.18 * random.rand()
        ball("leaves", (x, y, 0.12), (0.13, 0.13, 0.13), hedge)
        ball("flower", (x, y - 0.03, 0.30), (0.075, 0.075, 0.06), paints[i % 3])
    barrel = paint("barrel", "#3d6fa3", 0.66, roughness=0.4)
    lathe("barrel", (_HALF_X + 0.5, -2.3, 0), [(0.30, 0, 0), (0.36, 0.45, 0), (0.30, 0.9, 0)], [barrel])
    box("bench", (-2.6, _HALF_Y + 0.9, 0.45), (1.5, 0.4, 0.05), paint("bench", "#a8763e", 0.62))
    for x in (-3.2, -2.0):
        box("bench leg", (x, _HALF_Y + 0.9, 0.21), (0.06, 0.36, 0.42), paint("bench leg", "#3a3a3c", 0.3))
    bin_body, bin_lid = paint("bin", "#2c6b3c", 0.58, roughness=0.5), paint("bin lid", "#e0b52c", 0.80, roughness=0.5)
    box("bin", (-_HALF_X - 0.55, -1.7, 0.5), (0.55, 0.6, 1.0), bin_body, turn_deg=6)
    box("bin lid", (-_HALF_X - 0.55, -1.7, 1.03), (0.6, 0.66, 0.06), bin_lid, turn_deg=6)
