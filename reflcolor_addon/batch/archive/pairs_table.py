"""The table of pairs of a batch: all that were tried, and all that were not."""

from collections import defaultdict

from ...messages import Message
from ...report.archive_entries import ITEMS, evidence_text
from .options import COLOR, FAILED
from .pairs import CONTRADICTION, NO, UNTESTED, UNTRIED, YES, write_pairs

# A spreadsheet takes a million rows; of a larger archive only the pairs that were tried are listed.
_MOST_ROWS = 100_000


def write_table(context, matched):
    """Write the table of the items that are offered the photos of the whole batch, as far as is known by now.

    Parameters
    ----------
    context : Context
    matched : Matched

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    manifest = context.manifest
    items = [item for item in manifest.items if item.offered]
    if not items:
        return
    photos = {str(path): manifest.name_of(path) for path in (*manifest.photos, *context.same.photos)}
    with_untried, rows, left_out = len(items) * len(photos) <= _MOST_ROWS, [], 0
    for item in items:
        record = context.done.recall(item.name, COLOR)
        best = _best([*((record or {}).get("photos") or []), *matched.told(item.name)])
        for path, photo in photos.items():
            pair, said = best.get(path), matched.said.get((item.name, path))
            # Fed back once more, the table says the same: what a person says stays, whatever was found.
            if pair is not None and said is not False:
                shows, evidence, note = _said(pair, matched.verdicts.get(path), item.name, matched.decided)
                if said and not pair["verified"]:
                    note = Message("{note}; yes as {file} says", note=note, file=manifest.pairs.name)
                shows = YES if said else shows
                rows.append((item.name, photo, shows, evidence, note))
            elif said is not None:
                shows = YES if said else NO
                rows.append((item.name, photo, shows, "", Message("as {file} says", file=manifest.pairs.name)))
            elif before := _surest(matched.earlier.get(item.name, {}).get(path, ())):
                rows.append((item.name, photo, *_found_earlier(before)))
            elif with_untried:
                rows.append((item.name, photo, UNTRIED, "", _why_untried(context, item, path, matched)))
            else:
                left_out += 1
    write_pairs(context.folder.pairs, sorted(rows))
    context.session.say(Message("wrote {path}", path=context.folder.pairs))
    if left_out:
        context.session.say(
            Message(
                "pairs.csv lists the {count:,} pairs that were tried; the {left_out:,} others would be too many for it",
                count=len(rows),
                left_out=left_out,
            )
        )


def _said(pair, verdict, name, decided):
    """Whether a photo shows an item, the evidence, and a note."""
    if pair["verified"] and not decided:
        # Fed back as it is, it must not decide anything.
        note = Message("{note}; not compared with what other photos and scans show yet", note=pair["note"])
        return "", evidence_text(pair), note
    shows = YES if pair["verified"] else NO if pair["tested"] else UNTESTED
    if verdict is not None and pair["verified"] and name in verdict.refused:
        shows = CONTRADICTION
    note = pair["note"] if verdict is None or not verdict.doubt(name) else f"{pair['note']}; {verdict.doubt(name)}"
    return shows, evidence_text(pair), note


def _found_earlier(pair):
    """The same of a pair that an earlier run has matched: one that was verified decides nothing."""
    note = Message("{note}; found in an earlier run, and not needed in this one", note=pair["note"])
    if pair["verified"]:
        note = Message("{note}; write yes to use it", note=note)
    return "" if pair["verified"] else NO if pair["tested"] else UNTESTED, evidence_text(pair), note


def _best(found):
    """What was found for each photo, by its path; of several scans of an item the one that speaks most for it."""
    of_photo = defaultdict(list)
    for pair in found:
        of_photo[pair["path"]].append(pair)
    return {path: _surest(pairs) for path, pairs in of_photo.items()}


def _surest(pairs):
    """The pair that speaks most for a photo, the first of equal ones; None without any."""
    return max(pairs, key=lambda pair: (pair["verified"], pair["evidence"]), default=None)


def _why_untried(context, item, path, matched):
    same = next((first for photo, first in context.same.photos.items() if str(photo) == path), None)
    if same is not None:
        return Message("the same file as {photo}", photo=context.manifest.name_of(same))
    if item.name in context.same.items:
        return Message("the same scan as {name}", name=context.same.items[item.name])
    if path in context.problems:
        return context.problems[path]
    if (context.folder.recall(ITEMS, item.name) or {}).get("outcome") == FAILED:
        return Message("the scan failed")
    if not matched.decided:
        return Message("not decided yet, because the batch was interrupted")
    if path in matched.verdicts and matched.verdicts[path].shown:
        return Message("the photo shows {names}", names=", ".join(matched.verdicts[path].shown))
    return Message("the photo looked more like other scans")
