"""Layouts of public recordings that are recognised by their first line or variables.

Each module has `recognises(path) -> bool` and `read(path) -> Foreign`; order does not matter.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType

NAMES = (
    *("adis16405_counts", "broad_trial", "gy521_cooldown", "hipnuc_bins", "hub_means"),
    *("mpu6050_unmoved", "vectornav_ascii"),
)


def layout(name: str) -> ModuleType:
    """A layout's module by its name."""
    return import_module(f"{__name__}.{name}")


def recognised(path: Path) -> str | None:
    """The name of the layout that this file has, or None."""
    return next((name for name in NAMES if layout(name).recognises(path)), None)
