"""Learning at rest: the way of a sample, and what it learns from."""
