"""What ties Blender's data to arrays."""
