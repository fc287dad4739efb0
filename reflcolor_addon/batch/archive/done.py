"""Records of finished work: one for each item and stage, and whether it is still valid."""

import time
from contextlib import suppress
from pathlib import Path

from ...files.refusals import unwritable
from ..plan_document import as_document
from .fingerprints import digest_of, program_digest

# Records of finished work, and of work that is being done again.
KIND, BEGUN = "done", "begun"


class Done:
    """The records of a batch.

    Parameters
    ----------
    folder : BatchFolder
    fingerprints : Fingerprints
    """

    def __init__(self, folder, fingerprints):
        self._folder, self._fingerprints = folder, fingerprints

    def key(self, stage, plan, hashes, placed_by=None):
        """Return the key that identifies a piece of work: hashes of its inputs, its settings, and of the program.

        Parameters
        ----------
        stage : str
        plan : Plan
        hashes : dict of str to str
            Of every input, by its path; an empty text for one that could not be hashed. Then the key is empty, too, and
            nothing counts as done.
        placed_by : dict of str to list of str, optional
            See `Matched.placed_by`.
        """
        if not all(hashes.values()):
            return ""
        return digest_of(
            [program_digest(), stage, as_document(plan), sorted(hashes.items()), sorted((placed_by or {}).items())]
        )

    def record(self, name, stage, key, outcome):
        """Record that something is done. It is called last, when the outputs exist."""
        outputs = {path: self._output(path) for path in outcome["written"]}
        kept = {name: outcome.get(name) for name in ("warnings", "left_out", "photos", "seconds")}
        self._folder.remember(KIND, f"{name} {stage}", {"key": key, "ended": time.time(), "outputs": outputs} | kept)

    def recall(self, name, stage, key=None, since=None):
        """Return the record of finished, complete work, with this key if one is given; else None.

        With ``since``, a time in seconds since 1970, work that was finished earlier does not count.
        """
        record = self._folder.recall(KIND, f"{name} {stage}")
        if record is None or (key is not None and (not key or record.get("key") != key)):
            return None
        if since is not None and not record.get("ended", 0.0) > since:
            return None
        outputs = record.get("outputs")
        if not isinstance(outputs, dict) or not all(
            self._is_whole(path, recorded) for path, recorded in outputs.items()
        ):
            return None
        return record

    def amend(self, name, stage, path):
        """Update a record after a later stage has rewritten one of its outputs."""
        record = self._folder.recall(KIND, f"{name} {stage}")
        if record is not None and str(path) in record["outputs"]:
            record["outputs"][str(path)] = self._output(path)
            self._folder.remember(KIND, f"{name} {stage}", record)

    def begin(self, name, stage):
        """Make a record invalid before its outputs are written again.

        Its `outputs` are known until `end`, so that those which are not written again are still found if the batch is
        killed meanwhile.
        """
        path = self._folder.state(KIND, f"{name} {stage}.json")
        try:
            if path.exists():
                path.replace(self._folder.state(BEGUN, path.name))
        except OSError:
            # That it is invalid is what counts.
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                raise unwritable(path, error) from error

    def end(self, name, stage):
        """Forget what was there before a stage began, now that all of it is written again or deleted."""
        with suppress(OSError):
            self._folder.state(BEGUN, f"{name} {stage}.json").unlink(missing_ok=True)

    def outputs(self, name, stage):
        """Return the outputs of an item, by their paths what is recorded of each; none where nothing is recorded."""
        outputs = {}
        for kind in (BEGUN, KIND):
            found = (self._folder.recall(kind, f"{name} {stage}") or {}).get("outputs")
            outputs |= found if isinstance(found, dict) else {}
        return outputs

    def delete(self, outputs):
        """Delete of recorded `outputs` those that are still as they were written; return their paths."""
        deleted = []
        for path, recorded in outputs.items():
            if self._is_whole(path, recorded):
                try:
                    Path(path).unlink()
                except OSError as error:
                    raise unwritable(Path(path), error) from error
                deleted.append(path)
        return deleted

    def _output(self, path):
        return [*_state(Path(path)), self._fingerprints.of(path)]

    def _is_whole(self, path, recorded):
        path = Path(path)
        try:
            size, mtime = _state(path)
            # The files of a copied folder have other times; then their bytes are compared.
            return size == recorded[0] and (mtime == recorded[1] or self._fingerprints.of(path) == recorded[2])
        except (OSError, LookupError, TypeError):
            return False


def _state(path):
    found = path.stat()
    return found.st_size, found.st_mtime_ns
