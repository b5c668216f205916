# Generated from zerorate/effects.py by `make viper`: edit that file, not this one.
"""What the closed loop has found, subtracted: slots of coefficient times basis (design.md).

Slots are computed once a tick (1 s) on the means of the tick, one slot a sample, so that no sample
waits for all of them; what depends on the rate itself is computed for every sample. One array `e`
holds the model and its running state: see model.py for its words.
"""

import micropython


try:
    from micropython import const
except ImportError:

    def const(value):
        return value


from .effect_basis import basis, contribute
from .effect_inputs import accumulate, close_tick, tell_time

_SLOTS = const(0)
_TICK_US = const(2)
_ELAPSED_US = const(3)
_PENDING = const(4)
_PHASE = const(5)
_PIECES = const(6)
_HALF_TICKS = const(7)
_RUNNING = const(8)
_INSTANT_SLOTS = const(9)
_SUM_Q14 = const(10)
_HELD_Q14 = const(13)
_NOW_Q14 = const(16)

_SLOT = const(112)
_WORDS = const(40)
_INSTANT = const(33)
_VALUE = const(39)

_EFFECT_Q8 = const(61)
_MOST_PENDING = const(4096)
_MOST_TICKS = const(0x1FFFF000)


@micropython.viper
def pass_time(e_, dt_us: int):
    """Let dt_us go by; where ticks end, take their means and ask for their slots.

    The first sample of a power-on is the beginning of the first tick.
    """
    e = ptr32(e_)
    if e[_RUNNING] == 0:
        e[_RUNNING] = 1
        return
    if dt_us <= 0:
        return
    dt_us += e[_ELAPSED_US]
    if dt_us < e[_TICK_US]:
        e[_ELAPSED_US] = dt_us
        return
    e[_ELAPSED_US] = dt_us % e[_TICK_US]
    dt_us = e[_PENDING] + dt_us // e[_TICK_US]
    if dt_us > _MOST_PENDING:
        e[_HALF_TICKS] += (dt_us - _MOST_PENDING) << 1
        dt_us = _MOST_PENDING
    e[_PENDING] = dt_us
    close_tick(e_)


@micropython.viper
def run_slot(e_):
    """Compute the next slot of the tick; behind the last one hold the sum until the next tick."""
    e = ptr32(e_)
    i = e[_PHASE]
    if i == 0:
        tell_time(e_)
        if e[_HALF_TICKS] < _MOST_TICKS:
            e[_HALF_TICKS] += 2
        e[_SUM_Q14] = 0
        e[_SUM_Q14 + 1] = 0
        e[_SUM_Q14 + 2] = 0
    a = _SLOT + i * _WORDS
    if e[a + _INSTANT] == 0:
        e[a + _VALUE] = int(basis(e_, a))
        contribute(e_, a, _SUM_Q14)
    i += 1
    if i == e[_SLOTS]:
        i = 0
        e[_PENDING] -= 1
        e[_HELD_Q14] = e[_SUM_Q14]
        e[_HELD_Q14 + 1] = e[_SUM_Q14 + 1]
        e[_HELD_Q14 + 2] = e[_SUM_Q14 + 2]
    e[_PHASE] = i


@micropython.viper
def add_instant(e_):
    """Add to what is held what the slots of this very sample say."""
    e = ptr32(e_)
    a = _SLOT
    i = e[_SLOTS]
    while i > 0:
        if e[a + _INSTANT]:
            e[a + _VALUE] = int(basis(e_, a))
            contribute(e_, a, _NOW_Q14)
        a += _WORDS
        i -= 1


@micropython.viper
def sense(s: ptr32, e_, x_, dt_us: int, good: int):
    """Take the frame x, dt_us after the one before, and leave the effects' sum, LSB Q8, in s.

    good: 0 for a frame that is no reading, of which only the time counts. Call it before the
    frame is gathered and corrected; do not call it where e[0], the number of slots, is 0.
    """
    e = ptr32(e_)
    pass_time(e_, dt_us)
    if good:
        accumulate(e_, x_)
    dt_us = e[_PIECES]
    while dt_us > 0 and e[_PENDING] > 0:
        run_slot(e_)
        dt_us -= 1
    e[_NOW_Q14] = e[_HELD_Q14]
    e[_NOW_Q14 + 1] = e[_HELD_Q14 + 1]
    e[_NOW_Q14 + 2] = e[_HELD_Q14 + 2]
    if e[_INSTANT_SLOTS] and good:
        add_instant(e_)
    dt_us = 0
    while dt_us < 3:
        s[_EFFECT_Q8 + dt_us] = (e[_NOW_Q14 + dt_us] + 32) >> 6
        dt_us += 1
