"""The XML section of an E57 file, read and checked here before native code sees the file (ASTM E2807, section 8).

Anything that code would fetch, expand or crash on is refused: document types, entities, locations of schemas,
references of any kind, elements that are not nodes of E57, and nodes that lack what the standard requires.
"""

from dataclasses import dataclass, field
from xml.parsers import expat

from ...errors import Cancelled, ScanError
from ...messages import Message

_LARGEST = 1 << 26
_MOST_NODES, _DEEPEST = 400_000, 32
_LONGEST_TEXT = 1 << 16
_ASKED_EVERY = 10_000
_CONTAINERS = ("Structure", "Vector", "CompressedVector")
_LEAVES = ("Integer", "ScaledInteger", "Float", "String", "Blob")
_SCALARS = ("Integer", "ScaledInteger", "Float", "String")
# Attributes by the type of the node: what a number of them must be, and which there must be.
_WHOLE = ("fileOffset", "recordCount", "length")
_NEEDED = {"CompressedVector": ("fileOffset", "recordCount"), "Blob": ("fileOffset", "length")}
_NUMBERS = ("minimum", "maximum", "scale", "offset")
_KNOWN = {"type", "allowHeterogeneousChildren", "precision", *_WHOLE, *_NUMBERS}
# The namespaces by which XML refers to something outside of itself.
_FORBIDDEN = (
    "http://www.w3.org/2001/XMLSchema-instance",
    "http://www.w3.org/2001/XInclude",
    "http://www.w3.org/1999/xlink",
)
_REFERENCES = ("schemaLocation", "noNamespaceSchemaLocation", "base", "href")
_SEPARATOR = " "


@dataclass(eq=False)
class Node:
    """One node of the file.

    Parameters
    ----------
    name : str
        With its prefix, as it is written.
    kind : str
        One of E57's eight types.
    attributes : dict of str to str
    children : list of Node
    text : str
    """

    name: str
    kind: str
    attributes: dict
    children: list = field(default_factory=list)
    text: str = ""

    def child(self, *names):
        """The node at a path below this one; None where a part of the path is missing."""
        node = self
        for name in names:
            node = next((child for child in node.children if child.name == name), None)
            if node is None:
                return None
        return node

    def number(self, *names):
        """The number at a path below this node; None where a part of the path is missing or it is no number."""
        node = self.child(*names)
        return None if node is None else node.value()

    def value(self):
        """The number that this node holds; an empty one holds 0. None where it is no number."""
        if self.kind not in ("Integer", "ScaledInteger", "Float"):
            return None
        number = _number(self.text or "0")
        if number is not None and self.kind == "ScaledInteger":
            number = number * self.attribute("scale", 1.0) + self.attribute("offset", 0.0)
        return number

    def attribute(self, name, default=None):
        """The number that an attribute holds; the default where it is not there."""
        return _number(self.attributes[name]) if name in self.attributes else default


def parse_xml(text, file_name, file_size, cancelled=None):
    """Parse and check the XML section.

    Parameters
    ----------
    text : bytes
    file_name : str
        For messages.
    file_size : int
        Bytes of the file; what the section points to must lie inside of it.
    cancelled : callable, optional

    Returns
    -------
    Node
        The root.

    Raises
    ------
    ScanError
        In one line.
    Cancelled
        If ``cancelled()`` returned True.
    """
    return _Parser(file_name, file_size, cancelled).root_of(text)


