"""Many recordings at once: what devices of a part have in common, and a prior for the next one."""

from .devices import Device, devices_of
from .whole_fleet import Fleet, fleet

__all__ = ["Device", "Fleet", "devices_of", "fleet"]
