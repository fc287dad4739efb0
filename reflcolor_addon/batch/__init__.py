"""From files to files: plan, check, run, write."""
