"""Which effects are there: catalogue, selection, multiple testing, drift, naming."""
