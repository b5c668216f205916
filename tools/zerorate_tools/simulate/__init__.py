"""Recordings of devices that never were, with the truth behind them."""

from .description import bundled_names, load_description, reference
from .device import Truth, simulate, simulate_sessions
from .output import read_truth, simulate_to_files, write_truth

__all__ = [
    "Truth", "bundled_names", "load_description", "read_truth", "reference", "simulate",
    "simulate_sessions", "simulate_to_files", "write_truth",
]  # fmt: skip
