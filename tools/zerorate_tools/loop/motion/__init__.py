"""What only motion shows: scale factor, cross-axis sensitivity, late readings."""
