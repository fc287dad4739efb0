"""From photos with known cameras to colors of the scan."""
