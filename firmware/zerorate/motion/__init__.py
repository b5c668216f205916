"""Learning in motion: the slope of integrated orientation."""
