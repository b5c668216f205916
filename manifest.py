"""Freezes the firmware and the driver into a MicroPython build: include() this from the board's."""

metadata(version="0.1.0", description="Keeps a gyroscope's zero-rate output at zero")  # noqa: F821
include("firmware/manifest.py")  # noqa: F821
include("drivers/manifest.py")  # noqa: F821
