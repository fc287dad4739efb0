"""The camera of a photo: found, refined, and verified."""
