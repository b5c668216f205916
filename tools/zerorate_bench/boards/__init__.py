"""The firmware on an emulated Pico: memory, time, and equal numbers."""
