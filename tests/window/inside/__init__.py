"""What runs inside the Blender under test: it drives the scenarios and gives them hands and eyes."""
