"""Reports of runs: inputs, settings, outputs."""
