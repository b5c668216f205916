"""Freezes the driver into a MicroPython build: include() this from the board's manifest."""

metadata(version="0.1.0", description="MPU-6050 family over any I2C bus")  # noqa: F821
package(  # noqa: F821
    "zerorate_i2c",
    files=(
        "__init__.py",
        "bus_recovery.py",
        "clock.py",
        "data_ready.py",
        "fifo.py",
        "identity.py",
        "mpu6050.py",
        "parts.py",
        "registers.py",
        "self_test.py",
        "settings.py",
    ),
)
