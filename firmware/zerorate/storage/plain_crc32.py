"""CRC-32 where the interpreter has none."""

# CRC of each nibble in big-endian words, its halves apart: 32 bits are no small int on most boards.
_UPPER = (
    b"\x00\x00\x1d\xb7\x3b\x6e\x26\xd9\x76\xdc\x6b\x6b\x4d\xb2\x50\x05"
    b"\xed\xb8\xf0\x0f\xd6\xd6\xcb\x61\x9b\x64\x86\xd3\xa0\x0a\xbd\xbd"
)
_LOWER = (
    b"\x00\x00\x10\x64\x20\xc8\x30\xac\x41\x90\x51\xf4\x61\x58\x71\x3c"
    b"\x83\x20\x93\x44\xa3\xe8\xb3\x8c\xc2\xb0\xd2\xd4\xe2\x78\xf2\x1c"
)


def plain_crc32(data, out):
    """As crc32.checksum, of bytes; no number exceeds 16 bits."""
    lower = (out[0] | out[1] << 8) ^ 0xFFFF
    upper = (out[2] | out[3] << 8) ^ 0xFFFF
    for byte in data:
        lower ^= byte
        for _ in range(2):
            at = 2 * (lower & 15)
            lower = (lower >> 4 | (upper & 15) << 12) ^ (_LOWER[at] << 8 | _LOWER[at + 1])
            upper = upper >> 4 ^ (_UPPER[at] << 8 | _UPPER[at + 1])
    upper ^= 0xFFFF
    lower ^= 0xFFFF
    out[0] = lower & 0xFF
    out[1] = lower >> 8
    out[2] = upper & 0xFF
    out[3] = upper >> 8
