"""Which column of a table is which of a recording, and in what unit."""
