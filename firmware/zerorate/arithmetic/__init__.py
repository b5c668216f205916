"""Fixed-point numbers that never leave 31 bits."""
