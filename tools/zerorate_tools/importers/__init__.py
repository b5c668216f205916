"""Foreign recordings into the project's own form: kinds, tables, columns, samples."""

from .columns.mapping import Mapped, parsed_mapping
from .importing import import_recording, read_foreign
from .report import Options, Report

__all__ = ["Mapped", "Options", "Report", "import_recording", "parsed_mapping", "read_foreign"]
