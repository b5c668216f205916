"""What the firmware's integer arithmetic gives for numbers of all sizes: checksums."""

import zlib

import numpy as np
from zerorate.arithmetic import atan2, fixed, real

_TIMES = 1500
# function -> the bits of each number that it takes, negative where its sign is free
_OF_NUMBERS = {
    fixed.scaled: (-28, -28, range(15, 31)),
    fixed.fraction_q27: (19, 19),
    fixed.ratio_q26: (-28, 28),
    fixed.room: (-30,),
    fixed.floating_ratio_q26: (-30, -30, range(-40, 40)),
    fixed.clipped: (-29, 9),
    fixed.root: (30,),
    atan2.arc_q13: (16,),
    atan2.atan2_q13: (-30, -30),
    real.high_product: (-28, -28),
    real.quotient_q27: (28, 28),
}
_OF_WORDS = (real.multiply, real.add, real.subtract, real.divide, real.root_of, real.pack)


def _numbers(rng, bits):
    """Numbers of any size below 2^bits, every other one beside a power of two."""
    if isinstance(bits, range):
        return rng.choice(bits, _TIMES).tolist()
    powers = 1 << rng.integers(0, abs(bits), _TIMES)
    near = powers + rng.integers(-1, 2, _TIMES)
    any_size = rng.integers(0, 1 << 30, _TIMES) >> rng.integers(30 - abs(bits), 31, _TIMES)
    found = np.where(rng.random(_TIMES) < 0.5, near, any_size)
    return (found * rng.choice([-1, 1], _TIMES) if bits < 0 else found).tolist()


def _words(rng):
    """What each function of numbers in two words leaves of two of them."""
    parts = zip(
        _numbers(rng, -30), _numbers(rng, -30), *(_numbers(rng, range(-60, 60)) for _ in "mn")
    )
    for m, n, e, f in parts:
        s = [0] * 12
        real.put(s, 0, m, e)
        real.put(s, 2, n, f)
        for function in _OF_WORDS:
            s[0] = abs(s[0]) if function is real.root_of else s[0]
            function(s, 4, 0, *(2,) * (function.__code__.co_argcount - 3))
            yield s[4:6]
        real.unpack(s, 6, 4)
        real.copy(s, 9, 6, 3)
        yield [*s, real.whole(s, 2, f // 2)]


def arithmetic():
    """{function: checksum of what it returns}."""
    rng, found = np.random.default_rng(8), {}
    for function, sizes in _OF_NUMBERS.items():
        given = [_numbers(rng, bits) for bits in sizes]
        if function in (fixed.fraction_q27, real.quotient_q27):  # of a part, or of less than twice
            given = [[a % (b + 1) for a, b in zip(*given)], [b + 1 for b in given[1]]]
        found[function.__name__] = [function(*of) for of in zip(*given)]
    found["words"] = list(_words(rng))
    return {name: [f"{zlib.crc32(repr(of).encode()):x}"] for name, of in found.items()}
