"""The command line inside Blender: blender -b --command reflcolor ..."""

import bpy

from ..reflcolor_addon import cli
from .write_results import write_results


def run(argv):
    """Run the command line with Blender's outputs; return the exit status."""
    return cli.main(
        argv, scene_writer=write_results, prog="blender -b --command reflcolor", blender=bpy.app.version_string
    )
