"""Which part answers at an address, and what to say when none or another one does."""

from .parts import part_by_id, part_by_name

const = int  # on a board the compiler itself reads const(...)

_WHO_AM_I = const(0x75)
_EBUSY = const(16)
_ENODEV = const(19)


def identify(registers, name):
    """(WHO_AM_I, row of parts.PARTS) of the device at registers, a Registers.

    name (or None) overrides what the id says. Raises OSError with the address and the id read,
    and what to do, where nothing answers or no part is known; ValueError for an unknown name.
    """
    try:
        who_am_i = registers.read_register(_WHO_AM_I)
    except OSError as error:
        if error.args[0] == _EBUSY:  # Linux, of one that another has
            raise
        text = "nothing answers at I2C address 0x{:02x}, no id was read: check power, wiring, AD0{}"
        raise OSError(error.args[0], text.format(registers.address, scanned(registers.i2c)))
    row = part_by_id(who_am_i) if name is None else part_by_name(name)
    if who_am_i in (0x00, 0xFF):
        raise wrong_device(registers, who_am_i, "a dead bus: check pull-ups and wiring")
    if row is None:
        advice = "no part known: if you know which one it is, name it, as in part='MPU-6500'"
        raise wrong_device(registers, who_am_i, advice)
    return who_am_i, row


def scanned(i2c):
    """What else answers on the bus, to be added to a sentence; "" of a bus that cannot look."""
    try:
        seen = ["0x%02x" % address for address in i2c.scan()]
    except (AttributeError, OSError):
        return ""
    return "; a scan of the bus sees " + (", ".join(seen) or "nothing at all")


def wrong_device(registers, who_am_i, rest):
    """The OSError that names address, id and part, and says rest."""
    row = part_by_id(who_am_i)
    name = f" ({row[1]})" if row else ""
    text = "I2C address 0x{:02x} answers with WHO_AM_I 0x{:02x}{}: {}"
    return OSError(_ENODEV, text.format(registers.address, who_am_i, name, rest))
