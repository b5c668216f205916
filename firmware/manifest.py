"""Freezes the firmware alone; ../manifest.py freezes it with the driver.

Of the machine code that is taken which the port's own mpy-cross flags (-march) say it can run.
"""

import os
import sys

_FLAGS = " ".join(sys.argv)
_CODE = {"thumb_": "-march=armv", "rv32_": "-march=rv32"}
_OTHERS = tuple(code for code in _CODE if _CODE[code] not in _FLAGS)
_FILES = [
    os.path.relpath(os.path.join(folder, name), "zerorate")
    for folder, _, names in os.walk("zerorate")
    for name in sorted(names)
    if name.endswith(".py") and not name.startswith(_OTHERS)
]
package("zerorate", files=_FILES)  # noqa: F821
