"""The rooms of the house: which may import which, and that no import leads in a circle (docs/architecture.md)."""

import ast
import re
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
CORE = "reflcolor_addon"
# Modules of the core's ground floor, which every room may import.
GROUND = {
    "bundled",
    "declaration",
    "errors",
    "failures",
    "messages",
    "progress",
    "settings",
    "srgb",
    "threads",
    "version",
}
# What each room may import besides itself and the ground floor. Data walks from the top of this list to its end.
ROOMS = {
    "native": set(),
    "scan": set(),
    "files": {"native", "scan"},
    "seeds": {"scan", "files"},
    "geodesic": {"native", "scan"},
    "color": {"native", "scan", "files", "seeds", "geodesic"},
    "matching": {"scan", "files", "seeds", "geodesic", "color"},
    "simulation": {"scan", "color"},
    "view": {"scan", "seeds", "color"},
    "report": {"scan", "files", "seeds", "color", "view"},
    "batch": {"scan", "files", "seeds", "geodesic", "color", "matching", "report", "view"},
    "cli": {"scan", "files", "seeds", "color", "matching", "simulation", "report", "view", "batch"},
}
# The same for what ties the core to Blender; each may use all of the core.
BLENDER_ROOMS = {
    "operators.scene": set(),
    "operators.window": {"operators.scene"},
    "operators.overlays": {"operators.scene", "operators.window"},
    "operators": {"operators.scene", "operators.overlays", "operators.window"},
    "panels": {"operators", "operators.scene", "operators.overlays", "operators.window"},
}

_BUNDLED = {"cv2", "lazy_loader", "scipy", "skimage", "pye57", "OpenEXR", "laspy", "lazrs"}
_ROW = re.compile(r"^\| `([\w/]+)` \| [^|]+ \| ([^|]*?) ?\|$", re.MULTILINE)


def _module_name(path):
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def _modules():
    paths = [path for folder in (CORE, "operators", "panels") for path in sorted((ROOT / folder).rglob("*.py"))]
    return {_module_name(path): path for path in paths}


@cache
def _imports(module, *, lazy):
    """Modules of the project that a module imports, with or without the imports inside its functions."""
    path = _modules()[module]
    tree = ast.parse(path.read_text("utf-8"))
    inside = {
        node
        for function in ast.walk(tree)
        if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        for node in ast.walk(function)
    }
    package = module.split(".") if path.name == "__init__.py" else module.split(".")[:-1]
    found = set()
    for node in ast.walk(tree):
        if not isinstance(node, ast.ImportFrom) or node.level == 0 or (node in inside and not lazy):
            continue
        base = package[: len(package) - node.level + 1] + (node.module.split(".") if node.module else [])
        for alias in node.names:
            whole = ".".join([*base, alias.name])
            found.add(whole if whole in _modules() else ".".join(base))
    return found


def _room(module):
    parts = module.split(".")
    if parts[0] == CORE:
        return parts[1] if len(parts) > 1 else CORE
    return ".".join(parts[:2]) if parts[0] == "operators" and ".".join(parts[:2]) in BLENDER_ROOMS else parts[0]


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_of_the_core_imports_only_the_rooms_below_it(room):
    allowed = ROOMS[room] | GROUND | {room}
    wrong = {
        (module, other)
        for module in _modules()
        if module.startswith(f"{CORE}.{room}.") or module == f"{CORE}.{room}"
        for other in _imports(module, lazy=True)
        if _room(other) not in allowed
    }
    assert not wrong


@pytest.mark.parametrize("room", BLENDER_ROOMS)
def test_a_room_of_blender_imports_only_the_core_and_the_rooms_below_it(room):
    allowed = BLENDER_ROOMS[room] | {room, CORE}
    wrong = {
        (module, other)
        for module in _modules()
        if not module.startswith(CORE) and _room(module) == room
        for other in _imports(module, lazy=True)
        if not other.startswith(CORE) and _room(other) not in allowed
    }
    assert not wrong


def test_every_module_of_the_core_is_in_a_room():
    homeless = {module for module in _modules() if module.startswith(f"{CORE}.") and _room(module) not in ROOMS}
    assert homeless == {f"{CORE}.{name}" for name in GROUND} | {f"{CORE}.__main__"}


def test_the_core_never_imports_blender():
    for module, path in _modules().items():
        if module.startswith(CORE):
            names = {
                name.split(".")[0]
                for node in ast.walk(ast.parse(path.read_text("utf-8")))
                for name in (
                    [alias.name for alias in node.names]
                    if isinstance(node, ast.Import)
                    else [node.module or ""]
                    if isinstance(node, ast.ImportFrom)
                    else []
                )
            }
            assert not names & {"bpy", "bl_ui", "bpy_extras", "mathutils", "gpu", "gpu_extras", "blf"}, module


def test_no_module_imports_a_bundled_package_before_it_is_needed():
    # Else nothing registers where another extension has taken the package away (bundled.py).
    found = set()
    for module, path in _modules().items():
        for node in ast.parse(path.read_text("utf-8")).body:
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
            found |= {(module, name) for name in names if name.split(".")[0] in _BUNDLED}
    assert not found


@pytest.mark.parametrize("lazy", [False, True], ids=["at import", "inside functions, too"])
def test_no_import_leads_in_a_circle(lazy):
    # static_order raises CycleError, which names the circle.
    graph = {module: _imports(module, lazy=lazy) - {module} for module in _modules()}
    assert set(TopologicalSorter(graph).static_order()) >= set(graph)


def test_the_page_on_architecture_tells_the_same_rooms():
    page = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    told = {name: set(filter(None, allowed.split(", "))) for name, allowed in _ROW.findall(page)}
    slashed = {
        name.replace(".", "/"): {room.replace(".", "/") for room in rooms} for name, rooms in BLENDER_ROOMS.items()
    }
    assert told == ROOMS | slashed
    (ground,) = re.findall(r"the ground floor \((.*?)\)", page, re.DOTALL)
    assert {name.removesuffix(".py") for name in re.findall(r"`(.*?)`", ground)} == GROUND


def test_every_place_that_the_page_on_architecture_names_is_there():
    named = re.findall(r"`([\w/]+/[\w/]*(?:\.\w+)?)`", (ROOT / "docs" / "architecture.md").read_text("utf-8"))
    assert len(named) > 40
    assert [place for place in named if not (ROOT / place).exists()] == []
