"""Scene 1: two road cones."""
