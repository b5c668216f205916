"""Freezes the driver alone; ../manifest.py freezes it with the firmware."""

import os

_HERE = sorted(os.listdir("zerorate_i2c"))
_FILES = [name for name in _HERE if name.endswith(".py") and name != "linux.py"]
package("zerorate_i2c", files=_FILES)  # noqa: F821
