"""Cycles of straight Thumb code on a Cortex-M0+ without wait states (ARM DDI 0484C, table 3-1)."""

import struct


def cycles_of(code: bytes) -> tuple[int, int, int]:
    """(instructions, cycles, further cycles when the last one's condition holds) of a block."""
    count = cycles = at = further = 0
    while at < len(code):
        (word,) = struct.unpack_from("<H", code, at)
        further = int(word >> 12 == 0b1101)
        cycles += _cycles(word)
        count += 1
        at += 4 if word >> 11 in (0b11101, 0b11110, 0b11111) else 2
    return count, cycles, further


def _cycles(word: int) -> int:
    registers = (word & 0xFF).bit_count()
    if word >> 12 in (5, 6, 7, 8, 9) or word >> 11 == 9:  # a load or a store
        return 2
    if word >> 9 == 0b1011010:  # push
        return 1 + registers + (word >> 8 & 1)
    if word >> 9 == 0b1011110:  # pop; with pc it jumps
        return 1 + registers + 3 * (word >> 8 & 1)
    if word >> 12 == 0b1100:  # several loads or stores
        return 1 + registers
    if word >> 11 == 0b11110:  # bl
        return 3
    if word >> 11 == 0b11100 or word >> 8 == 0x47:  # b, bx
        return 2
    return 1
