"""The command line inside Blender: blender -b --command reflcolor ..."""

import bpy

from ..reflcolor_addon import cli
from ..reflcolor_addon.blender_door import BlenderDoor
from .provenance_file import read_provenance
from .simulate_file import simulate_file
from .write_results import write_results


def run(argv):
    """Run the command line with all that Blender can do; return the exit status."""
    door = BlenderDoor(
        version=bpy.app.version_string,
        write_scene=write_results,
        simulate=simulate_file,
        read_provenance=read_provenance,
    )
    return cli.main(argv, prog="blender -b --command reflcolor", blender=door)
