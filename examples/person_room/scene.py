"""A person beside a table with chairs, before a shelf, with the clutter that gathers in a room."""

import numpy as np

from examples.scenes.building import (
    area_light,
    ball,
    box,
    courses,
    empty_scene,
    lathe,
    paint,
    panel,
    rod,
    sky,
)

WALL_Y = 4.4
_TABLE_TOP = 0.74


def build():
    """Build the scene in an empty Blender; return it."""
    scene = empty_scene()
    _room()
    _person((-0.55, 2.75))
    _table((0.55, 3.0))
    _chair("near chair", (0.62, 2.25), 176, "#2f6f62")
    _chair("far chair", (1.45, 3.15), -95, "#c98a1e")
    _shelf((-1.75, WALL_Y - 0.17))
    _clutter()
    sky("#c4d4ea", 0.55)
    area_light("lamp", (0.3, 1.6, 2.65), (0.2, 3.0, 0.0), 0.9, 90, "#fff0d6")
    area_light("window light", (-2.6, 1.2, 1.9), (0.0, 3.2, 0.8), 1.2, 55, "#e6efff")
    return scene


def _room():
    tiles = courses(
        "tiles", ("#b9b2a3", "#a39a88", "#5f5a50"), (0.48, 0.62, 0.30), (0.40, 0.40), joint_m=0.008, offset=0.0
    )
    wall = paint("blue-gray wall", "#a9bcc2", 0.66, roughness=0.9, variation=0.06, grain_per_m=2.0)
    side = paint("cream wall", "#e6dcc0", 0.74, roughness=0.9, variation=0.05, grain_per_m=2.0)
    white = paint("white paint", "#ece9e0", 0.90)
    box("floor", (0, 1.4, -0.05), (7, 7, 0.1), tiles)
    box("back wall", (0, WALL_Y + 0.1, 1.4), (7, 0.2, 2.8), wall)
    box("left wall", (-2.9, 1.4, 1.4), (0.2, 7, 2.8), side)
    box("right wall", (2.9, 1.4, 1.4), (0.2, 7, 2.8), side)
    box("skirting", (0, WALL_Y - 0.01, 0.05), (5.6, 0.02, 0.1), white)
    box("rug", (0.1, 2.6, 0.006), (2.2, 1.5, 0.012), paint("rug", "#8c2f3a", 0.52, roughness=1.0), turn_deg=4)
    box(
        "rug border",
        (0.1, 2.6, 0.003),
        (2.4, 1.7, 0.006),
        paint("rug border", "#d9c69a", 0.72, roughness=1.0),
        turn_deg=4,
    )
    # A door that stands dark and open: little comes back from there.
    box("doorway", (2.05, WALL_Y - 0.002, 1.0), (0.8, 0.004, 2.0), paint("darkness", "#08080a", 0.004))
    for x in (1.61, 2.49):
        box("door frame", (x, WALL_Y - 0.02, 1.02), (0.08, 0.06, 2.04), white)
    box("door frame", (2.05, WALL_Y - 0.02, 2.06), (0.96, 0.06, 0.08), white)


def _person(place):
    x, y = place
    skin = paint("skin", "#c98f6b", 0.60, roughness=0.5)
    jeans = paint("jeans", "#2c4468", 0.62, roughness=0.9, variation=0.08)
    shirt = paint("shirt", "#b5382f", 0.72, roughness=0.9)
    hair = paint("hair", "#2b1c14", 0.28, roughness=0.6)
    shoes = paint("shoes", "#e2e0da", 0.80, roughness=0.5)
    belt = paint("belt", "#3a2718", 0.40)
    for side in (-1, 1):
        hip, knee, ankle = (x + side * 0.10, y, 0.92), (x + side * 0.12, y - 0.03, 0.50), (x + side * 0.13, y, 0.09)
        rod("thigh", knee, hip, 0.068, jeans, end_radius=0.092)
        rod("shin", ankle, knee, 0.052, jeans, end_radius=0.068)
        ball("knee", knee, (0.069, 0.069, 0.069), jeans)
        ball("shoe", (x + side * 0.14, y - 0.05, 0.045), (0.055, 0.135, 0.05), shoes, turn_deg=-side * 12)
        shoulder, elbow = np.array((x + side * 0.205, y, 1.42)), np.array((x + side * 0.29, y - 0.02, 1.14))
        hand = np.array((x + side * 0.27, y - 0.16, 0.93))
        rod("upper arm", elbow, shoulder, 0.044, shirt, end_radius=0.058)
        rod("forearm", hand, elbow, 0.030, skin, end_radius=0.043)
        ball("shoulder", shoulder, (0.066, 0.066, 0.06), shirt)
        ball("elbow", elbow, (0.045, 0.045, 0.045), skin)
        ball("hand", np.add(hand, (0, -0.03, -0.04)), (0.035, 0.04, 0.065), skin)
    torso = lathe(
        "torso",
        (x, y, 0),
        [(0.165, 0.95, 0), (0.155, 1.08, 0), (0.185, 1.30, 0), (0.17, 1.44, 0), (0.06, 1.50, 0)],
        [shirt],
    )
    hips = lathe(
        "hips", (x, y, 0), [(0.10, 0.82, 0), (0.168, 0.90, 0), (0.166, 0.955, 0), (0.166, 0.985, 1)], [jeans, belt]
    )
    # A body is broader than it is deep.
    torso.location.y = hips.location.y = y
    torso.scale = hips.scale = (1.1, 0.66, 1.0)
    rod("neck", (x, y, 1.46), (x, y - 0.01, 1.58), 0.055, skin)
    ball("head", (x, y - 0.015, 1.68), (0.078, 0.098, 0.115), skin)
    ball("hair", (x, y + 0.012, 1.715), (0.086, 0.098, 0.098), hair)
    ball("nose", (x, y - 0.112, 1.665), (0.014, 0.02, 0.022), skin)


