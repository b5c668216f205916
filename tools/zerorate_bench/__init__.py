"""What the firmware costs and how well it does, beside everyone else, on the same samples."""
