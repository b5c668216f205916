"""What the closed loop has found, subtracted: slots of coefficient times basis (design.md).

Slots are computed once a tick (1 s) on the means of the tick, one slot a sample, so that no sample
waits for all of them; what depends on the rate, the acceleration or a channel of the application
itself, which may move faster than a tick, is computed for every sample. One array `e` holds the
model and its running state: docs/layout.md has its words.
"""

from ..arithmetic.fixed import clipped
from .effect_basis import basis, contribute
from .effect_inputs import accumulate, close_tick, tell_time
from .effect_plays import play

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The corrector's state
_EFFECT_Q8 = const(75)
# layout: The effect model and its running state
_SENSED = const(0)
_SLOT_COUNT = const(7)
_TICK_US = const(9)
_TICK_ELAPSED_US = const(10)
_TICKS_DUE = const(11)
_NEXT_SLOT = const(12)
_SLOTS_A_SAMPLE = const(13)
_HALF_TICKS = const(14)
_RUNNING = const(15)
_INSTANT_SLOTS = const(16)
_SUM_Q14 = const(17)
_HELD_Q14 = const(20)
_NOW_Q14 = const(23)
_PLAY_COUNT = const(26)
_SENSED_CARRY_Q8 = const(36)
_SLOTS = const(119)
_PLAYS = const(909)
# layout: An effect slot
_SLOT_INSTANT = const(33)
_SLOT_STARTED = const(34)
_SLOT_VALUE = const(39)
_SLOT_WORDS = const(40)
# layout: A play operator
_PLAY_STARTED = const(13)
_PLAY_WORDS = const(15)
# layout: end
_MOST_PENDING = const(4096)
_MOST_TICKS = const(0x1FFFF000)
_MOST_READING = const(0x7FFF)


def pass_time(e: ptr32, dt_us: int):
    """Let dt_us go by; where ticks end, take their means and ask for their slots."""
    # The first sample of a power-on is the beginning of the first tick.
    if e[_RUNNING] == 0:
        e[_RUNNING] = 1
        return
    if dt_us <= 0:
        return
    elapsed_us = e[_TICK_ELAPSED_US] + dt_us
    if elapsed_us < e[_TICK_US]:
        e[_TICK_ELAPSED_US] = elapsed_us
        return
    e[_TICK_ELAPSED_US] = elapsed_us % e[_TICK_US]
    due = e[_TICKS_DUE] + elapsed_us // e[_TICK_US]
    if due > _MOST_PENDING:
        e[_HALF_TICKS] += (due - _MOST_PENDING) << 1
        due = _MOST_PENDING
    e[_TICKS_DUE] = due
    close_tick(e)


def begin_early(e: ptr32, x: ptr32):
    """Use the first reading of a power-on until the first tick ends."""
    # Else a rest within that tick would be learned with all that the model explains.
    e[_RUNNING] = 2
    e[_TICKS_DUE] += 1
    close_tick(e)
    accumulate(e, x)


def begin_again(e: ptr32):
    """Forget the early tick: time and memories begin with the first whole one."""
    e[_RUNNING] = 3
    e[_HALF_TICKS] = 1
    i = e[_SLOT_COUNT]
    while i > 0:
        i -= 1
        e[_SLOTS + i * _SLOT_WORDS + _SLOT_STARTED] = 0
    i = e[_PLAY_COUNT]
    while i > 0:
        i -= 1
        e[_PLAYS + i * _PLAY_WORDS + _PLAY_STARTED] = 0


def run_slot(e: ptr32):
    """Compute the tick's next slot or play operator; behind the last one hold the sum."""
    i = e[_NEXT_SLOT]
    if i == 0:
        tell_time(e)
        if e[_HALF_TICKS] < _MOST_TICKS:
            e[_HALF_TICKS] += 2
        for a in range(3):
            e[_SUM_Q14 + a] = 0
    if i < e[_SLOT_COUNT]:
        a = _SLOTS + i * _SLOT_WORDS
        if e[a + _SLOT_INSTANT] == 0:
            e[a + _SLOT_VALUE] = basis(e, a)
            contribute(e, a, _SUM_Q14)
    else:
        play(e, _PLAYS + (i - e[_SLOT_COUNT]) * _PLAY_WORDS)
    i += 1
    if i == e[_SLOT_COUNT] + e[_PLAY_COUNT]:
        i = 0
        e[_TICKS_DUE] -= 1
        if e[_RUNNING] == 2:
            begin_again(e)
        for a in range(3):
            e[_HELD_Q14 + a] = e[_SUM_Q14 + a]
    e[_NEXT_SLOT] = i


def add_instant(e: ptr32, good: int):
    """Add to what is held what the slots of this very sample say."""
    # In a frame that is no reading the rest is taken as it was; what the rate was says nothing.
    a = _SLOTS
    i = e[_SLOT_COUNT]
    while i > 0:
        if e[a + _SLOT_INSTANT] + good > 1:
            e[a + _SLOT_VALUE] = basis(e, a)
            contribute(e, a, _NOW_Q14)
        a += _SLOT_WORDS
        i -= 1


def lessen(s: ptr32, e: ptr32, x: ptr32):
    """Leave the frame x at _SENSED, its rates less the effects, for sources beside rests."""
    # A turn whose scale is off leaves an angle that looks like a bias.
    i = 0
    while i < 4:
        e[_SENSED + i] = x[i]
        i += 1
    while i < 7:
        d = (x[i] << 8) - s[_EFFECT_Q8 - 4 + i] + e[_SENSED_CARRY_Q8 - 4 + i]
        e[_SENSED + i] = clipped((d + 128) >> 8, _MOST_READING)
        e[_SENSED_CARRY_Q8 - 4 + i] = d - ((d + 128 >> 8) << 8)
        i += 1


def sense(s: ptr32, e: ptr32, x: ptr32, dt_us: int, good: int):
    """Take the frame x, dt_us after the one before, and leave the effects' sum, LSB Q8, in s."""
    # good: 0 for a frame that is no reading, of which only the time counts. Call it before the
    # frame is gathered and corrected; do not call it where there is neither slot nor play operator.
    # Where a sample is all that a tick has, it is corrected by what it reads itself: at one in 15 s
    # the temperature of the one before is a quarter of a degree off.
    if good and dt_us > e[_TICK_US] >> 1:
        accumulate(e, x)
        pass_time(e, dt_us)
    else:
        pass_time(e, dt_us)
        if good:
            accumulate(e, x)
    if good and e[_RUNNING] == 1:
        begin_early(e, x)
    left = e[_SLOTS_A_SAMPLE]
    while left > 0 and e[_TICKS_DUE] > 0:
        run_slot(e)
        left -= 1
    e[_NOW_Q14] = e[_HELD_Q14]
    e[_NOW_Q14 + 1] = e[_HELD_Q14 + 1]
    e[_NOW_Q14 + 2] = e[_HELD_Q14 + 2]
    if e[_INSTANT_SLOTS]:
        add_instant(e, good)
    i = 0
    while i < 3:
        s[_EFFECT_Q8 + i] = (e[_NOW_Q14 + i] + 32) >> 6
        i += 1
    if good:
        lessen(s, e, x)
