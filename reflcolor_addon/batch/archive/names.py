"""Names for the files of a batch that say which scan they come from; no two are equal."""

from collections import Counter

from ..read import distinct, safe_label


def item_names(given, paths):
    """Return a name for each item of a batch.

    Parameters
    ----------
    given : list of str or None
        What the manifest calls it, if it does.
    paths : list of Path
        Its first scan, seen from the manifest's folder.

    Returns
    -------
    list of str
        Safe in file names, and different even if capitals are ignored: the file's name without its suffix. Where files
        in several folders have the same, that of as many folders as it takes stands before it; where they differ in
        their suffix, that is kept.
    """
    ways = [_ways(path) if name is None else [safe_label(name)] for name, path in zip(given, paths, strict=True)]
    names, open_ones = [own[0] for own in ways], set(range(len(ways)))
    depth = 0
    while open_ones:
        depth += 1
        count = Counter(name.casefold() for name in names)
        open_ones = {k for k in open_ones if count[names[k].casefold()] > 1 and depth < len(ways[k])}
        for k in open_ones:
            names[k] = ways[k][depth]
    # What no folder and no suffix tells apart is numbered.
    count = Counter(name.casefold() for name in names)
    names = [own[0] if count[name.casefold()] > 1 else name for own, name in zip(ways, names, strict=True)]
    return distinct(names, joint="_", key=str.casefold)


def _ways(path):
    """Names for a scan's file, each longer than the one before."""
    whole = path.name
    stem = whole.removesuffix("".join(path.suffixes[-2:])) if whole.lower().endswith(".scan.json") else path.stem
    folders = [part for part in path.parts[:-1] if part not in ("..", path.anchor)]
    before = [folders[start:] for start in range(len(folders) - 1, -1, -1)]
    names = [stem, *("_".join([*some, stem]) for some in before), whole, "_".join([*folders, whole])]
    return [safe_label(name) for name in names]
