"""Writes docs/api.md from the docstrings of the package's public names: python tools/api_page.py (a test compares)."""

import inspect
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
import reflcolor_addon  # noqa: E402

PAGE = ROOT / "docs" / "api.md"
GROUPS = {
    "Reading and writing": (
        *("read_scans", "ReadOptions", "write_ptx", "write_e57", "write_image_pair"),
        *("ScanSurface", "write_ply", "write_glb"),
    ),
    "Scans, seeds, settings": ("Scan", "Seeds", "Settings"),
    "Colors": ("colorize", "Colorizer", "Colorization", "evaluate", "error_map"),
    "Photos": ("match_photos", "match_seeds", "match_site", "Matching", "PhotoMatch", "Observed", "draw_matches"),
    "Distances": ("geodesic_distances",),
}
INTRODUCTION = """# Python

The public names of the package `reflcolor_addon`, written by `tools/api_page.py` from their docstrings. `pip install .`
installs it, without Blender; inside Blender it is `bl_ext.user_default.reflcolor.reflcolor_addon`.
"""


def main() -> None:
    """Write the page."""
    PAGE.write_text(page(), encoding="utf-8", newline="\n")


def page() -> str:
    """The page's text."""
    parts = [INTRODUCTION]
    for title, names in GROUPS.items():
        parts += [f"\n## {title}\n", *map(_entry, names)]
    parts.append("\n## Errors\n")
    for name in errors():
        parts.append(f"- `{name}`: {inspect.getdoc(getattr(reflcolor_addon, name)).splitlines()[0]}")
    return "\n".join(parts) + "\n"


def errors() -> list[str]:
    """The public names that are in no group: exceptions; anything else must have a group."""
    grouped = {name for names in GROUPS.values() for name in names} | {"__version__"}
    left = [name for name in reflcolor_addon.__all__ if name not in grouped]
    lost = [name for name in left if not issubclass(getattr(reflcolor_addon, name), Exception)]
    if lost:
        sys.exit(f"{Path(__file__).name}: GROUPS has no place for {', '.join(lost)}")
    return left


def _entry(name: str) -> str:
    public = getattr(reflcolor_addon, name)
    lines = [f"### `{name}`\n", "```python", _signature(name, public), "```\n", _text(inspect.getdoc(public))]
    if inspect.isclass(public):
        for method, function in vars(public).items():
            described = function.__func__ if isinstance(function, classmethod) else function
            if method.startswith("_") or not callable(described) or not inspect.getdoc(described):
                continue
            lines += [f"\n#### `{name}.{method}`\n", "```python", _signature(method, described), "```\n"]
            lines += [_text(inspect.getdoc(described))]
    return "\n".join(lines) + "\n"


def _signature(name: str, public) -> str:
    parameters = [re.sub(r"[\w.]+\.(?=\w)", "", str(parameter)) for parameter in _parameters(public)]
    line = f"{name}({', '.join(parameters)})"
    return line if len(line) <= 100 else f"{name}(\n    " + ",\n    ".join(parameters) + ",\n)"


def _parameters(public):
    """The parameters without their types, which the text has in the field's terms."""
    kinds = inspect.Parameter
    starred = False
    for parameter in inspect.signature(public).parameters.values():
        if parameter.name in ("self", "cls"):
            continue
        if parameter.kind is kinds.KEYWORD_ONLY and not starred:
            starred = True
            yield "*"
        starred = starred or parameter.kind is kinds.VAR_POSITIONAL
        yield parameter.replace(annotation=kinds.empty)


def _text(docstring: str) -> str:
    """A docstring in NumPy's style as Markdown."""
    sections = re.split(r"^(\w+)\n-{3,}\n", docstring, flags=re.MULTILINE)
    text = [_marked(sections[0]).strip()]
    for title, body in zip(sections[1::2], sections[2::2], strict=True):
        text.append(f"\n**{title}**\n")
        if title == "Examples":
            text.append(f"```python\n{body.strip()}\n```")
        elif title in ("Parameters", "Returns", "Raises", "Attributes"):
            text.append(_definitions(body))
        else:
            text.append(_marked(re.sub(r"^\.\. \[", "[", body, flags=re.MULTILINE)).strip())
    return "\n".join(text)


def _definitions(body: str) -> str:
    lines = []
    for line in body.strip("\n").splitlines():
        if not line.startswith(" ") and line:
            name, _, kind = line.partition(" : ")
            lines.append(f"- `{name}`" + (f" : {_marked(kind)}" if kind else ""))
        elif line.strip():
            lines.append(f"  {_marked(line.strip())}")
    return "\n".join(lines)


def _marked(text: str) -> str:
    return text.replace("``", "`")


if __name__ == "__main__":
    main()
