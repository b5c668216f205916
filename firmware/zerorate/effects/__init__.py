"""What the closed loop has found, subtracted."""
