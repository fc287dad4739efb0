"""The command line inside Blender: blender -b --command reflcolor ..."""

import bpy

from ..reflcolor_addon.batch.blender_tasks import BlenderTasks
from ..reflcolor_addon.cli import main as cli
from .scene.decimation import decimate
from .scene.provenance_file import read_provenance
from .scene.simulate_file import simulate_file
from .scene.write_results import write_results


def run(argv, command=None):
    """Run the command line with all that Blender can do; return the exit status.

    Parameters
    ----------
    argv : list of str
    command : tuple of str, optional
        What starts it in another process; by default Blender itself is started again.
    """
    if command is None and bpy.app.binary_path:
        command = (bpy.app.binary_path, "-b", "--command", "reflcolor")
    tasks = BlenderTasks(
        version=bpy.app.version_string,
        write_scene=write_results,
        decimate=decimate,
        simulate=simulate_file,
        read_provenance=read_provenance,
        command=command,
    )
    return cli.main(argv, prog="blender -b --command reflcolor", blender=tasks)


_commands = []


def register():
    """Add the command."""
    _commands.append(bpy.utils.register_cli_command("reflcolor", run))


def unregister():
    """Take it out again."""
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())
