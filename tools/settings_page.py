"""Write docs/settings.md from the declarations of the settings; with --check, only say whether it is up to date."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "settings.md"
_HEAD = """# Settings

Every setting of `colorize` and of the search for seeds in photos: on the command line as `--name`, in Python as
`Settings(name=...)`, in Blender under *4. Colorize* and *Find in Photos*. Blender's window and the command line start
from the preset *Natural*, `Settings()` in Python from *Paper*, whose values are the defaults below. This page is
written by `tools/settings_page.py` from the declarations in `reflcolor_addon/settings.py`.
"""


def page():
    """Return the page as text."""
    sys.path.insert(0, str(ROOT))
    from reflcolor_addon.settings import MATCHING, PRESETS, PROPAGATION, SETTINGS

    lines = [_HEAD, "## Presets", "", "| preset | what it is | what it sets |", "|---|---|---|"]
    for name, preset in PRESETS.items():
        values = ", ".join(f"{key} {SETTINGS[key].name_of(value)}" for key, value in preset.values.items())
        lines.append(f"| {name} | {preset.help} | {values or 'nothing: the defaults'} |")
    for title, group in (("How colors spread", PROPAGATION), ("How seeds are found in photos", MATCHING)):
        lines += [
            "",
            f"## {title}",
            "",
            "| setting | in Blender | what it does | values | default |",
            "|---|---|---|---|---|",
        ]
        for name, setting in SETTINGS.items():
            if setting.group == group:
                default = setting.name_of(setting.default)
                values = f"{setting.expected(named=True)}{f' ({setting.unit})' if setting.unit else ''}"
                lines.append(f"| `{name}` | {setting.label} | {setting.help} | {values} | {default} |")
    for name, setting in SETTINGS.items():
        if setting.choices:
            lines += ["", f"`{name}`:", ""]
            lines += [f"- `{choice.name}` ({choice.label}): {choice.help}" for choice in setting.choices]
    return "\n".join(lines) + "\n"


def main():
    """Write the page, or check it."""
    if "--check" in sys.argv:
        return (
            0 if PAGE.read_text(encoding="utf-8") == page() else f"{PAGE.relative_to(ROOT)}: run tools/settings_page.py"
        )
    PAGE.write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
