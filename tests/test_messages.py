"""Messages keep their template and values apart from the text."""

import ast
import copy
import json
from pathlib import Path

from reflcolor_addon import errors
from reflcolor_addon.errors import ScanError
from reflcolor_addon.messages import Message, about_scan, translated, value_of

GERMAN = {
    "{file}: line {line}: expected a number": "{file}: Zeile {line}: eine Zahl wird erwartet",
    "{scan}: {problem}": "{scan}: {problem}",
    "no return": "kein Echo",
}


def german(text):
    return translated(text, lambda template: GERMAN.get(template, template))


def test_a_message_is_its_english_text():
    message = Message("{file}: line {line}: expected a number", file="a.ptx", line=3)
    assert message == "a.ptx: line 3: expected a number"
    assert json.dumps([message]) == '["a.ptx: line 3: expected a number"]'


def test_a_text_without_values_is_taken_as_it_is():
    assert Message("{scan} is a placeholder") == "{scan} is a placeholder"
    assert german(Message("{scan} is a placeholder")) == "{scan} is a placeholder"


def test_values_with_braces_are_left_alone():
    message = Message("{scan}: {problem}", scan="{0} {wall}", problem=Message("no return"))
    assert message == "{0} {wall}: no return"
    assert german(message) == "{0} {wall}: kein Echo"


def test_a_message_inside_a_message_is_translated_too():
    inner = Message("{file}: line {line}: expected a number", file="a.ptx", line=3)
    assert german(Message("{scan}: {problem}", scan="wall", problem=inner)) == (
        "wall: a.ptx: Zeile 3: eine Zahl wird erwartet"
    )


def test_an_error_carries_its_message():
    error = ScanError("{file}: line {line}: expected a number", file="a.ptx", line=3)
    assert str(error) == "a.ptx: line 3: expected a number"
    assert error.message.values == {"file": "a.ptx", "line": 3}
    assert ScanError(error.message).message is error.message


def test_a_copy_keeps_template_and_values():
    message = copy.deepcopy(Message("{file}: line {line}: expected a number", file="a.ptx", line=3))
    assert message.template.startswith("{file}")
    assert message.values["line"] == 3


def test_a_value_is_found_inside_a_message_inside_a_message():
    inner = Message("seed {seed}: no return", seed=3)
    assert value_of(Message("{scan}: {text}", scan="wall", text=inner), "seed") == 3
    assert value_of(inner, "scan") is None
    assert value_of("seed 3: no return", "seed") is None


def test_a_line_about_one_of_several_scans_names_it_once():
    named = Message("{count} seeds lie where {scan} has no return", count=5, scan="wall")
    assert about_scan(named, "wall") is named
    assert about_scan(Message("try tone {tone}", tone=2), "wall") == "wall: try tone 2"


def _put_together(node):
    """Whether a text is an f-string with anything but a module's constants in it."""
    parts = [part.value for part in node.values if isinstance(part, ast.FormattedValue)]
    return not all(isinstance(part, ast.Name) and part.id.isupper() for part in parts)


def test_no_error_or_message_of_the_core_is_put_together_before_it_is_shown():
    sources = Path(__file__).resolve().parent.parent / "reflcolor_addon"
    names = {name for name, kind in vars(errors).items() if isinstance(kind, type)} | {"Message", "UnusableScan"}
    found = [
        f"{path.name}:{node.lineno}"
        for path in sorted(sources.rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Call) and getattr(node.func, "id", None) in names and node.args
        if isinstance(node.args[0], ast.JoinedStr) and _put_together(node.args[0])
    ]
    assert found == []