class _Parser:
    def __init__(self, file_name, file_size, cancelled):
        self._file_name, self._file_size, self._cancelled = file_name, file_size, cancelled
        self._open, self._names, self._root, self._count, self._text = [], [], None, 0, []

    def root_of(self, text):
        if len(text) > _LARGEST:
            self._refuse("its XML section has {size:,} bytes, expected at most {most:,}", size=len(text), most=_LARGEST)
        parser = expat.ParserCreate("utf-8", _SEPARATOR)
        parser.namespace_prefixes = True
        parser.buffer_text = True
        parser.XmlDeclHandler = self._declaration
        parser.StartElementHandler, parser.EndElementHandler = self._start, self._end
        parser.CharacterDataHandler = self._characters
        for handler, what in (
            ("StartDoctypeDeclHandler", Message("a document type")),
            ("EntityDeclHandler", Message("an entity")),
            ("ExternalEntityRefHandler", Message("an entity")),
            ("SkippedEntityHandler", Message("an entity")),
            ("ProcessingInstructionHandler", Message("a processing instruction")),
        ):
            setattr(parser, handler, self._forbidden(what))
        try:
            parser.Parse(text, True)
        except (expat.ExpatError, ValueError) as error:
            if isinstance(error, ScanError):
                raise
            self._refuse("its XML section is damaged; copy or export it again")
        return self._root

    def _forbidden(self, what):
        def refuse(*_):
            self._refuse("its XML section holds {what}, which no E57 has; it is not opened", what=what)

        return refuse

    def _declaration(self, version, encoding, _standalone):
        if version != "1.0" or (encoding or "utf-8").lower() != "utf-8":
            self._refuse("its XML section is not XML 1.0 in UTF-8, as E57 has it")

    def _start(self, name, attributes):
        self._count += 1
        if self._count % _ASKED_EVERY == 0 and self._cancelled is not None and self._cancelled():
            raise Cancelled
        if self._count > _MOST_NODES or len(self._open) >= _DEEPEST:
            self._refuse(
                "its XML section has more than {most:,} nodes, or more than {deepest} inside each other",
                most=_MOST_NODES,
                deepest=_DEEPEST,
            )
        node = Node(_written(name), attributes.pop("type", None), attributes)
        self._check_references(name, attributes)
        if node.kind not in (*_CONTAINERS, *_LEAVES):
            self._refuse("{node} has the type {kind}, which E57 does not define", node=node.name, kind=str(node.kind))
        self._check_attributes(node)
        if self._open:
            self._check_child(self._open[-1], node)
            self._open[-1].children.append(node)
        else:
            if node.name != "e57Root" or node.kind != "Structure":
                self._refuse("its XML section begins with {node}, expected e57Root", node=node.name)
            self._root = node
        self._open.append(node)
        self._names.append(set())
        self._text = []

    def _end(self, _name):
        node = self._open.pop()
        self._names.pop()
        node.text = "".join(self._text).strip()
        self._text = []
        if node.kind == "CompressedVector":
            self._check_points(node)
        elif node.kind in ("Integer", "ScaledInteger", "Float") and _number(node.text or "0") is None:
            self._refuse("{node} holds {found}, expected a number", node=node.name, found=node.text)

    def _characters(self, text):
        node = self._open[-1]
        if node.kind in _CONTAINERS:
            if not text.isspace():
                self._refuse("{node} holds text, expected nodes", node=node.name)
            return
        self._text.append(text)
        if sum(map(len, self._text)) > _LONGEST_TEXT:
            self._refuse("{node} holds more than {most:,} characters", node=node.name, most=_LONGEST_TEXT)

    def _check_references(self, name, attributes):
        for written in (name, *attributes):
            space, local = ["", *written.split(_SEPARATOR)[:2]][-2:]
            if space in _FORBIDDEN or local in _REFERENCES:
                self._refuse(
                    "its XML section refers to something outside of it ({what}), which no E57 does; it is not opened",
                    what=_written(written),
                )

    def _check_attributes(self, node):
        for key in _NEEDED.get(node.kind, ()):
            if key not in node.attributes:
                self._refuse("{node} has no {key}", node=node.name, key=key)
        for key, value in node.attributes.items():
            if key in _WHOLE and not (value.isascii() and value.isdigit() and len(value) < 19):
                self._refuse("{node}: {key} is {found}, expected a whole number", node=node.name, key=key, found=value)
            if key in _NUMBERS and _number(value) is None:
                self._refuse("{node}: {key} is {found}, expected a number", node=node.name, key=key, found=value)
        start, length = (int(node.attributes.get(key, 0)) for key in ("fileOffset", "length"))
        if start >= self._file_size or length > self._file_size:
            self._refuse("{node} lies outside of the file", node=node.name)

    def _check_child(self, parent, node):
        if parent.kind in _LEAVES:
            self._refuse("{node} lies inside of {parent}, which holds a value", node=node.name, parent=parent.name)
        if parent.kind == "CompressedVector" and node.name not in ("prototype", "codecs"):
            self._refuse("{parent} holds {node}, expected prototype and codecs", parent=parent.name, node=node.name)
        if parent.kind != "Vector" and node.name in self._names[-1]:
            self._refuse("{parent} holds {node} twice", parent=parent.name, node=node.name)
        self._names[-1].add(node.name)
        # Native code compares vectors of equal children, and crashes on points there.
        if node.kind == "CompressedVector" and any(
            above.kind == "Vector" and above.attributes.get("allowHeterogeneousChildren") != "1" for above in self._open
        ):
            self._refuse("{node} lies inside of a list that allows only children of one kind", node=node.name)

    def _check_points(self, node):
        prototype, codecs = node.child("prototype"), node.child("codecs")
        if prototype is None or prototype.kind != "Structure" or not prototype.children:
            self._refuse("{node} has no prototype, which tells what its records hold", node=node.name)
        # The bounds of a group of points are a structure; points themselves are plain records.
        nested = node.name != "points"
        if not all(child.kind in _SCALARS or (nested and _is_of_scalars(child)) for child in prototype.children):
            self._refuse("{node}: its prototype holds something other than numbers", node=node.name)
        if codecs is not None and codecs.kind != "Vector":
            self._refuse("{node}: its codecs are not a list", node=node.name)

    def _refuse(self, template, **values):
        raise ScanError("{file}: {problem}", file=self._file_name, problem=Message(template, **values))


def _is_of_scalars(node):
    """Whether a node is a structure that holds values alone, at any depth."""
    children = node.children
    return (
        node.kind == "Structure"
        and bool(children)
        and all(child.kind in _SCALARS or _is_of_scalars(child) for child in children)
    )


def _written(name):
    """A name of expat's (namespace, name and prefix) as it is written in the file."""
    parts = name.split(_SEPARATOR)
    return f"{parts[2]}:{parts[1]}" if len(parts) == 3 else parts[-1]


def _number(text):
    """A float of what libE57 takes for one; None for anything else."""
    try:
        return None if "_" in text else float(text)
    except ValueError:
        return None
