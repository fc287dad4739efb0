"""A table of a batch's manifest, whose values are checked when they are asked for."""

from difflib import get_close_matches

from ...messages import Message
from ...settings import SETTINGS

# How alike a name must be to what was meant.
_ALIKE = 0.7
_KINDS = {str: "a text in quotes", bool: "true or false", int: "a whole number", dict: "a table"}


class ManifestTable:
    """A table of the manifest: its values by name, of the right type; what is wrong is said with its line."""

    def __init__(self, values, at, reader):
        self._values, self.at, self._reader = values, at, reader

    def known(self, names, of_one=(), of_all=()):
        """Refuse every key that is none of these; ``of_one`` and ``of_all`` are those of a single scan, and of the
        top."""
        for name in self._values:
            if name in of_one and name not in names:
                self.refuse(name, "{key}: is said of one scan; write it below a [[scan]] with its file", key=name)
            elif name in of_all and name not in names:
                self.refuse(name, "{key}: is said of the whole batch; write it at the top", key=name)
            elif name in SETTINGS and name not in names:
                self.refuse(name, "{key}: is a setting; write settings = {{ {key} = ... }}", key=name)
            elif name not in names:
                near = get_close_matches(name, names, 1, _ALIKE)
                hint = Message("; did you mean {name}?", name=near[0]) if near else ""
                self.refuse(name, "unknown key {key!r}{hint}", key=name, hint=hint)

    def refuse(self, key, template, /, **values):
        """Report what is wrong with a key, a place below one, or (None) the table itself."""
        path = self.at if key is None else (*self.at, *(key if isinstance(key, tuple) else (key,)))
        self._reader.refuse_at(path, template, **values)

    def __contains__(self, key):
        return key in self._values

    def __getitem__(self, key):
        return self._values[key]

    def get(self, key, kind, default=None):
        """Return a value of one type; the default if it is missing or has another type."""
        value = self._values.get(key)
        if value is None:
            return default
        if not isinstance(value, kind) or (kind is not bool and isinstance(value, bool)):
            kinds = kind if isinstance(kind, tuple) else (kind,)
            expected = " or ".join(_KINDS[kind] for kind in kinds)
            self.refuse(key, "{key}: expected {expected}, found {found!r}", key=key, expected=expected, found=value)
            return default
        if isinstance(value, str) and "\0" in value:
            self.refuse(key, "{key}: holds a null character, which no name may hold", key=key)
            return default
        return value

    def texts(self, key):
        """Return a list of texts, or one text as a list, each with its place; None where it is missing."""
        value = self._values.get(key)
        if value is None:
            return None
        if isinstance(value, str):
            return [((key,), value)]
        if not isinstance(value, list):
            self.refuse(key, "{key}: expected a list of texts, found {found!r}", key=key, found=value)
            return []
        for place, text in enumerate(value):
            if not isinstance(text, str):
                self.refuse((key, place), "{key}: expected a text in quotes, found {found!r}", key=key, found=text)
        return [((key, place), text) for place, text in enumerate(value) if isinstance(text, str)]


def last_value(tables, key, kind, default):
    """Return the value of the last table that has one."""
    for table in reversed(tables):
        if key in table:
            return table.get(key, kind, default)
    return default
