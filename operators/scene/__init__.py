"""Blender's data to arrays and back."""
