"""report.html: what the loop found, for a person, in one file that needs no network."""

from .page import write_report

__all__ = ["write_report"]
