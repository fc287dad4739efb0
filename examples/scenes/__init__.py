"""What the example scenes share."""
