"""CRC-32 of ISO-HDLC (zip, Ethernet), from the interpreter or in plain code where it has none."""

try:
    from binascii import crc32
except ImportError:
    crc32 = None  # type: ignore[assignment]


def checksum(data, length, out):
    """Put the CRC-32 of data[:length] into out[0:4], little-endian."""
    if crc32 is None:
        from .plain_crc32 import plain_crc32

        plain_crc32(data, length, out)
        return
    crc = crc32(memoryview(data)[:length])
    for i in range(4):
        out[i] = crc & 0xFF
        crc >>= 8
