"""Freezes the firmware into a MicroPython build: include() this from the board's manifest."""

metadata(version="0.1.0", description="Keeps a gyroscope's zero-rate output at zero")  # noqa: F821
package("zerorate")  # noqa: F821
