"""Scene 2: a person in a room."""
