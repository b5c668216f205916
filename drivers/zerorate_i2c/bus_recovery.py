"""Free an I2C bus whose SDA a chip holds low, before the bus is opened.

A microcontroller reset in the middle of a read leaves the chip waiting for clocks with SDA low.
NXP UM10204 section 3.1.16: nine clocks bring it to the end of its byte; a STOP ends the transfer.
"""

try:
    import utime as system_clock  # a board's own clock needs no file
except ImportError:
    from . import clock as system_clock  # type: ignore[no-redef]

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_CLOCKS = 9


def free_bus(scl: "Any", sda: "Any", clock: "Any" = None) -> bool:
    """Clock SCL until SDA is let go, nine times at most, and give a STOP; True when SDA is free.

    scl and sda are open-drain pins, Pin(n, Pin.OPEN_DRAIN, value=1), with value(); call this
    before I2C takes the pins. Takes less than 30 ms.
    """
    clock = clock or system_clock
    sda.value(1)
    scl.value(1)
    for _ in range(_CLOCKS):
        if sda.value():
            break
        scl.value(0)
        clock.sleep_ms(1)
        scl.value(1)
        clock.sleep_ms(1)
    _stop(scl, sda, clock)
    return bool(sda.value() and scl.value())


def _stop(scl, sda, clock):
    scl.value(0)
    clock.sleep_ms(1)
    sda.value(0)
    clock.sleep_ms(1)
    scl.value(1)
    clock.sleep_ms(1)
    sda.value(1)
    clock.sleep_ms(1)
