"""What was learned, kept over a power-off: two slots, when they are written, and where."""
