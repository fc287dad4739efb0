"""Whole archives: a manifest of many scans, worked on by several processes at once."""
