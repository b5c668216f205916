"""An MPU-6050 on the pins of a MicroPython board: the one place that says how it is wired."""

from machine import I2C, Pin

from .mpu6050 import MPU6050
from .registers import unload

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


def setup(
    scl: "Any", sda: "Any", bus: "int | None" = None, freq: int = 400000, **options: "Any"
) -> MPU6050:
    """An MPU6050 on the pins scl and sda, by number or name; options are MPU6050's.

    bus: number of the I2C peripheral (default: 0 or 1, whichever takes these pins, or software).
    SDA is freed first where a chip holds it low. Raises OSError and ValueError as MPU6050 does.
    """
    from .bus_recovery import free_bus  # once: its 1 KB of heap is free again behind it

    scl, sda = [Pin(pin, Pin.OPEN_DRAIN, value=1) for pin in (scl, sda)]
    free_bus(scl, sda)
    del free_bus
    unload("bus_recovery")
    for number in (0, 1, None) if bus is None else (bus,):
        try:
            if number is None:
                from machine import SoftI2C

                i2c = SoftI2C(scl=scl, sda=sda, freq=freq)
            else:
                i2c = I2C(number, scl=scl, sda=sda, freq=freq)  # type: ignore[assignment]
            break
        except (TypeError, ValueError):  # the pins are another one's, or may not be named
            if number == bus:
                raise
    unload("board")
    return MPU6050(i2c, **options)
