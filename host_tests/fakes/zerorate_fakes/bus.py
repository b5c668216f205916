"""An I2C bus of fake chips, with the methods of machine.I2C and a bus's faults, and its clock."""

TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import Any

    from _typeshed import ReadableBuffer

    from .device import FakeMPU6050

_EIO = 5
_ENODEV = 19
_ETIMEDOUT = 110
_HANG_US = 1000000

FAULTS = ("nack", "gone", "hang", "all_ff", "all_00")


class FakeClock:
    """Time in microseconds from start_us; devices are told of every microsecond that passes.

    FakeClock() alone moves no chip: then only FakeMPU6050.step() makes samples.
    """

    def __init__(self, *devices: "FakeMPU6050", start_us: int = 0) -> None:
        self.devices = list(devices)
        self.now_us = start_us

    def advance_us(self, us: int) -> None:
        """Let us microseconds pass."""
        self.now_us += us
        for device in self.devices:
            device.advance_us(us)

    def ticks_us(self) -> int:
        """Now, as time.ticks_us of MicroPython."""
        return self.now_us

    def ticks_diff(self, end: int, start: int) -> int:
        """Microseconds from start to end."""
        return end - start

    def ticks_add(self, ticks: int, delta: int) -> int:
        """The time delta microseconds after ticks."""
        return ticks + delta

    def sleep_ms(self, milliseconds: float) -> None:
        """Let time pass at once."""
        self.advance_us(int(1000 * milliseconds))


class FakeI2C:
    """devices is one chip (at 0x68) or {address: chip}; a missing address is OSError 19.

    A chip has begin_read(), read(register), write(register, byte) and next_register(register).

    With clock every transfer takes the time it has at hz on a real bus. between_bytes, where set,
    is called after each byte read, with its place in the transfer.
    """

    def __init__(
        self,
        devices: "FakeMPU6050 | dict[int, Any]",
        clock: "FakeClock | None" = None,
        hz: int = 400000,
    ) -> None:
        self.devices: "dict[int, Any]" = devices if isinstance(devices, dict) else {0x68: devices}
        self.transfers = 0
        self.between_bytes: "Callable[[int], object] | None" = None
        self.sda_held_bits = 0
        self._clock = clock
        self._hz = hz
        self._pointer: "dict[int, int]" = {}
        self._fault: "str | None" = None
        self._times: "int | None" = 0
        self._skip = 0
        self._at_byte = 0

    def fault(self, kind: str, times: "int | None" = 1, skip: int = 0, at_byte: int = 7) -> None:
        """From the transfer after skip more, times transfers go wrong (None: all of them).

        "nack": no acknowledge; "gone": the bus is lost at_byte bytes into a read; "hang": OSError
        110 after a second; "all_ff" and "all_00": reads give only that byte and writes are lost.
        """
        if kind not in FAULTS:
            raise ValueError(f"no fault is called {kind}; known: {FAULTS}")
        self._fault = kind
        self._times = times
        self._skip = skip
        self._at_byte = at_byte

    def hold_sda(self, bits: int = 9) -> None:
        """A chip reset in the middle of a read holds SDA low for bits more clocks."""
        self.sda_held_bits = bits

    def mend(self) -> None:
        """End the fault."""
        self._fault = None

    def init(self, **options: "Any") -> None:
        """Pins and frequency make no difference here."""

    def deinit(self) -> None:
        """Nothing to let go."""

    def scan(self) -> "list[int]":
        """Addresses that acknowledge."""
        found = []
        for addr in sorted(self.devices):
            try:
                self.writeto(addr, b"")
                found.append(addr)
            except OSError:
                pass
        return found

    def writeto(self, addr: int, buf: "ReadableBuffer", stop: bool = True) -> int:
        """The first byte is the register, the rest is written from there on; bytes acknowledged."""
        data = bytes(buf)
        fault = self._begin(len(data) + 1)
        if fault not in ("all_ff", "all_00"):
            self._write(addr, data, fault)
        return len(data)

    def writevto(self, addr: int, vector: "Sequence[ReadableBuffer]", stop: bool = True) -> int:
        """writeto of the pieces one after the other."""
        return self.writeto(addr, b"".join([bytes(piece) for piece in vector]), stop)

    def readfrom_into(self, addr: int, buf: "bytearray | memoryview", stop: bool = True) -> None:
        """Fill buf from the register that was written or read last."""
        self._read(addr, buf, self._begin(len(buf) + 1))

    def readfrom(self, addr: int, nbytes: int, stop: bool = True) -> bytes:
        """nbytes from the register that was written or read last."""
        data = bytearray(nbytes)
        self.readfrom_into(addr, data, stop)
        return bytes(data)

    def readfrom_mem_into(
        self, addr: int, memaddr: int, buf: "bytearray | memoryview", *, addrsize: int = 8
    ) -> None:
        """Fill buf from the chip at addr, from register memaddr on."""
        fault = self._begin(len(buf) + 3)
        self._pointer[addr] = memaddr
        self._read(addr, buf, fault)

    def readfrom_mem(self, addr: int, memaddr: int, nbytes: int, *, addrsize: int = 8) -> bytes:
        """nbytes of the chip at addr, from register memaddr on."""
        data = bytearray(nbytes)
        self.readfrom_mem_into(addr, memaddr, data)
        return bytes(data)

    def writeto_mem(
        self, addr: int, memaddr: int, buf: "ReadableBuffer", *, addrsize: int = 8
    ) -> None:
        """Write buf to the chip at addr, from register memaddr on."""
        self.writeto(addr, bytes([memaddr]) + bytes(buf))

    def _read(self, addr: int, buf: "bytearray | memoryview", fault: "str | None") -> None:
        if fault in ("all_ff", "all_00"):
            for i in range(len(buf)):
                buf[i] = 0xFF if fault == "all_ff" else 0
            return
        device = self._device(addr)
        device.begin_read()
        for i in range(len(buf)):
            if fault == "gone" and i == self._at_byte:
                raise OSError(_EIO, "EIO")
            register = self._pointer.get(addr, 0)
            buf[i] = device.read(register)
            self._pointer[addr] = device.next_register(register)
            if self.between_bytes:
                self.between_bytes(i)
        if fault == "gone":
            raise OSError(_EIO, "EIO")

    def _write(self, addr: int, data: bytes, fault: "str | None") -> None:
        if fault == "gone":
            raise OSError(_EIO, "EIO")
        device = self._device(addr)
        if data:
            self._pointer[addr] = data[0]
        for byte in data[1:]:
            device.write(self._pointer[addr], byte)
            self._pointer[addr] = device.next_register(self._pointer[addr])

    def _begin(self, wire_bytes: int) -> "str | None":
        self.transfers += 1
        if self._clock:
            self._clock.advance_us(wire_bytes * 9 * 1000000 // self._hz)
        if self.sda_held_bits > 0:
            raise OSError(_EIO, "EIO")
        fault = self._take_fault()
        if fault == "nack":
            raise OSError(_EIO, "EIO")
        if fault == "hang":
            if self._clock:
                self._clock.advance_us(_HANG_US)
            raise OSError(_ETIMEDOUT, "ETIMEDOUT")
        return fault

    def _take_fault(self) -> "str | None":
        if self._fault is None:
            return None
        if self._skip:
            self._skip -= 1
            return None
        if self._times is not None:
            if self._times == 0:
                self._fault = None
                return None
            self._times -= 1
        return self._fault

    def _device(self, addr: int) -> "Any":
        if addr not in self.devices:
            raise OSError(_ENODEV, "ENODEV")
        return self.devices[addr]
