"""Every value of a TOML file is found in its line."""

import tomllib

import pytest

from reflcolor_addon.batch.archive.toml_lines import TomlLines

TEXT = '''# a comment with [brackets] = and "quotes"
output = "colored"   # [no.table]
scans = [
  "a.ptx",  # first
  "b # c].ptx", 'd"e.ptx',
]
note = """
x = 1
[not.a.table]
"""

[settings]
light = 0.5
"strange key" . deep = { one = 1, two = [ 1,
  2 ] }

[[scan]]
file = "a.ptx"

[[scan]]
file = "b.ptx"
[scan.settings]
alpha = 3
'''


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("output",), 2),
        (("scans",), 3),
        (("scans", 0), 4),
        (("scans", 1), 5),
        (("scans", 2), 5),
        (("note",), 7),
        (("settings",), 12),
        (("settings", "light"), 13),
        (("settings", "strange key", "deep"), 14),
        (("settings", "strange key", "deep", "two", 1), 15),
        (("scan", 0, "file"), 18),
        (("scan", 1), 20),
        (("scan", 1, "file"), 21),
        (("scan", 1, "settings", "alpha"), 23),
    ],
)
def test_the_line_of_a_value(path, line):
    tomllib.loads(TEXT)
    assert TomlLines(TEXT).of(*path) == line


def test_what_has_no_line_has_that_of_what_holds_it():
    assert TomlLines(TEXT).of("scan", 1, "photos") == 20
    assert TomlLines(TEXT).of("version") == 1


def test_every_value_of_a_document_has_a_line():
    def walk(value, path=()):
        yield path
        for key, inner in (
            value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        ):
            yield from walk(inner, (*path, key))

    lines = TomlLines(TEXT)
    for path in walk(tomllib.loads(TEXT)):
        found = lines.of(*path)
        assert 1 <= found <= TEXT.count("\n")
