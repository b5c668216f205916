"""FakeI2C seen as CircuitPython's busio.I2C, for drivers written for that."""


class CircuitPythonI2C:
    """The methods of busio.I2C over a FakeI2C: lock, raw writes and reads by register pointer."""

    def __init__(self, bus):
        self._bus = bus
        self._locked = False
        self._pointer = {}

    def try_lock(self):
        """Take the bus; False when it is taken."""
        if self._locked:
            return False
        self._locked = True
        return True

    def unlock(self):
        """Give the bus back."""
        self._locked = False

    def writeto(self, address, buffer, *, start=0, end=None):
        """First byte sets the register pointer, the rest is written from there on."""
        data = bytes(buffer)[start:end]
        if not data:
            self._bus.probe(address)
            return
        self._pointer[address] = data[0]
        if len(data) > 1:
            self._bus.writeto_mem(address, data[0], data[1:])

    def readfrom_into(self, address, buffer, *, start=0, end=None):
        """Fill buffer[start:end] from the register pointer on."""
        view = memoryview(buffer)[start:end]
        self._bus.readfrom_mem_into(address, self._pointer.get(address, 0), view)

    def writeto_then_readfrom(
        self, address, out_buffer, in_buffer, *, out_start=0, out_end=None, in_start=0, in_end=None
    ):
        """Write, repeated start, read."""
        self.writeto(address, out_buffer, start=out_start, end=out_end)
        self.readfrom_into(address, in_buffer, start=in_start, end=in_end)
