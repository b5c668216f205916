"""python -m host_tests.drivers.linux_bus: fetch the machine, run on it, print what it found."""

import json

from . import machine
from .run import run_guest

machine.fetch()
print(json.dumps(run_guest(), indent=2))
