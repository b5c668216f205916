"""FakeI2C seen as smbus or smbus2, for drivers written for Linux."""

try:
    from threading import RLock
except ImportError:  # MicroPython, whose programs open no bus of Linux
    RLock = None  # type: ignore[assignment, misc]

TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import Any

    from .bus import FakeI2C

_I2C_M_RD = 1
I2C_FUNC_I2C = 0x00000001
I2C_FUNC_SMBUS_BLOCKS = 0x0C000000
_BLOCK_MAX = 32
# what the kernel says where MicroPython says EIO and ENODEV
_ERRORS = {
    5: (121, "Remote I/O error"),
    19: (6, "No such device or address"),
    110: (110, "Connection timed out"),
}


class SMBus:
    """The methods of smbus2.SMBus over a FakeI2C, with Linux's errors (121, 6, 110).

    raw_i2c False is an adapter without I2C_RDWR, as i2c-stub is: only block reads of 32 bytes.
    """

    def __init__(self, bus: "FakeI2C", raw_i2c: bool = True) -> None:
        self.bus = bus
        self.funcs = I2C_FUNC_SMBUS_BLOCKS | (I2C_FUNC_I2C if raw_i2c else 0)
        self.pec = 0
        # as the kernel has it: no thread's transfer comes between another's register and bytes
        self._transfer = RLock() if RLock else self

    def __enter__(self) -> "SMBus":
        return self

    def __exit__(self, *error: "Any") -> None:
        self.close()

    def open(self, bus: "int | str") -> None:
        """The bus is open."""

    def close(self) -> None:
        """Nothing to close."""

    def enable_pec(self, enable: bool = True) -> None:
        """Kept in pec and otherwise ignored: the chips know no packet error code."""
        self.pec = int(enable)

    def write_quick(self, i2c_addr: int, force: "bool | None" = None) -> None:
        """Address the chip and nothing more."""
        self._write(i2c_addr, [])

    def read_byte(self, i2c_addr: int, force: "bool | None" = None) -> int:
        """One byte from the register that was written or read last."""
        data = bytearray(1)
        self._read_on(i2c_addr, data)
        return data[0]

    def write_byte(self, i2c_addr: int, value: int, force: "bool | None" = None) -> None:
        """Set the register that read_byte reads."""
        self._write(i2c_addr, [value])

    def read_byte_data(self, i2c_addr: int, register: int, force: "bool | None" = None) -> int:
        """One register."""
        return self._read(i2c_addr, register, 1)[0]

    def write_byte_data(
        self, i2c_addr: int, register: int, value: int, force: "bool | None" = None
    ) -> None:
        """One register."""
        self._write(i2c_addr, [register, value])

    def read_word_data(self, i2c_addr: int, register: int, force: "bool | None" = None) -> int:
        """Two registers, low byte first."""
        low, high = self._read(i2c_addr, register, 2)
        return low | high << 8

    def write_word_data(
        self, i2c_addr: int, register: int, value: int, force: "bool | None" = None
    ) -> None:
        """Two registers, low byte first."""
        self._write(i2c_addr, [register, value & 0xFF, value >> 8 & 0xFF])

    def process_call(
        self, i2c_addr: int, register: int, value: int, force: "bool | None" = None
    ) -> int:
        """write_word_data, then read_word_data."""
        self.write_word_data(i2c_addr, register, value)
        return self.read_word_data(i2c_addr, register)

    def read_block_data(
        self, i2c_addr: int, register: int, force: "bool | None" = None
    ) -> "list[int]":
        """As many bytes as the first byte says, which these chips mean otherwise."""
        length = self._read(i2c_addr, register, 1)[0]
        if not 1 <= length <= _BLOCK_MAX:
            raise OSError(71, "Protocol error")
        return list(self._read(i2c_addr, register, 1 + length)[1:])

    def write_block_data(
        self, i2c_addr: int, register: int, data: "Sequence[int]", force: "bool | None" = None
    ) -> None:
        """The number of bytes, which these chips take for a value, then the bytes."""
        self._write(i2c_addr, [register, len(data), *data])

    def block_process_call(
        self, i2c_addr: int, register: int, data: "Sequence[int]", force: "bool | None" = None
    ) -> "list[int]":
        """write_block_data, then read_block_data."""
        self.write_block_data(i2c_addr, register, data)
        return self.read_block_data(i2c_addr, register)

    def read_i2c_block_data(
        self, i2c_addr: int, register: int, length: int, force: "bool | None" = None
    ) -> "list[int]":
        """List of length bytes, 32 at most."""
        if length > _BLOCK_MAX:
            raise ValueError(f"Desired block length over {_BLOCK_MAX} bytes")
        return list(self._read(i2c_addr, register, length))

    def write_i2c_block_data(
        self, i2c_addr: int, register: int, data: "Sequence[int]", force: "bool | None" = None
    ) -> None:
        """Registers from register on, 32 at most."""
        if len(data) > _BLOCK_MAX:
            raise ValueError(f"Data length cannot exceed {_BLOCK_MAX} bytes")
        self._write(i2c_addr, [register, *data])

    def i2c_rdwr(self, *i2c_msgs: "Any") -> None:
        """smbus2.i2c_msg objects, reads and writes in their order."""
        if not self.funcs & I2C_FUNC_I2C:
            raise OSError(95, "Operation not supported")
        with self._transfer:
            for message in i2c_msgs:
                if not message.flags & _I2C_M_RD:
                    self._write(message.addr, bytes(list(message)))
                    continue
                data = bytearray(message.len)
                self._read_on(message.addr, data)
                for i in range(message.len):
                    message.buf[i] = bytes(data[i : i + 1])

    def _read_on(self, addr: int, data: bytearray) -> None:
        """Fill data from the register that was written or read last."""
        self._transferred(self.bus.readfrom_into, addr, data)

    def _read(self, addr: int, register: int, length: int) -> bytes:
        return self._transferred(self.bus.readfrom_mem, addr, register, length)

    def _write(self, addr: int, data: "Sequence[int]") -> None:
        self._transferred(self.bus.writeto, addr, bytes(data))

    def _transferred(self, transfer: "Callable[..., Any]", *words: "Any") -> "Any":
        """What a transfer of the bus gives; its errors are Linux's."""
        try:
            with self._transfer:
                return transfer(*words)
        except OSError as error:
            number = error.args[0]
            raise OSError(*_ERRORS.get(number, (number, "I2C error"))) from None
