"""Scene 3: a brick house."""
