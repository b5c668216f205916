"""An I2C bus of fake chips, with the two methods drivers need and every fault a bus has."""

_EIO = 5
_ENODEV = 19

FAULTS = ("nack", "gone", "all_ff", "all_00")


class FakeI2C:
    """devices is one chip (at 0x68) or {address: chip}; a missing address is OSError 19.

    With clock every transfer takes the time it has at hz on a real bus.
    """

    def __init__(self, devices, clock=None, hz=400000):
        self.devices = devices if isinstance(devices, dict) else {0x68: devices}
        self.transfers = 0
        self.between_bytes = None
        self.sda_held_bits = 0
        self._clock = clock
        self._hz = hz
        self._fault = None
        self._times = 0
        self._skip = 0
        self._at_byte = 0

    def fault(self, kind, times=1, skip=0, at_byte=7):
        """From the transfer after skip more, times transfers go wrong (None: all of them).

        "nack": no acknowledge; "gone": the bus is lost at_byte bytes into a read; "all_ff" and
        "all_00": reads give only that byte and writes are lost.
        """
        if kind not in FAULTS:
            raise ValueError(f"no fault is called {kind}; known: {FAULTS}")
        self._fault = kind
        self._times = times
        self._skip = skip
        self._at_byte = at_byte

    def hold_sda(self, bits=9):
        """A chip reset in the middle of a read holds SDA low for bits more clocks."""
        self.sda_held_bits = bits

    def mend(self):
        """End the fault."""
        self._fault = None

    def probe(self, addr):
        """Address a chip and nothing more; OSError when none answers."""
        self._begin(1)
        self._device(addr)

    def readfrom_mem_into(self, addr, memaddr, buf):
        """Fill buf from the chip at addr, from register memaddr on."""
        fault = self._begin(len(buf) + 3)
        if fault in ("all_ff", "all_00"):
            for i in range(len(buf)):
                buf[i] = 0xFF if fault == "all_ff" else 0
            return
        device = self._device(addr)
        device.begin_read()
        for i in range(len(buf)):
            if fault == "gone" and i == self._at_byte:
                raise OSError(_EIO)
            buf[i] = device.read(memaddr)
            memaddr = device.next_register(memaddr)
            if self.between_bytes:
                self.between_bytes(i)
        if fault == "gone":
            raise OSError(_EIO)

    def writeto_mem(self, addr, memaddr, buf):
        """Write buf to the chip at addr, from register memaddr on."""
        fault = self._begin(len(buf) + 2)
        if fault in ("all_ff", "all_00"):
            return
        if fault == "gone":
            raise OSError(_EIO)
        device = self._device(addr)
        for byte in buf:
            device.write(memaddr, byte)
            memaddr = device.next_register(memaddr)

    def _begin(self, wire_bytes):
        self.transfers += 1
        if self._clock:
            self._clock.advance_us(wire_bytes * 9 * 1000000 // self._hz)
        if self.sda_held_bits > 0:
            raise OSError(_EIO)
        fault = self._take_fault()
        if fault == "nack":
            raise OSError(_EIO)
        return fault

    def _take_fault(self):
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

    def _device(self, addr):
        if addr not in self.devices:
            raise OSError(_ENODEV)
        return self.devices[addr]
