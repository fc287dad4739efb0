"""The native kernel: its library, and what of it needs no graph of pixels."""
