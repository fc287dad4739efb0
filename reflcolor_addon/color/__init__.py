"""From seeds to colors: color spaces, chrominance, luminance, and the error against true colors."""
