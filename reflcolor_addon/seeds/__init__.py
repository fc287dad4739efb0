"""Seeds: pixels of known color, and their JSON files."""
