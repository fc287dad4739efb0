"""What a run is to do: from which files, with which settings, to which files."""

from dataclasses import dataclass, field, replace
from pathlib import Path

from ..errors import UsageError
from ..files.readers.options import AS_IT_IS, ReadOptions
from ..files.writers.scans_back import SCAN_FILES
from ..settings import Settings
from ..view.picture import Picture

PLACEHOLDER = "{scan}"
"""Stands for a scan's label in the path of what each of several scans has of its own."""
IMAGE, MESH, SCANS, SCENE = "image", "mesh", "scans", "scene"
RENDER, REPORT, SEEDS, MATCHES, PREVIEW = "render", "report", "seeds", "matches", "preview"
RESULT_SUFFIXES = {
    ".png": IMAGE,
    ".ply": MESH,
    ".glb": MESH,
    **dict.fromkeys(SCAN_FILES, SCANS),
    ".blend": SCENE,
    ".usd": SCENE,
}
"""What a colorized scan is written as, by the suffix of its file."""


@dataclass(frozen=True)
class Output:
    """A file to write.

    Parameters
    ----------
    option : str
        The option that asks for it, for messages.
    path : Path
        The placeholder stands for a scan's label.
    kind : str
        One of this module's kinds.
    """

    option: str
    path: Path
    kind: str

    @property
    def is_scene(self):
        """Whether it shows a scene, in which there is room for several scans."""
        return self.needs_blender or self.kind in (MESH, SCANS)

    @property
    def needs_blender(self):
        """Whether only Blender can write it."""
        return self.kind in (SCENE, RENDER)

    @property
    def has_mesh(self):
        """Whether it shows a mesh, which can have fewer faces."""
        return self.kind in (MESH, SCENE, RENDER)

    @property
    def is_of_each(self):
        """Whether each of several scans has its own."""
        return not self.is_scene or PLACEHOLDER in str(self.path)

    def of(self, label):
        """Return the same for the scan with that label."""
        return replace(self, path=filled(self.path, label))


@dataclass(frozen=True, kw_only=True)
class Plan:
    """One run of the pipeline, before anything was looked at; it can be pickled.

    Parameters
    ----------
    scans : tuple of Path
        Files of scans; several are of one site and are worked on together.
    outputs : tuple of Output
    settings : Settings
    wanted : str, optional
        Which scan of a file with several: its name, its index counted from 1, or "all".
    name : str, optional
        What stands for the label of a scan that is the only one, and before the labels of several.
    seeds : Path, optional
        A file of seeds; without one they are found in the photos.
    hand : Path, optional
        A file of seeds picked by hand, to find the others with.
    from_color : int, optional
        How many seeds to take from the scan's own colors instead.
    photos : tuple of Path
        Photos that the seeds name, or that seeds are found in.
    colors : Path, optional
        A colorized image for each scan, whose colors are taken as they are.
    outside_files : bool
        Let a `.scan.json` name images outside of its own folder.
    reading : ReadOptions
        How the scans are to be read.
    texture : int, optional
        Texels along the longer side of an image of the photos' resolution; without it colors are at the vertices.
    faces : int, optional
        How many triangles the mesh of each scan has at most, where a mesh is written.
    picture : Picture
        How scenes and pictures show the scans.
    left_out : tuple of str
        Labels of scans that are left out.
    skip_unshown : bool
        Whether scans for which no seeds are found are left out, instead of refused.
    """

    scans: tuple[Path, ...]
    outputs: tuple[Output, ...]
    settings: Settings = field(default_factory=Settings)
    wanted: str | None = None
    name: str | None = None
    seeds: Path | None = None
    hand: Path | None = None
    from_color: int | None = None
    photos: tuple[Path, ...] = ()
    colors: Path | None = None
    outside_files: bool = False
    reading: ReadOptions = AS_IT_IS
    texture: int | None = None
    faces: int | None = None
    picture: Picture = field(default_factory=Picture)
    left_out: tuple[str, ...] = ()
    skip_unshown: bool = False

    @property
    def needs_colors(self):
        """Whether an output needs the scans to be colorized."""
        return any(output.kind not in (SEEDS, MATCHES) for output in self.outputs)

    @property
    def needs_light_mesh(self):
        """Whether an output shows meshes that are to have fewer faces."""
        return self.faces is not None and any(output.has_mesh for output in self.outputs)

    @property
    def needs_blender(self):
        """Whether only Blender can do it."""
        return self.needs_light_mesh or any(output.needs_blender for output in self.outputs)

    def paths_of_each(self):
        """Return (option, path) of all files that each of several scans must have of its own."""
        given = [("--seeds", self.seeds), ("--hand", self.hand)]
        return [(output.option, output.path) for output in self.outputs if not output.is_scene] + [
            (option, path) for option, path in given if path is not None
        ]


def result_output(path, option="-o"):
    """Return the Output for a colorized scan.

    Raises
    ------
    UsageError
        If the suffix does not tell what to write.
    """
    kind = RESULT_SUFFIXES.get(path.suffix.lower())
    if kind is None:
        raise UsageError(
            "{option} {path}: the suffix tells what to write; expected one of {known}",
            option=option,
            path=path,
            known=", ".join(RESULT_SUFFIXES),
        )
    return Output(option, path, kind)


def filled(path, label):
    """Return a path with a scan's label instead of the placeholder."""
    return Path(str(path).replace(PLACEHOLDER, label))


def default_settings(preset):
    """Return the settings of a preset as command line and batches have them.

    All seeds of a large scan can take minutes, so here the paper's exactness has to be asked for.
    """
    settings = Settings.preset(preset)
    return replace(settings, nearest="auto") if settings.nearest is None else settings
