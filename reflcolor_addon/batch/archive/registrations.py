"""Stores which photo shows which scan, and from where, so that no pair is matched twice."""

from ...files.images import write_png
from ...files.readers.options import AS_IT_IS
from ...matching.registration.registration import Registration
from ...matching.registration.stored import as_document, from_document
from ..paths import scan_files
from .fingerprints import digest_of, program_digest

KIND = "matched"


class Registrations:
    """What `Session.registrations` asks for: registrations kept in the folder of a batch, by the hashes of the files.

    Parameters
    ----------
    folder : BatchFolder
    hashes : dict of str to str
        The hash of every file of the scans and of every photo, by its path as text.
    reading : ReadOptions
        How the scans are read.
    helpers : dict of str to list of str, optional
        For the paths of photos that were placed by what they have in common with others the hashes of those.

    Attributes
    ----------
    recalled : int
        How many were found here.
    """

    def __init__(self, folder, hashes, reading=AS_IT_IS, helpers=None):
        self._folder, self._hashes, self._reading = folder, hashes, reading.as_dict()
        self._helpers = helpers or {}
        self.recalled, self._placed = 0, None

    def __call__(self, job, photo, register):
        """Return the `Registration` of a photo on a scan; ``register()`` finds it where it is not known yet."""
        found = self.known(job, photo)
        if found is None:
            return self._keep(self._key(job, photo), job, photo, register())
        self.recalled += self._placed != (job, photo)
        return found

    def known(self, job, photo):
        """Return the `Registration` of a photo on a scan, by other photos or by itself; None if it is not known."""
        by_itself = self._recall(self._key(job, photo))
        by_others = self._recall(self._key_by_others(job, photo)) if str(photo) in self._helpers else None
        if by_others is not None and not by_others.accepted:
            by_others = None
        found = by_itself
        if by_others is not None and (found is None or by_others.preferable_to(found)):
            found = by_others
        return found

    def place(self, job, photo, place):
        """Have a photo placed on a scan by others, and keep the result, unless that is known from before.

        ``place()`` returns its `Registration`, or None.
        """
        key = self._key_by_others(job, photo)
        if key is not None and self._recall(key) is None:
            found = place()
            self._keep(key, job, photo, Registration.nothing("overlap") if found is None else found)
            self._placed = job, photo

    def _keep(self, key, job, photo, registration):
        if key is not None:
            of = {"scan": str(job.path), "number": job.index, "photo": str(photo)}
            self._folder.remember(KIND, key, {"registration": as_document(registration)} | of)
        return registration

    def _recall(self, key):
        """The registration that is kept by a key; None where there is none."""
        known = key and self._folder.recall(KIND, key)
        if not known:
            return None
        try:
            return from_document(known["registration"])
        except (KeyError, ValueError):
            return None  # written by a program that died, or by hand: found anew

    def keep_picture(self, job, photo, picture):
        """Keep a picture (h, w, 3) uint8 of what a scan measured where a photo was found to show it.

        Returns
        -------
        str or None
            What `BatchFolder.sketch` finds it by; None where it cannot be kept.
        """
        key = self._key(job, photo, "picture")
        if key is not None:
            write_png(self._folder.sketch(key), picture)
        return key

    def _key_by_others(self, job, photo):
        helpers = self._helpers[str(photo)]
        return self._key(job, photo, "by", *helpers) if all(helpers) else None

    def _key(self, job, photo, *more):
        """What a photo on a scan is kept by; None for files that could not be hashed: which is which is not known."""
        own, other = [self._hashes[str(file)] for file in scan_files(job.path)], self._hashes[str(photo)]
        if not (all(own) and other):
            return None
        return digest_of([program_digest(), own, self._reading, job.index, other, *more])
