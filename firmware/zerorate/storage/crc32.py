"""CRC-32 of ISO-HDLC (zip, Ethernet), from the interpreter or in plain code where it has none."""

try:
    from binascii import crc32
except ImportError:
    crc32 = None  # type: ignore[assignment]


def checksum(data, out):
    """Carry the CRC-32 in out[0:4], little-endian, on over data; four zeros begin it."""
    if crc32 is None:
        from .plain_crc32 import plain_crc32

        plain_crc32(bytes(data), out)
        return
    crc = crc32(data, out[0] | out[1] << 8 | out[2] << 16 | out[3] << 24)
    for i in range(4):
        out[i] = crc & 0xFF
        crc >>= 8
