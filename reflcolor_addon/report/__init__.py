"""What was done, with what, to what."""
