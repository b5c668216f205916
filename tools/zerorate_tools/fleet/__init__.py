"""Many recordings at once: what devices of a part have in common, and a prior for the next one."""

from .devices import Device, devices_of
from .fleet_in_words import Fleet
from .whole_fleet import fleet

__all__ = ["Device", "Fleet", "devices_of", "fleet"]
