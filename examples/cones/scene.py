"""Two road cones of different colors on a planked floor before a wall, and what may lie around there."""

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

WALL_Y = 4.0


def build():
    """Build the scene in an empty Blender; return it."""
    scene = empty_scene()
    _room()
    _cone("orange cone", (-0.55, 2.85), "#e8501a", 0.74)
    _cone("blue cone", (0.42, 2.65), "#2358a8", 0.70)
    _clutter()
    sky("#b9d0ee", 0.75)
    area_light("ceiling lamp", (-1.4, 0.9, 2.9), (0.2, 3.1, 0.2), 0.7, 120, "#fff1dc")
    area_light("side lamp", (2.3, 0.6, 2.2), (0.0, 3.2, 0.3), 1.4, 30, "#eaf2ff")
    return scene


def _room():
    planks = courses(
        "planks",
        ("#8d5f38", "#b58658", "#3a2616"),
        (0.56, 0.80, 0.15),
        (1.3, 0.14),
        joint_m=0.004,
        grain=0.16,
        axes="XY",
    )
    plaster = paint("plaster", "#dcb673", 0.60, roughness=0.9, variation=0.10, grain_per_m=2.2)
    white = paint("white paint", "#ece9e0", 0.92)
    box("floor", (0, 1.5, -0.05), (8, 7, 0.1), planks)
    # The wall leaves a window free at the right, behind which there is nothing to hit.
    left, right, sill, lintel, thick = 0.95, 1.95, 1.05, 2.05, 0.2
    y = WALL_Y + thick / 2
    box("wall left", ((left - 4) / 2, y, 1.5), (4 + left, thick, 3), plaster)
    box("wall right", ((right + 4) / 2, y, 1.5), (4 - right, thick, 3), plaster)
    box("wall below", ((left + right) / 2, y, sill / 2), (right - left, thick, sill), plaster)
    box("wall above", ((left + right) / 2, y, (lintel + 3) / 2), (right - left, thick, 3 - lintel), plaster)
    box("sill", ((left + right) / 2, WALL_Y - 0.04, sill + 0.015), (right - left + 0.16, 0.14, 0.03), white)
    for x in (left + 0.025, (left + right) / 2, right - 0.025):
        box("upright", (x, WALL_Y + 0.08, (sill + lintel) / 2), (0.05, 0.06, lintel - sill), white)
    box("skirting", (0, WALL_Y - 0.01, 0.05), (8, 0.02, 0.1), white)


def _cone(name, place, color, nir):
    rubber = paint(f"{name} foot", "#1b1b1d", 0.10, roughness=0.8)
    body = paint(name, color, nir, roughness=0.45)
    band = paint(f"{name} band", "#f2f2ee", 1.05, roughness=0.5)
    box(f"{name} foot", (*place, 0.02), (0.42, 0.42, 0.04), rubber, turn_deg=14)
    low, high, top = 0.15, 0.028, 0.76

    def ring(height, slot):
        return (low + (high - low) * (height - 0.04) / (top - 0.04), height, slot)

    rings = [ring(0.065, 0), ring(0.25, 0), ring(0.39, 1), ring(0.51, 0), ring(0.61, 1), ring(top, 0)]
    lathe(name, (*place, 0), [(0.17, 0.03, 0), (0.17, 0.05, 0), *rings], [body, band])


def _clutter():
    card = paint("cardboard", "#b08a5a", 0.58, variation=0.05)
    tape = paint("tape", "#c9b48a", 0.80, roughness=0.3)
    box("carton", (-1.52, 3.45, 0.24), (0.62, 0.46, 0.48), card, turn_deg=-16)
    box("tape", (-1.52, 3.45, 0.4805), (0.07, 0.462, 0.001), tape, turn_deg=-16)
    green = paint("green paint", "#3f8a45", 0.66, roughness=0.4)
    box("crate", (-1.50, 3.42, 0.59), (0.34, 0.26, 0.22), green, turn_deg=9)
    red = paint("red plastic", "#b3202a", 0.72, roughness=0.35)
    lathe("bucket", (1.25, 3.3, 0), [(0.12, 0, 0), (0.165, 0.3, 0), (0.175, 0.3, 0), (0.175, 0.33, 0)], [red])
    ball("ball", (-0.05, 3.3, 0.13), (0.13, 0.13, 0.13), paint("yellow ball", "#e9c21c", 0.78, roughness=0.4))
    black = paint("soot", "#101012", 0.008, roughness=0.7)
    lathe("stovepipe", (0.74, 3.62, 0), [(0.085, 0, 0), (0.085, 0.62, 0)], [black])
    wood = paint("broomstick", "#c8a36a", 0.60)
    rod("broomstick", (-0.98, 3.72, 0.06), (-0.80, 3.96, 1.50), 0.014, wood)
    box("broom", (-0.98, 3.72, 0.05), (0.34, 0.08, 0.10), paint("bristles", "#5b3d8a", 0.45, roughness=0.9), turn_deg=8)
    _poster((-0.28, WALL_Y - 0.004, 1.36))


def _poster(center):
    x, y, z = center
    paper = paint("poster paper", "#e7e3d4", 0.90)
    inks = [
        paint(f"poster ink {i}", c, nir)
        for i, (c, nir) in enumerate((("#1f7f8c", 0.42), ("#d8432f", 0.70), ("#f0b429", 0.74)))
    ]

    def sheet(name, left, bottom, right, top, depth, material):
        panel(
            name,
            [
                (x + left, y - depth, z + bottom),
                (x + right, y - depth, z + bottom),
                (x + right, y - depth, z + top),
                (x + left, y - depth, z + top),
            ],
            material,
        )

    sheet("poster", -0.32, -0.40, 0.32, 0.40, 0.0, paper)
    sheet("poster top", -0.26, 0.10, 0.26, 0.34, 0.001, inks[0])
    sheet("poster left", -0.26, -0.34, -0.03, 0.04, 0.001, inks[1])
    sheet("poster right", 0.03, -0.34, 0.26, 0.04, 0.001, inks[2])
