"""Every text of the extension that Blender's catalog is asked for, as (context, text)."""

import ast
from pathlib import Path

from blender_session import EXTENSION

from reflcolor_addon.seeds.sources import EVIDENCE

ROOT = Path(__file__).resolve().parent.parent
ANY, OPERATOR = "*", "Operator"
# What takes a text to look up as its first argument.
_LOOKUPS = {"label", "report_text", "tip", "n_"}
# What takes one as `text`, and in which context Blender looks it up.
_LAYOUT = {
    "label": ANY,
    "prop": ANY,
    "menu": ANY,
    "progress": ANY,
    "operator": OPERATOR,
    "operator_menu_enum": OPERATOR,
}
# Attributes of classes that are looked up when they are shown.
_ATTRIBUTES = {"job_name", "hint"}


def class_strings(bpy):
    """The texts of the classes that are registered, and of their properties."""
    found = set()
    for name in dir(bpy.types):
        cls = getattr(bpy.types, name)
        if not getattr(cls, "__module__", "").startswith(f"{EXTENSION}."):
            continue
        if "_OT_" in name:
            group, act = cls.bl_idname.split(".")
            found |= {(OPERATOR, cls.bl_label), (ANY, getattr(getattr(bpy.ops, group), act).get_rna_type().description)}
        elif getattr(cls, "bl_label", ""):
            found.add((ANY, cls.bl_label))
    for _, prop in properties(bpy):
        texts = [prop.name, prop.description]
        if prop.type == "ENUM":
            texts += [text for item in prop.enum_items for text in (item.name, item.description)]
        found |= {(prop.translation_context, text) for text in texts if not prop.is_hidden}
    return {(context, text) for context, text in found if text}


def properties(bpy):
    """(place, property) for every property that the extension's operators and property groups declare."""
    operators = [getattr(bpy.types, name) for name in dir(bpy.types) if name.startswith("REFLCOLOR_OT_")]
    found = []
    for cls in operators:
        group, act = cls.bl_idname.split(".")
        declared = {name for base in cls.__mro__ if _is_ours(base) for name in getattr(base, "__annotations__", {})}
        rna = getattr(getattr(bpy.ops, group), act).get_rna_type()
        found += [(f"{cls.bl_idname}.{name}", rna.properties[name]) for name in sorted(declared)]
    seen = set()
    for owner in (bpy.types.Object, bpy.types.Scene, bpy.types.WindowManager):
        for prop in owner.bl_rna.properties:
            if prop.identifier.startswith("reflcolor"):
                found += _group_properties(prop.fixed_type, seen)
    return found


def _group_properties(group, seen):
    """Those of a property group, and of the groups that it holds."""
    if group.identifier in seen:
        return []
    seen.add(group.identifier)
    found = []
    for prop in group.properties:
        if prop.identifier in {"rna_type", "name"}:
            continue
        found.append((f"{group.identifier}.{prop.identifier}", prop))
        if prop.type in {"COLLECTION", "POINTER"} and prop.fixed_type.identifier.startswith("Reflcolor"):
            found += _group_properties(prop.fixed_type, seen)
    return found


def _is_ours(cls):
    return cls.__module__.startswith(f"{EXTENSION}.")


def source_strings():
    """The texts in the sources of operators and panels, and those of the core that panels look up."""
    found = {(ANY, source.counted) for source in EVIDENCE.values()}
    for folder in ("operators", "panels"):
        for path in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                found |= _strings_of(node)
    return {(context, text) for context, text in found if text}


def _strings_of(node):
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id in _ATTRIBUTES:
        return {(ANY, text) for text in _literals(node.value)}
    if isinstance(node, ast.ClassDef) and any(getattr(base, "attr", "") == "WorkSpaceTool" for base in node.bases):
        assigned = {
            target.id: line.value for line in node.body if isinstance(line, ast.Assign) for target in line.targets
        }
        texts = (("bl_label", OPERATOR), ("bl_description", ANY))
        return {(context, text) for name, context in texts for text in _literals(assigned[name])}
    if not isinstance(node, ast.Call):
        return set()
    function = node.func
    if isinstance(function, ast.Name) and _is_lookup(function.id) and node.args:
        return {(ANY, text) for text in _literals(node.args[0])}
    if isinstance(function, ast.Attribute) and function.attr == "report" and len(node.args) == 2:
        return {(ANY, text) for text in _literals(node.args[1])}
    if isinstance(function, ast.Attribute) and function.attr in _LAYOUT:
        given = {keyword.arg: keyword.value for keyword in node.keywords}
        if "text" in given and not (isinstance(given.get("translate"), ast.Constant) and not given["translate"].value):
            return {(_LAYOUT[function.attr], text) for text in _literals(given["text"])}
    return set()


def _is_lookup(name):
    """Whether what is called takes a text to look up, at once or, as an error or a Message, when it is shown."""
    return name in _LOOKUPS or name == "Message" or (name.endswith("Error") and name != "UsageError")


def _literals(node):
    """The texts that an expression can be, as far as they stand there."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return {node.value}
    if isinstance(node, ast.IfExp):
        return _literals(node.body) | _literals(node.orelse)
    return set()


def unsaid_parts():
    """Where a panel or a report is given a text that is put together and never looked up, as "file:line"."""
    found = []
    for folder in ("operators", "panels"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call) and any(isinstance(part, ast.JoinedStr) for part in _shown(node)):
                    found.append(f"{path.name}:{node.lineno}")
    return found


def _shown(node):
    name = getattr(node.func, "attr", "")
    if name == "report":
        return node.args[1:]
    if name == "poll_message_set":
        return node.args
    untranslated = any(
        keyword.arg == "translate" and isinstance(keyword.value, ast.Constant) and not keyword.value.value
        for keyword in node.keywords
    )
    if name in _LAYOUT and not untranslated:
        return [keyword.value for keyword in node.keywords if keyword.arg == "text"]
    return []
