"""Stores which photo shows which scan, and from where, so that no pair is matched twice."""

from ...files.images import write_png
from ...files.readers.options import AS_IT_IS
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

    Attributes
    ----------
    recalled : int
        How many were found here.
    """

    def __init__(self, folder, hashes, reading=AS_IT_IS):
        self._folder, self._hashes, self._reading = folder, hashes, reading.as_dict()
        self.recalled = 0

    def __call__(self, job, photo, register):
        """Return the `Registration` of a photo on a scan; ``register()`` finds it where it is not known yet."""
        key = self._key(job, photo)
        if key is None:
            return register()
        known = self._folder.recall(KIND, key)
        if known is not None:
            try:
                registration = from_document(known["registration"])
                self.recalled += 1
                return registration
            except (KeyError, ValueError):
                pass  # written by a program that died, or by hand: found anew
        registration = register()
        self._folder.remember(KIND, key, {"registration": as_document(registration)})
        return registration

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

    def _key(self, job, photo, *more):
        """What a photo on a scan is kept by; None for files that could not be hashed: which is which is not known."""
        own, other = [self._hashes[str(file)] for file in scan_files(job.path)], self._hashes[str(photo)]
        if not (all(own) and other):
            return None
        return digest_of([program_digest(), own, self._reading, job.index, other, *more])
