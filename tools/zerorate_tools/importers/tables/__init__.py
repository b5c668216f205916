"""Files as tables: named columns of numbers, in chunks."""
