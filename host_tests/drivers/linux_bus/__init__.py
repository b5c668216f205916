"""A Linux machine with an I2C bus, without hardware: Debian's kernel under QEMU with i2c-stub."""
