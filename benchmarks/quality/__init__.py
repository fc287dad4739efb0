"""How good the colors are, measured against the truth, with the true colors at the centers of superpixels as seeds."""
