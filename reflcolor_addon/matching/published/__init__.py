"""Matching as published: superpixels and HOG."""