def _table(place):
    x, y = place
    wood = courses(
        "table wood", ("#9c6b3f", "#b07c4b", "#8a5b34"), (0.60, 0.74, 0.52), (1.6, 0.11), joint_m=0.001, grain=0.14
    )
    box("table top", (x, y, _TABLE_TOP - 0.015), (1.3, 0.72, 0.03), wood)
    for dx in (-0.58, 0.58):
        for dy in (-0.30, 0.30):
            box("table leg", (x + dx, y + dy, 0.355), (0.05, 0.05, 0.71), wood)
    gray, dark = paint("laptop", "#8d9096", 0.45, roughness=0.3), paint("screen", "#101418", 0.03, roughness=0.2)
    box("keyboard", (x - 0.22, y + 0.05, _TABLE_TOP + 0.009), (0.33, 0.23, 0.018), gray, turn_deg=6)
    screen = box("screen", (x - 0.235, y + 0.19, _TABLE_TOP + 0.13), (0.33, 0.01, 0.22), dark, turn_deg=6)
    screen.rotation_euler.x = np.radians(-15)
    mug = paint("mug", "#1e7fb8", 0.70, roughness=0.25)
    lathe("mug", (x + 0.12, y - 0.14, _TABLE_TOP), [(0.038, 0, 0), (0.041, 0.09, 0)], [mug])
    lathe(
        "bowl",
        (x + 0.38, y + 0.02, _TABLE_TOP),
        [(0.06, 0, 0), (0.12, 0.06, 0), (0.125, 0.07, 0)],
        [paint("bowl", "#e8e4d8", 0.85)],
    )
    for dx, dy, color, nir in (
        (-0.04, 0, "#d8911c", 0.78),
        (0.05, 0.02, "#b3261e", 0.74),
        (0.0, -0.05, "#6d9a2a", 0.68),
    ):
        ball(
            "fruit", (x + 0.38 + dx, y + 0.02 + dy, _TABLE_TOP + 0.09), (0.042, 0.042, 0.04), paint("fruit", color, nir)
        )
    for level, (color, nir) in enumerate((("#3b5b8c", 0.55), ("#c7b13c", 0.78), ("#6b2d5c", 0.50))):
        box(
            "book",
            (x - 0.48, y - 0.16, _TABLE_TOP + 0.016 + 0.032 * level),
            (0.16, 0.22, 0.03),
            paint("book", color, nir),
            turn_deg=8 - 9 * level,
        )


def _chair(name, place, turn_deg, color):
    seat, legs = paint(f"{name} seat", color, 0.64, roughness=0.7), paint(f"{name} legs", "#b9a27c", 0.66)
    turn = np.radians(turn_deg)

    def at(dx, dy, z):
        return place[0] + dx * np.cos(turn) - dy * np.sin(turn), place[1] + dx * np.sin(turn) + dy * np.cos(turn), z

    box(name, at(0, 0, 0.45), (0.42, 0.42, 0.035), seat, turn_deg=turn_deg)
    box(f"{name} back", at(0, -0.19, 0.78), (0.40, 0.025, 0.22), seat, turn_deg=turn_deg)
    for dx in (-0.18, 0.18):
        rod(f"{name} leg", at(dx, 0.18, 0), at(dx, 0.18, 0.44), 0.016, legs)
        rod(f"{name} leg", at(dx, -0.19, 0), at(dx, -0.19, 0.88), 0.016, legs)


