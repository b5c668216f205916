"""FakeI2C seen as smbus or smbus2, for drivers written for Linux."""

_I2C_M_RD = 1
_ENODEV = 19
I2C_FUNC_I2C = 0x00000001
I2C_FUNC_SMBUS_BLOCKS = 0x0C000000
_BLOCK_MAX = 32


class SMBus:
    """The methods of smbus2.SMBus over a FakeI2C.

    raw_i2c False is an adapter without I2C_RDWR, as i2c-stub is: only block reads of 32 bytes.
    """

    def __init__(self, bus, raw_i2c=True):
        self._bus = bus
        self.funcs = I2C_FUNC_SMBUS_BLOCKS | (I2C_FUNC_I2C if raw_i2c else 0)

    def close(self):
        """Nothing to close."""

    def read_byte_data(self, addr, register, force=None):
        """One register."""
        return self._read(addr, register, 1)[0]

    def read_word_data(self, addr, register, force=None):
        """Two registers, low byte first."""
        low, high = self._read(addr, register, 2)
        return low | high << 8

    def read_i2c_block_data(self, addr, register, length, force=None):
        """List of length bytes, 32 at most."""
        if length > _BLOCK_MAX:
            raise ValueError("a block read is of 32 bytes at most")
        return list(self._read(addr, register, length))

    def write_byte_data(self, addr, register, value, force=None):
        """One register."""
        self._bus.writeto_mem(addr, register, bytes([value]))

    def write_i2c_block_data(self, addr, register, data, force=None):
        """Registers from register on."""
        self._bus.writeto_mem(addr, register, bytes(data))

    def i2c_rdwr(self, *messages):
        """smbus2.i2c_msg objects: a write that sets the pointer, then perhaps a read."""
        if not self.funcs & I2C_FUNC_I2C:
            raise OSError(95, "Operation not supported")
        pointer = 0
        for message in messages:
            if message.flags & _I2C_M_RD:
                data = self._read(message.addr, pointer, message.len)
                for i in range(message.len):
                    message.buf[i] = data[i : i + 1]
            else:
                data = bytes(list(message))
                pointer = data[0]
                if len(data) > 1:
                    self._bus.writeto_mem(message.addr, pointer, data[1:])

    def _read(self, addr, register, length):
        data = bytearray(length)
        self._bus.readfrom_mem_into(addr, register, data)
        return data
