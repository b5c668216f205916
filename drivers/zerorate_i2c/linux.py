"""An I2C bus of a Linux board, through smbus2, with the two methods the driver needs."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_I2C_FUNC_I2C = 0x00000001
_BLOCK_MAX = 32
_I2C_SLAVE = 0x0703
_EAGAIN, _EBUSY = 11, 16


class LinuxI2C:
    """Bus number, device path ("/dev/i2c-1") or an open smbus2.SMBus.

    Reads go by I2C_RDWR (a repeated start, any length). Where the adapter lacks it they go by SMBus
    block reads, and then max_burst is 32: a longer one raises ValueError, as it could not be one
    transfer. max_burst is 0 where there is no limit. OSError of the kernel passes through. While a
    program has a chip another one gets OSError 16 for it: each would have half of the FIFO.
    """

    def __init__(self, bus: "Any") -> None:
        from smbus2 import SMBus, i2c_msg

        self._message = i2c_msg
        self._owned = isinstance(bus, (int, str))
        self._bus = SMBus(None) if self._owned else bus
        if self._owned:
            try:
                self._bus.open(bus)
            except OSError:  # what is open but no I2C bus: smbus2 leaves its descriptor open
                self._bus.close()
                raise
        self._claimed: "set[int]" = set()
        self._raw = bool(int(self._bus.funcs) & _I2C_FUNC_I2C)
        self.max_burst = 0 if self._raw else _BLOCK_MAX

    def readfrom_mem_into(self, addr: int, memaddr: int, buf: "bytearray | memoryview") -> None:
        """Fill buf from the chip at addr, from register memaddr on."""
        self._claim(addr)
        if self._raw:
            read = self._message.read(addr, len(buf))
            self._bus.i2c_rdwr(self._message.write(addr, [memaddr]), read)
            buf[:] = bytes(read)
        elif len(buf) > _BLOCK_MAX:
            raise ValueError(f"this adapter reads {_BLOCK_MAX} bytes at most at once")
        else:
            buf[:] = bytes(self._bus.read_i2c_block_data(addr, memaddr, len(buf)))

    def writeto_mem(self, addr: int, memaddr: int, buf: "bytes | bytearray") -> None:
        """Write buf to the chip at addr, from register memaddr on."""
        self._claim(addr)
        if self._raw:
            self._bus.i2c_rdwr(self._message.write(addr, bytes([memaddr]) + bytes(buf)))
        else:
            self._bus.write_i2c_block_data(addr, memaddr, list(buf))

    def _claim(self, addr):
        """Lock the byte of the bus's file that has the chip's number; a fake has no file."""
        fd = getattr(self._bus, "fd", None)
        if fd is None or addr in self._claimed:
            return
        from fcntl import LOCK_EX, LOCK_NB, ioctl, lockf

        try:
            ioctl(fd, _I2C_SLAVE, addr)  # EBUSY where a driver of the kernel has it
            lockf(fd, LOCK_EX | LOCK_NB, 1, addr)
        except OSError as error:
            if error.errno not in (_EAGAIN, _EBUSY):
                raise
            text = "another program, or a driver of the kernel, has the chip at 0x{:02x}"
            raise OSError(_EBUSY, text.format(addr)) from None
        self._claimed.add(addr)

    def close(self) -> None:
        """Close the bus when this object opened it."""
        if self._owned:
            self._bus.close()
