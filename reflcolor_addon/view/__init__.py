"""What an editor shows: framing, picking, color maps, live preview."""