def _shelf(place):
    x, y = place
    board = paint("shelf", "#d7c4a0", 0.76)
    for side in (-0.48, 0.48):
        box("shelf side", (x + side, y, 0.9), (0.03, 0.3, 1.8), board)
    levels = (0.06, 0.48, 0.90, 1.32, 1.785)
    for z in levels:
        box("shelf board", (x, y, z), (0.96, 0.3, 0.03), board)
    spines = [
        ("#8f1f24", 0.66),
        ("#24507c", 0.50),
        ("#e0c64a", 0.80),
        ("#2f7048", 0.58),
        ("#e8e2d0", 0.88),
        ("#3d3a45", 0.30),
        ("#d46a1f", 0.74),
        ("#7a4a86", 0.56),
    ]
    paints = [paint(f"spine {i}", color, nir, roughness=0.6) for i, (color, nir) in enumerate(spines)]
    # Widths and heights as if by chance, but always the same.
    random = np.random.RandomState(7)
    for z in levels[:-1]:
        left = x - 0.455
        while left < x + 0.36:
            width, height, which = (
                0.03 + 0.035 * random.rand(),
                0.24 + 0.10 * random.rand(),
                random.randint(len(paints)),
            )
            if random.rand() < 0.12:
                left += 0.10
                continue
            box(
                "spine",
                (left + width / 2, y - 0.03, z + 0.015 + height / 2),
                (width - 0.002, 0.2, height),
                paints[which],
            )
            left += width


def _clutter():
    pot, leaves = paint("pot", "#b5562f", 0.66, roughness=0.8), paint("leaves", "#3f7a2c", 0.82, roughness=0.6)
    lathe("pot", (-1.0, 3.95, 0), [(0.11, 0, 0), (0.15, 0.26, 0), (0.16, 0.26, 0), (0.16, 0.30, 0)], [pot])
    random = np.random.RandomState(3)
    for _ in range(26):
        angle, lean, size = random.rand() * 2 * np.pi, 0.08 + 0.30 * random.rand(), 0.45 + 0.45 * random.rand()
        root = np.array((-1.0, 3.95, 0.28))
        tip = np.add(root, (lean * np.cos(angle), lean * np.sin(angle), size))
        across = 0.035 * np.array((-np.sin(angle), np.cos(angle), 0))
        middle = root + 0.6 * (tip - root) + (0, 0, 0.06)
        panel("leaf", [root, middle - across, tip, middle + across], leaves)
    bag = paint("backpack", "#2b5d3a", 0.60, roughness=0.9)
    ball("backpack", (0.05, 3.85, 0.21), (0.19, 0.13, 0.22), bag)
    box("backpack pocket", (0.05, 3.73, 0.15), (0.22, 0.06, 0.18), paint("pocket", "#d06a22", 0.74, roughness=0.9))
    lathe(
        "basket",
        (1.85, 2.55, 0),
        [(0.13, 0, 0), (0.17, 0.30, 0), (0.17, 0.33, 1)],
        [paint("basket", "#a3834c", 0.60, variation=0.2, grain_per_m=40.0), paint("basket rim", "#4d3a20", 0.44)],
    )
    ball("ball of wool", (-1.35, 2.75, 0.085), (0.085, 0.085, 0.085), paint("wool", "#d9559a", 0.80, roughness=1.0))
    box(
        "parcel",
        (-1.9, 3.0, 0.16),
        (0.42, 0.34, 0.32),
        paint("cardboard", "#b08a5a", 0.58, variation=0.05),
        turn_deg=24,
    )
    _picture((0.5, WALL_Y - 0.012, 1.62))


def _picture(center):
    x, y, z = center
    box("picture frame", center, (0.9, 0.024, 0.62), paint("picture frame", "#4a3222", 0.46))
    y -= 0.0125
    bands = (("#7fb2d8", 0.62, 0.26, 0.0), ("#d9b65a", 0.80, 0.0, -0.10), ("#5c8a3a", 0.74, -0.10, -0.26))
    for color, nir, top, bottom in bands:
        corners = [(x - 0.4, y, z + bottom), (x + 0.4, y, z + bottom), (x + 0.4, y, z + top), (x - 0.4, y, z + top)]
        panel("picture", corners, paint(f"picture {color}", color, nir))
    hill = [(x - 0.4, y - 0.001, z - 0.1), (x + 0.1, y - 0.001, z - 0.1), (x - 0.18, y - 0.001, z + 0.14)]
    panel("hill", hill, paint("hill", "#6f5f8c", 0.48))
