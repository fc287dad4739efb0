"""Method 2: seeds from photos, found by the program."""
