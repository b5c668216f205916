"""Freezes the firmware alone; ../manifest.py freezes it with the driver."""

package("zerorate")  # noqa: F821
