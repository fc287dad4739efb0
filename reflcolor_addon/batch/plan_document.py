"""A plan as JSON: so it goes from one process to another, and so it is told whether it was done already."""

from dataclasses import asdict
from pathlib import Path

from ..files.readers.options import ReadOptions
from ..settings import Settings
from ..view.picture import Picture
from .plan import Output, Plan


def as_document(plan):
    """Return a `Plan` as what JSON can hold."""
    return {
        "scans": [str(path) for path in plan.scans],
        "outputs": [[output.option, str(output.path), output.kind] for output in plan.outputs],
        "settings": plan.settings.as_dict(),
        "wanted": plan.wanted,
        "name": plan.name,
        "seeds": None if plan.seeds is None else str(plan.seeds),
        "hand": None if plan.hand is None else str(plan.hand),
        "photos": [str(path) for path in plan.photos],
        "colors": None if plan.colors is None else str(plan.colors),
        "from_color": plan.from_color,
        "outside_files": plan.outside_files,
        "reading": plan.reading.as_dict(),
        "texture": plan.texture,
        "faces": plan.faces,
        "picture": asdict(plan.picture),
        "left_out": list(plan.left_out),
        "skip_unshown": plan.skip_unshown,
    }


def from_document(document):
    """Return the `Plan` that `as_document` described."""
    return Plan(
        scans=tuple(map(Path, document["scans"])),
        outputs=tuple(Output(option, Path(path), kind) for option, path, kind in document["outputs"]),
        settings=Settings(**document["settings"]),
        wanted=document["wanted"],
        name=document["name"],
        seeds=None if document["seeds"] is None else Path(document["seeds"]),
        hand=None if document["hand"] is None else Path(document["hand"]),
        photos=tuple(map(Path, document["photos"])),
        colors=None if document["colors"] is None else Path(document["colors"]),
        from_color=document["from_color"],
        outside_files=document["outside_files"],
        reading=reading_of(document["reading"]),
        texture=document["texture"],
        faces=document["faces"],
        picture=Picture(**document["picture"]),
        left_out=tuple(document["left_out"]),
        skip_unshown=document["skip_unshown"],
    )


def reading_of(document):
    """Return the `ReadOptions` of a dictionary."""
    if document.get("position") is not None:
        document = document | {"position": tuple(document["position"])}
    return ReadOptions(**document)
