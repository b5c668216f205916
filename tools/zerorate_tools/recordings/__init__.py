"""Recordings: CSV or Parquet with integer columns in raw LSB and their scales (design.md)."""

from .growing import growing_recording, recover
from .reading import OpenRecording, open_recording, read_recording
from .recording import Recording
from .scales import Scales
from .writing import check_output, recording_from_columns, recording_writer, write_recording

__all__ = [
    "OpenRecording", "Recording", "Scales", "check_output", "growing_recording", "open_recording",
    "read_recording", "recording_from_columns", "recording_writer", "recover", "write_recording",
]  # fmt: skip
