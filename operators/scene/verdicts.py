"""What was found of each photo on each scan."""

from .texts import shown


def verdict_of(obj, image):
    """Return the verdict on a photo, as the scan's object keeps it; None where they were not matched."""
    if obj is None or image is None:
        return None
    return next((verdict for verdict in obj.reflcolor.verdicts if verdict.image == image), None)


def keep_verdicts(obj, matches):
    """Keep with a scan's object what was found of photos: pairs of an image and a PhotoMatch.

    Other photos keep theirs; those of images that are gone are dropped.
    """
    verdicts = obj.reflcolor.verdicts
    for index in reversed(range(len(verdicts))):
        if verdicts[index].image is None:
            verdicts.remove(index)
    for image, match in matches:
        verdict = verdict_of(obj, image) or verdicts.add()
        verdict.image, verdict.verified, verdict.note = image, match.verified, shown(match.note)
