"""What belongs to Blender's window: tools, pointer, long work, live update."""
