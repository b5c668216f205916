"""Foreign recordings into the project's own form."""

from .conversion import Options, Report
from .importing import import_recording, read_foreign
from .layouts.hipnuc_bins import read_bins
from .mapping import Mapped, parsed_mapping

__all__ = [
    "Mapped",
    "Options",
    "Report",
    "import_recording",
    "parsed_mapping",
    "read_bins",
    "read_foreign",
]
