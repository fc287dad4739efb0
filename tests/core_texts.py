"""The templates that the core can show in Blender's window, found in the sources.

The window can show what the modules say that operators and panels import, directly or through others. A text is the
first argument of an error, a `Message` or a function with a parameter ``template``, or the second one of ``progress``.
"""

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
_CORE = ROOT / "reflcolor_addon"


@cache
def window_modules():
    """Sorted paths of the core's modules that the window's code imports; those of the command line are no part."""
    waiting = [path for folder in ("operators", "panels") for path in (ROOT / folder).rglob("*.py")]
    seen = set(waiting)
    while waiting:
        for path in _imported(waiting.pop()) - seen:
            if _CORE / "cli" not in path.parents:
                seen.add(path)
                waiting.append(path)
    return sorted(path for path in seen if _CORE in path.parents)


def _imported(path):
    found = set()
    for node in ast.walk(_tree(path)):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for name in node.names:
                found |= {file for file in _files(folder / name.name) + _files(folder) if file.exists()}
    return found


def _files(place):
    return [place.with_name(f"{place.name}.py"), place / "__init__.py"]


@cache
def _tree(path):
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def _takers():
    """Map the names of what takes a template to its place among the arguments: functions, `Message`, errors."""
    takers = {"progress": 1, "_progress": 1, "_warn": 0}
    classes = {}
    for node in (node for path in window_modules() for node in ast.walk(_tree(path))):
        if isinstance(node, ast.FunctionDef):
            if not node.name.startswith("__") and (places := _places_of_template(node)):
                takers[node.name] = places[0]
        elif isinstance(node, ast.ClassDef):
            classes[node.name] = node
    for name, node in classes.items():
        while node is not None and not any(
            _places_of_template(part) for part in node.body if getattr(part, "name", "") in {"__init__", "__new__"}
        ):
            node = classes.get(getattr(node.bases[0], "id", "")) if node.bases else None
        if node is not None:
            takers[name] = 0
    return takers


def _places_of_template(node):
    if not isinstance(node, ast.FunctionDef):
        return []
    names = [argument.arg for argument in node.args.posonlyargs + node.args.args]
    return [names.index("template") - ("self" in names)] if "template" in names else []


def window_templates():
    """Map every template to the places ("file:line") where it is used."""
    found = {}
    for place, texts in _texts():
        for text in texts or ():
            found.setdefault(text, []).append(place)
    return found


def unknown_templates():
    """Places where a template is neither written out nor handed on from a caller."""
    return [place for place, texts in _texts() if texts is None]


def _texts():
    """(place, set of templates) for all that can be shown; None instead of a set that is not to be found out."""
    for path in window_modules():
        for function, call in _calls(_tree(path)):
            text = _text_of(call)
            if text is not None and not _is_handed_on(text, function):
                yield f"{path.relative_to(ROOT).as_posix()}:{call.lineno}", _literals(text, function, path)


def _calls(tree):
    """(functions around it, call) for every call; of nested functions the innermost one is last."""

    def walk(node, around):
        if isinstance(node, ast.Call):
            yield around, node
        inside = (*around, node) if isinstance(node, ast.FunctionDef | ast.Lambda) else around
        for child in ast.iter_child_nodes(node):
            yield from walk(child, inside)

    yield from walk(tree, ())


def _text_of(call):
    """The expression that is a template, or None."""
    place = _takers().get(getattr(call.func, "id", getattr(call.func, "attr", "")))
    return call.args[place] if place is not None and len(call.args) > place else None


def _is_handed_on(text, around):
    """Whether it comes from a caller, whose texts are looked at, or is a `Message` or the template of one."""
    if isinstance(text, ast.Call):
        return _text_of(text) is not None or any(_is_handed_on(part, around) for part in (text.func, *text.args))
    if isinstance(text, ast.Attribute):
        return text.attr in {"template", "message", "_text"} or _is_handed_on(text.value, around)
    arguments = {argument.arg for node in around for argument in node.args.args + node.args.posonlyargs}
    return isinstance(text, ast.Name) and text.id in arguments


def _literals(node, around, path):
    if isinstance(node, ast.Constant):
        return {node.value}
    if isinstance(node, ast.IfExp):
        parts = _literals(node.body, around, path), _literals(node.orelse, around, path)
        return None if None in parts else parts[0] | parts[1]
    if isinstance(node, ast.Subscript):
        return _literals(node.value, around, path)
    if isinstance(node, ast.Dict):
        parts = [_literals(value, around, path) for value in node.values]
        return None if None in parts else set().union(*parts)
    if _is_handed_on(node, around):
        return set()
    if isinstance(node, ast.Name):
        values = _assigned(node.id, around, path)
        parts = [_literals(value, around, found_in) for value, found_in in values]
        return set().union(*parts) if parts and None not in parts else None
    return None


def _given(assignment, name):
    """The expressions that an assignment gives a name."""
    for target in assignment.targets:
        if isinstance(target, ast.Tuple) and isinstance(assignment.value, ast.Tuple):
            pairs = zip(target.elts, assignment.value.elts, strict=True)
            yield from (value for part, value in pairs if getattr(part, "id", "") == name)
        elif getattr(target, "id", "") == name:
            yield assignment.value


def _assigned(name, around, path):
    """(expression, file) of what a name is given, in the functions around or in a module."""
    for scope in (*around[::-1], _tree(path)):
        found = [value for node in ast.walk(scope) if isinstance(node, ast.Assign) for value in _given(node, name)]
        if found:
            return [(value, path) for value in found]
    for node in _tree(path).body:
        if isinstance(node, ast.ImportFrom) and node.level and any(alias.name == name for alias in node.names):
            folder = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            return _assigned(name, (), next(file for file in _files(folder) if file.exists()))
    return []
