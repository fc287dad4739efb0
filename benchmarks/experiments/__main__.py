"""The paper's three experiments made anew: python -m benchmarks.experiments FOLDER

Simulates the scenes that are not in FOLDER yet, colorizes them from seeds, and writes the pictures of
docs/experiments.md to FOLDER as JPEG; prints the tables of that page. Needs the zip of `make build`, and about a
quarter of an hour.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from benchmarks.experiments import cases, meshes, pictures, tables
from reflcolor_addon import Seeds, Settings, colorize
from reflcolor_addon.files.images import read_image
from reflcolor_addon.matching import match_site
from reflcolor_addon.settings import PRESETS


def picked_by_hand(group):
    """Method 1."""
    return [(Seeds.load(case.seeds, case.photos), None) for case in group]


def found_by_program(group):
    """Method 2, verified."""
    found = match_site([case.scan for case in group], group[0].photos)
    return [(matching.seeds, matching.observed) for matching in found]


# Each gives, for all scans that are colorized from the same photos, the seeds and what the photos saw of the scan.
METHODS = {"Method 1": picked_by_hand, "Method 2": found_by_program}
SETTINGS = {"Yatziv": Settings(beta=0)} | {name: Settings.preset(name) for name in reversed(PRESETS)}
# Side by side in pictures and tables.
COMPARED = ("Paper", "Natural")
WIDTH = 1200
# Where the whole house is looked at from: place, target, field of view.
HOUSE_VIEWS = (((-13.5, -15.5, 8.5), (0.2, 0.3, 2.1), 36.0), ((14.5, 14.5, 8.5), (-0.2, 0.0, 2.1), 36.0))


def main():
    parser = argparse.ArgumentParser(prog="python -m benchmarks.experiments", description=__doc__.partition("\n")[0])
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    parser.add_argument(
        "--method", type=int, choices=(1, 2), help="one of the two alone; finding seeds takes the longer"
    )
    arguments = parser.parse_args()
    folder, chosen = arguments.folder, arguments.method
    folder.mkdir(parents=True, exist_ok=True)
    found = cases.load(folder)
    groups = {}
    for case in found:
        groups.setdefault((case.scene, case.variant), []).append(case)
    results = {}
    methods = {name: seeds_of for name, seeds_of in METHODS.items() if chosen is None or name.endswith(str(chosen))}
    for method, seeds_of in methods.items():
        for key, group in groups.items():
            colors = seeds_of(group)
            for preset in COMPARED:
                results[method, preset, key] = [
                    colorize(case.scan, seeds, SETTINGS[preset], observed=observed)
                    for case, (seeds, observed) in zip(group, colors, strict=True)
                ]
    print_tables(groups, results, methods)
    renderer = meshes.Renderer(folder)
    draw_flat(folder, groups, results, methods)
    draw_meshes(folder, groups, results, methods, renderer)
    sys.stdout.flush()
    renderer.end(0)


def print_tables(groups, results, methods):
    """All figures of docs/experiments.md."""
    for method in methods:
        rows = [
            tables.method_row(case, *colored)
            for key, group in groups.items()
            for case, *colored in zip(group, *(results[method, preset, key] for preset in COMPARED), strict=True)
        ]
        print(f"\n{method}, mean CIEDE2000\n\n{tables.table(tables.METHOD_TITLES, rows)}", flush=True)
    hand = [
        (case, own)
        for key, group in groups.items()
        if key[1] != cases.HOUSE_PHOTOS["one_photo"]
        for case, (own, _) in zip(group, picked_by_hand(group), strict=True)
    ]
    true = [(case, replace(own, rgb=case.truth[own.rows, own.cols])) for case, own in hand]
    for colors, seeded in (("of the photos", hand), ("that are true", true)):
        rows = [tables.range_row(case, own, SETTINGS["Yatziv"], SETTINGS["Paper"]) for case, own in seeded]
        print(f"\nbeta 0 → beta 1, seeds by hand with colors {colors}\n\n{tables.table(tables.RANGE_TITLES, rows)}")
    rows = [
        tables.settings_row(case, (own, truly), SETTINGS.values())
        for (case, own), (_, truly) in zip(hand, true, strict=True)
    ]
    print(f"\nPresets, colors of the photos / true\n\n{tables.table(['scan', *SETTINGS], rows)}", flush=True)


def draw_flat(folder, groups, results, methods):
    """Inputs, seeds and colorized images."""
    for (scene, variant), group in groups.items():
        name, kind = scene.replace(" ", ""), f"_{variant}".replace(" ", "_") if variant else ""
        photos = [read_image(photo) for photo in group[0].photos]
        scans = [[draw(case.scan) for case in group] for draw in (pictures.range_image, pictures.reflectance_image)]
        if len(group) == 1:
            save(folder, f"{name}_input", [[scans[0][0], scans[1][0], *photos]])
        elif variant != cases.HOUSE_PHOTOS["one_photo"]:
            save(folder, f"{name}_input", [*scans, photos])
        for method in methods:
            colored = [results[method, preset, (scene, variant)] for preset in COMPARED]
            seeds = [pictures.seeds_image(case.scan, own.seeds) for case, own in zip(group, colored[0], strict=True)]
            images = [[result.rgb for result in of_preset] for of_preset in colored]
            rows = [seeds, *images, [case.truth for case in group]]
            if len(group) == 1:
                # Two by two.
                first, second, third, fourth = (row[0] for row in rows)
                rows = [[first, second], [third, fourth]]
            save(folder, f"{name}{kind}_{slug(method)}", rows)
        if len(group) == 1:
            (case,), ((own, _),) = group, picked_by_hand(group)
            compared = [colorize(case.scan, own, SETTINGS[name]).rgb for name in ("Yatziv", "Paper")]
            save(folder, f"{name}_range", [compared])


def draw_meshes(folder, groups, results, methods, renderer):
    """The gray mesh, one that Paper colored and all that Natural did; of scene 3 from two sides."""
    scenes = {}
    for (scene, _variant), group in groups.items():
        scenes.setdefault(scene, [case.scan for case in group])
    for scene, scans in scenes.items():
        own = [key for key in groups if key[0] == scene]
        first = next(iter(methods))
        shown = [(first, "Paper", own[-1]), *((method, "Natural", key) for method in methods for key in own)]
        colors = [[result.rgb for result in results[name]] for name in shown]
        rows = [
            [renderer.picture(scans, view=view), *(renderer.picture(scans, rgb, view) for rgb in colors)]
            for view in (HOUSE_VIEWS if len(scans) > 1 else (None,))
        ]
        save(folder, f"{scene.replace(' ', '')}_mesh", rows)


def save(folder, name, rows):
    pictures.write_jpeg(folder / f"{name}.jpg", pictures.sheet(rows, WIDTH))


def slug(words):
    return words.lower().replace(" ", "")


if __name__ == "__main__":
    main()
