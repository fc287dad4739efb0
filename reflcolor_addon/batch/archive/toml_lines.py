"""In which lines of a TOML file its values stand, so that a message can name the line."""

import re
import tomllib

_HEADER = re.compile(r"(\[{1,2})([^\[\]]*)\]{1,2}")
_QUOTED = re.compile(r"\"(?:\\.|[^\\\"\n])*\"|'[^'\n]*'")
_SPACE = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SCALAR = re.compile(r"[^,\]}\n#]*")
_STRING_ENDS = {
    '"""': re.compile(r'(?:\\.|[^\\])*?"""("{0,2})', re.DOTALL),
    "'''": re.compile(r"(?:.)*?'''('{0,2})", re.DOTALL),
    '"': re.compile(r'(?:\\.|[^\\"\n])*"'),
    "'": re.compile(r"[^'\n]*'"),
}


class TomlLines:
    """The lines of all values of a document.

    Parameters
    ----------
    text : str
        TOML that `tomllib.loads` accepts; of anything else nothing is promised.
    """

    def __init__(self, text):
        self._text, self._at, self._lines = text, 0, {(): 1}
        self._counts = {}
        table = ()
        self._skip()
        while self._at < len(text):
            if header := _HEADER.match(text, self._at):
                table = self._table(header)
                self._at = header.end()
            else:
                key = (*table, *self._key())
                self._note(key)
                self._value(key)
            self._skip()

    def of(self, *path):
        """Return the line, from 1, of the value under these keys and places; of what holds it where it has none."""
        while path not in self._lines:
            path = path[:-1]
        return self._lines[path]

    def _table(self, header):
        keys = tuple(_parts(header[2]))
        path = ()
        for key in keys[:-1]:
            path = (*path, key)
            # A table below an array of tables belongs to the last of them.
            if path in self._counts:
                path = (*path, self._counts[path])
        path = (*path, keys[-1])
        if header[1] == "[[":
            self._counts[path] = self._counts.get(path, -1) + 1
            path = (*path, self._counts[path])
        elif path in self._counts:
            path = (*path, self._counts[path])
        self._note(path)
        return path

    def _note(self, path):
        self._lines.setdefault(path, self._text.count("\n", 0, self._at) + 1)

    def _skip(self):
        self._at = _SPACE.match(self._text, self._at).end()

    def _key(self):
        """Read a key; afterwards the place is behind its equals sign."""
        start = self._at
        while self._text[self._at] != "=":
            quoted = _QUOTED.match(self._text, self._at)
            self._at = quoted.end() if quoted else self._at + 1
        keys = tuple(_parts(self._text[start : self._at]))
        self._at += 1
        return keys

    def _value(self, path):
        self._skip()
        char = self._text[self._at]
        if char == "[":
            self._array(path)
        elif char == "{":
            self._inline_table(path)
        else:
            for quote, end in _STRING_ENDS.items():
                if self._text.startswith(quote, self._at):
                    self._at = end.match(self._text, self._at + len(quote)).end()
                    return
            self._at = _SCALAR.match(self._text, self._at).end()

    def _array(self, path):
        self._at += 1
        self._skip()
        place = 0
        while self._text[self._at] != "]":
            self._note((*path, place))
            self._value((*path, place))
            place += 1
            self._skip()
            if self._text[self._at] == ",":
                self._at += 1
                self._skip()
        self._at += 1

    def _inline_table(self, path):
        self._at += 1
        self._skip()
        while self._text[self._at] != "}":
            keys = self._key()
            self._note((*path, *keys))
            self._value((*path, *keys))
            self._skip()
            if self._text[self._at] == ",":
                self._at += 1
                self._skip()
        self._at += 1


def _parts(dotted):
    """The keys of a dotted key."""
    document, keys = tomllib.loads(f"{dotted} = 0"), []
    while isinstance(document, dict):
        key, document = next(iter(document.items()))
        keys.append(key)
    return keys
