"""The firmware's kernels, read from their Python and written as C, machine code and libraries."""
