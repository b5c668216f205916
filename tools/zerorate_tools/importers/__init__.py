"""Foreign recordings into the project's own form: kinds, tables, columns, samples."""

from .columns.mapping import Mapped, parsed_mapping
from .cutting import cut
from .importing import import_recording, import_together, read_foreign
from .report import Options, Report

__all__ = [
    "Mapped",
    "Options",
    "Report",
    "cut",
    "import_recording",
    "import_together",
    "parsed_mapping",
    "read_foreign",
]
