"""Reads the manifest of a batch: a TOML file that names scans, photos, seeds, settings and outputs.

Its errors are collected and reported together, each with its line.
"""

from functools import cached_property
from itertools import islice
from pathlib import Path, PurePath

from ...errors import UsageError
from ...files.images import IMAGE_SUFFIXES
from ...files.readers import SCAN_SUFFIXES
from ..paths import files_of_each
from ..plan import PLACEHOLDER, RENDER, RESULT_SUFFIXES, SCENE, Output, Plan, filled
from ..read import safe_label
from .folder import BatchFolder, files_below, is_there
from .manifest import Item, Manifest
from .manifest_table import ManifestTable, last_value
from .manifest_values import faces_of, reading_of, settings_of, texture_of
from .meant import hint
from .names import item_names
from .toml_text import read_toml

FORMAT, VERSION = "reflcolor-batch", 1
# Among how many files that is looked for which was probably meant by a name, and for how many names.
_MOST_FILES, _MOST_HINTS = 20_000, 20
_RESULTS = tuple(suffix.removeprefix(".") for suffix in RESULT_SUFFIXES)
_OF_ALL = ("format", "version", "output", "scans", "photos", "pairs")
_OF_EACH = ("write", "render", "texture", "faces", "preset", "settings", "reading", "seeds")
_TABLES = ("settings", "reading")
_OF_ONE = ("file", "name", "site", "scan", "photos", "hand", "skip")
_OF_SITE = (*_OF_EACH, "photos", "hand")


def load_manifest(path, refuse):
    """Read a manifest.

    Parameters
    ----------
    path : Path
    refuse : callable
        Given a UsageError for each thing that is wrong. Without any the manifest can be worked on.

    Returns
    -------
    Manifest or None
        None where the file cannot be read as TOML.
    """
    found = read_toml(path, refuse)
    return None if found is None else _Reader(path, *found, refuse).manifest()


