"""How far a viper function's jumps reach: MicroPython's own compilers encode far ones wrongly.

Up to 1.25 one of more than 2 KB is refused for ARMv6-M, so that the import fails, and encoded
wrongly for Xtensa, as is a conditional one of more than 4 KB for Thumb-2: the function runs into
the void. Later compilers say a far jump in more instructions.
"""

from __future__ import annotations

from collections.abc import Iterator

from .mpy import compiled

# bytes that a jump reaches on each of them: a signed field of 12 bits, counted from behind it
REACH = 2044
_OTHERS = ("armv6m", "xtensawin")


def longest_jumps(text: str) -> list[int]:
    """Bytes of the longest jump of each viper function of a program, in its order.

    Jumps are read from ARMv7-M code, where one is always one instruction, and taken to grow as
    the function does where its code is longer. Raises ZerorateError when it does not compile.
    """
    codes = compiled(text, "armv7m")
    lengths = zip(*([len(code) for code in compiled(text, other)] for other in _OTHERS))
    return [_longest(code) * max(longer) // len(code) for code, longer in zip(codes, lengths)]


def _longest(code: bytes) -> int:
    return max(map(abs, thumb_jumps(code)), default=0)


def thumb_jumps(code: bytes) -> Iterator[int]:
    """How far each jump of Thumb-2 code goes, bytes; a call, by a register, is none."""
    at = 0
    while at + 2 <= len(code):
        first = int.from_bytes(code[at : at + 2], "little")
        wide = first >> 11 in (0b11101, 0b11110, 0b11111)
        second = int.from_bytes(code[at + 2 : at + 4], "little")
        by = _wide(first, second) if wide else _narrow(first)
        if by is not None:
            yield by
        at += 4 if wide else 2


def _narrow(word: int) -> int | None:
    if word >> 11 == 0b11100:
        return _signed(word, 11) * 2
    if word >> 12 == 0b1101 and (word >> 8) & 15 < 14:
        return _signed(word, 8) * 2
    return None


def _wide(first: int, second: int) -> int | None:
    if first >> 11 != 0b11110 or second >> 14 != 0b10:
        return None
    sign, j1, j2 = first >> 10 & 1, second >> 13 & 1, second >> 11 & 1
    if second & 0x1000:  # not conditional
        high = sign << 2 | (j1 == sign) << 1 | (j2 == sign)
        return _signed(high << 21 | (first & 0x3FF) << 11 | second & 0x7FF, 24) * 2
    if (first >> 6) & 15 >= 14:
        return None
    high = sign << 2 | j2 << 1 | j1
    return _signed(high << 17 | (first & 0x3F) << 11 | second & 0x7FF, 20) * 2


def _signed(value: int, bits: int) -> int:
    value &= (1 << bits) - 1
    return value - (value >> (bits - 1) << bits)
