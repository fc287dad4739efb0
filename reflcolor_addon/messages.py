"""Texts for people as data: a template and its values stay apart until shown, so that they can be translated."""

from pathlib import PurePath

LONGEST_VALUE, LONGEST_LINE = 300, 2000
"""Characters of a value in a message, and of a whole line: what a file or its name holds may be of any length."""


def one_line(text, longest=LONGEST_VALUE):
    """Return a text as a line of at most so many characters.

    What would end the line or steer a terminal is escaped; of a longer text the middle is left out.
    """
    half = (longest - 3) // 2
    if len(text) > longest:
        text = f"{text[:half]}...{text[-half:]}"
    shown = "".join(char if char.isprintable() else char.encode("unicode_escape").decode("ascii") for char in text)
    return shown if len(shown) <= longest else f"{shown[:half]}...{shown[-half:]}"


class Message(str):
    """A line of text that remembers what it was made of.

    It is an ordinary ``str`` in English. Whoever shows it in another language looks up ``template`` and fills in
    ``values`` again; see `translated`.

    Parameters
    ----------
    template : str
        English, with named places as in ``"{file}: line {line}: expected a number"``. Without values it is taken as it
        is, braces included.
    **values
        What is put in the places; a value may be a Message itself. Texts and paths become `one_line` each.

    Attributes
    ----------
    template : str
    values : dict of str to object

    Examples
    --------
    >>> line = Message("{file}: line {line}: expected a number", file="garage.ptx", line=12)
    >>> print(line)
    garage.ptx: line 12: expected a number
    >>> line.values["line"]
    12
    """

    __slots__ = ("template", "values")

    def __new__(cls, template, /, **values):
        values = {name: _tamed(value) for name, value in values.items()}
        message = super().__new__(cls, template.format(**values) if values else template)
        message.template = template
        message.values = values
        return message


def _tamed(value):
    if isinstance(value, Message):
        return value
    return one_line(str(value)) if isinstance(value, str | PurePath | BaseException) else value


def translated(text, look_up):
    """Return a text in another language.

    Parameters
    ----------
    text : str or Message
    look_up : callable
        Takes an English template and returns it in the other language, with the same named places.

    Returns
    -------
    str
    """
    if not isinstance(text, Message):
        return look_up(text)
    values = {
        name: translated(value, look_up) if isinstance(value, Message) else value for name, value in text.values.items()
    }
    template = look_up(text.template)
    return template.format(**values) if values else template


def value_of(text, name):
    """Return a value that a text was made with, or a Message within it; None where there is none of that name."""
    if not isinstance(text, Message):
        return None
    if name in text.values:
        return text.values[name]
    found = (value_of(value, name) for value in text.values.values())
    return next((value for value in found if value is not None), None)


def without_file(text):
    """Return a text without the name of the file in front, where it begins with one."""
    if not isinstance(text, Message) or not text.template.startswith("{file}: "):
        return text
    return Message(text.template.removeprefix("{file}: "), **text.values)


def of_scan(scan, template, /, **values):
    """Return a Message about one scan of a file: "scan 'wall': its color is ..."."""
    return Message("scan '{scan}': {note}", scan=scan, note=Message(template, **values))


def about_scan(text, scan):
    """Return a text that says which scan it is about, as one of several: by its value ``scan``, or put before it."""
    if value_of(text, "scan") is not None or text.startswith(f"{scan}: "):
        return text
    return Message("{scan}: {text}", scan=scan, text=text)