class _Reader:
    def __init__(self, path, document, lines, refuse):
        self._path, self._lines, self._refuse = path, lines, refuse
        self._whole = ManifestTable(document, (), self)
        self._folder = None
        self._photo_lines, self._said, self._hints, self._misses_scan = {}, set(), 0, False

    def refuse_at(self, at, template, /, **values):
        error = UsageError("{file}: line {line}: " + template, file=self._path, line=self._lines.of(*at), **values)
        # What is wrong for all scans is said once.
        if str(error) not in self._said:
            self._said.add(str(error))
            self._refuse(error)

    def manifest(self):
        whole = self._whole
        whole.known((*_OF_ALL, *_OF_EACH, "scan"), _OF_ONE)
        found = whole.get("format", str, ""), whole.get("version", int, 0)
        if found != (FORMAT, VERSION):
            whole.refuse(
                "format" if "format" in whole else None,
                "expected format = {format} and version = {version}",
                format=f'"{FORMAT}"',
                version=VERSION,
            )
        output = whole.get("output", str)
        if output is None and "output" not in whole:
            whole.refuse(None, "output: is missing; name the folder for the results")
        self._folder = BatchFolder(self._path.parent / (output or "."))
        pool = self._files(whole, "photos", "photo") or []
        pool = list(dict.fromkeys(path for _, path in pool))
        pairs = whole.get("pairs", str)
        if pairs is not None and self._path.parent / pairs not in self._matching(pairs):
            whole.refuse("pairs", "pairs: there is no file {path}{hint}", path=pairs, hint=self._hint(pairs, (".csv",)))
        if pairs is not None and (self._path.parent / pairs).absolute() == self._folder.pairs.absolute():
            whole.refuse(
                "pairs",
                "pairs: the batch writes {path} anew each time; name a copy of it, with another name",
                path=pairs,
            )
        items = self._items(pool)
        if not items and not self._misses_scan:
            whole.refuse("scans" if "scans" in whole else None, "no scan is named; give scans = [...]")
        return Manifest(
            path=self._path,
            folder=self._folder,
            items=tuple(items),
            photos=tuple(pool),
            pairs=None if pairs is None else self._path.parent / pairs,
            photo_lines=self._photo_lines,
        )

    def _files(self, table, key, what):
        """(place, path) of the files that a list of names and patterns means; None where there is no list."""
        texts = table.texts(key)
        if texts is None:
            return None
        found = []
        for place, text in texts:
            paths = self._matching(text)
            self._misses_scan |= what == "scan" and not paths
            if not paths and text and is_there(self._path.parent / text):
                inside = f'"{text.rstrip("/")}/*"'
                table.refuse(place, "{what} {text!r}: is a folder; write {inside}", what=what, text=text, inside=inside)
            elif not paths:
                near = self._hint(text, SCAN_SUFFIXES if what == "scan" else IMAGE_SUFFIXES)
                table.refuse(place, "{what} {text!r}: there is no such file{hint}", what=what, text=text, hint=near)
            if what == "photo":
                for path in paths:
                    self._photo_lines.setdefault(path, self._lines.of(*table.at, *place))
                    if path.suffix.lower() not in IMAGE_SUFFIXES:
                        table.refuse(
                            place,
                            "photo {path}: is no image by its name; expected one of {known}",
                            path=path,
                            known=", ".join(IMAGE_SUFFIXES),
                        )
            found += [((*table.at, *place), path) for path in paths]
        return found

    @cached_property
    def _files_below(self):
        """The names of files in the manifest's folder and below, as a manifest has them."""
        return [self._seen(path).as_posix() for path in islice(files_below(self._path.parent), _MOST_FILES)]

    def _hint(self, text, suffixes):
        """What was probably meant by the name of a file of some kind; not for each of very many."""
        self._hints += 1
        known = self._files_below if text and self._hints <= _MOST_HINTS else ()
        return hint(text, [name for name in known if name.lower().endswith(tuple(suffixes))])

    def _matching(self, text):
        """The files that a name or a pattern means."""
        folder = self._path.parent
        try:
            # The name of an existing file is taken literally: it may contain brackets.
            if (folder / text).is_file():
                return [folder / text]
            pattern = Path(text)
            if pattern.is_absolute():
                folder, pattern = Path(pattern.anchor), pattern.relative_to(pattern.anchor)
            return sorted(path for path in folder.glob(str(pattern)) if path.is_file())
        except (OSError, ValueError):  # a null character, an empty pattern
            return []

    def _seen(self, path):
        """A path as it is seen from the manifest's folder, if it lies below that."""
        folder = self._path.parent
        return path.relative_to(folder) if path.is_relative_to(folder) else path

    def _items(self, pool):
        places = {}
        for at, path in self._files(self._whole, "scans", "scan") or []:
            places.setdefault(path, at)
        tables = self._scan_tables()
        entries = {path: [] for path in places}
        for table in tables:
            files = self._files(table, "file", "scan") or []
            for _, path in files:
                entries.setdefault(path, []).append(table)
                places[path] = table.at
            if not files:
                self._look_over(table)
        of_each = self._whole
        groups, skipped = {}, set()
        for path, own in entries.items():
            chain = [of_each, *own]
            if last_value(own, "skip", bool, False):
                skipped.add(path)
                continue
            site = last_value(own, "site", str, None)
            key = ("site", site) if site else ("file", str(path))
            groups.setdefault(key, []).append((path, chain))
        self._refuse_same_names(groups)
        given = [
            key if kind == "site" else last_value(members[0][1][1:], "name", str, None)
            for (kind, key), members in groups.items()
        ]
        names = item_names(given, [self._seen(members[0][0]) for members in groups.values()])
        return [self._item(name, members, places, pool) for name, members in zip(names, groups.values(), strict=True)]

    def _refuse_same_names(self, groups):
        """Refuse a name or a site that results of another item have; one table may give one to many files."""
        first = {}
        for (kind, _), members in groups.items():
            key = "site" if kind == "site" else "name"
            table = next((table for table in reversed(members[0][1][1:]) if key in table), None)
            name = None if table is None else table.get(key, str)
            if name is not None:
                other, its_key = first.setdefault(safe_label(name).casefold(), (table, key))
                if other is not table:
                    line = self._lines.of(*other.at, its_key)
                    told = "{key} {name!r}: line {line_of} has it, too; give each its own"
                    table.refuse(key, told, key=key, name=name, line_of=line)

    def _look_over(self, table):
        """Find what else is wrong with a table whose scan does not exist."""
        chain = [self._whole, table]
        for key, kind in (("name", str), ("site", str), ("skip", bool)):
            table.get(key, kind)
        self._wanted([table])
        names = [text for _, text in table.texts("file") or ()]
        name, photos = PurePath(names[0]).stem if names else "", self._files(table, "photos", "photo")
        self._hand([table], name)
        self._seeds([table], name, photos)
        for find in (settings_of, reading_of, texture_of, faces_of, self._outputs):
            find(chain)

    def _scan_tables(self):
        if "scan" not in self._whole:
            return []
        found = self._whole["scan"]
        if not isinstance(found, list) or not all(isinstance(values, dict) for values in found):
            self._whole.refuse("scan", "scan: expected [[scan]] tables")
            return []
        tables = [ManifestTable(values, ("scan", place), self) for place, values in enumerate(found)]
        for table in tables:
            table.known((*_OF_ONE, *_OF_EACH), of_all=_OF_ALL)
            if "file" not in table:
                table.refuse(None, "file: is missing; say which scan is meant")
        return tables

    def _item(self, name, members, places, pool):
        path, own = members[0][0], self._tables_of(members)
        chain = [self._whole, *own]
        photos = _last_files(self, own)
        seeds = self._seeds(chain, name, photos if photos is not None else pool)
        hand = self._hand(own, name)
        offered = photos is None and seeds is None and bool(pool)
        photos = pool if photos is None else photos
        place = places[path]
        given = next((table["photos"] for table in reversed(chain) if "photos" in table), [])
        # Of seeds and photos that do not exist it was told.
        if seeds is None and not photos and given == [] and not any("seeds" in table for table in chain):
            self.refuse_at(place, "{path}: has neither seeds nor photos; give one of them", path=path)
        outputs, wanted = self._outputs(chain), self._wanted(own)
        plan = Plan(
            scans=tuple(path for path, _ in members),
            wanted=("all" if len(members) == 1 else None) if wanted is None else str(wanted),
            name=name,
            seeds=seeds,
            hand=hand,
            photos=tuple(photos),
            settings=settings_of(chain),
            reading=reading_of(chain),
            outputs=outputs,
            texture=texture_of(chain),
            faces=faces_of(chain),
        )
        return Item(
            name=name,
            plan=plan,
            offered=offered,
            line=self._lines.of(*place),
            blender_line=self._blender_line(chain, place),
            number=wanted if isinstance(wanted, int) else None,
        )

    def _blender_line(self, chain, place):
        """The line that asks for what only Blender can do; that of the scan where none does."""
        for table in reversed(chain):
            for at, text in table.texts("write") or ():
                if RESULT_SUFFIXES.get("." + text.removeprefix(".").lower()) == SCENE:
                    return self._lines.of(*table.at, *at)
            for key, kind in (("render", bool), ("faces", int)):
                if table.get(key, kind):
                    return self._lines.of(*table.at, key)
        return self._lines.of(*place)

    def _wanted(self, own):
        """Which scan of a file is meant, by its name or its number; None where that is not said."""
        wanted = last_value(own, "scan", (str, int), None)
        if isinstance(wanted, int) and wanted < 1:
            table = next(table for table in reversed(own) if "scan" in table)
            table.refuse("scan", "scan {wanted}: expected a name, or a number from 1", wanted=wanted)
        return wanted

    def _tables_of(self, members):
        """The tables of all scans of an item; those of a site may not disagree, for they are worked on together."""
        tables = list({id(table): table for _, chain in members for table in chain[1:]}.values())
        if len(members) == 1:
            return tables
        for table in tables:
            if "scan" in table:
                table.refuse("scan", "scan: a scan of a site is one of a file of its own; leave it out")
        for key in _OF_SITE:
            # What counts for each scan: the last table that has it; settings add up.
            chains = [[table for table in chain[1:] if key in table] for _, chain in members]
            values = [[table[key] for table in chain] for chain in chains if chain]
            values = [_merged(own) if key in _TABLES else own[-1] for own in values]
            tables_of_key = [chain[-1] for chain in chains if chain]
            for table, value in zip(tables_of_key, values, strict=True):
                if value != values[0]:
                    table.refuse(key, "{key}: another scan of the same site has another value; give one", key=key)
                    break
        return tables

    def _hand(self, own, name):
        table = next((table for table in reversed(own) if "hand" in table), None)
        text = None if table is None else table.get("hand", str)
        if text is None:
            return None
        path = self._path.parent / text
        if not _files_of_each(path, name):
            self._refuse_missing(table, "hand", text, name)
            return None
        return path

    def _refuse_missing(self, table, key, text, name):
        """Refuse a file that an item of this name needs and that does not exist."""
        path = filled(self._path.parent / text, name)
        near = self._hint(str(filled(text, name)), (".json",))
        table.refuse(key, "{key} {text!r}: there is no file {path}{hint}", key=key, text=text, path=path, hint=near)

    def _seeds(self, chain, name, photos):
        """The seeds of an item; one that the manifest names for all scans need not be there where photos are."""
        for table in reversed(chain):
            text = table.get("seeds", str)
            if text is None:
                continue
            path = self._path.parent / text
            if _files_of_each(path, name):
                return path
            if table is not self._whole or not photos:
                self._refuse_missing(table, "seeds", text, name)
            return None
        return None

    def _outputs(self, chain):
        outputs = []
        for table in reversed(chain):
            texts = table.texts("write")
            if texts is None:
                continue
            for place, text in texts:
                if text.removeprefix(".").lower() not in _RESULTS:
                    table.refuse(place, "write {text!r}: expected one of {known}", text=text, known=", ".join(_RESULTS))
                else:
                    outputs.append("." + text.removeprefix(".").lower())
            break
        else:
            outputs.append(".png")
        found = [
            Output("write", self._folder.result(PLACEHOLDER, suffix), RESULT_SUFFIXES[suffix])
            for suffix in dict.fromkeys(outputs)
        ]
        if last_value(chain, "render", bool, False):
            found.append(Output("render", self._folder.render(PLACEHOLDER), RENDER))
        return (*found, *self._folder.records(PLACEHOLDER))


def _files_of_each(path, name):
    """See `files_of_each`; none where a name is too long, or none at all."""
    try:
        return files_of_each(path, name)
    except (OSError, ValueError):
        return []


def _merged(values):
    """Settings of several tables together; what is no table is reported where it is used."""
    merged = {}
    for value in values:
        merged |= value if isinstance(value, dict) else {}
    return merged


def _last_files(reader, tables):
    for table in reversed(tables):
        if "photos" in table:
            return list(dict.fromkeys(path for _, path in reader._files(table, "photos", "photo")))
    return None
