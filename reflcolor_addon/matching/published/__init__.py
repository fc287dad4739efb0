"""Matching as the paper has it: superpixels and HOG."""
