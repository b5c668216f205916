"""An effect model in the firmware: one array with its numbers and all that is running.

Words of `e`, array('i') of WORDS: 0 slots, 1 inputs, 2 tick_us, 3 elapsed_us, 4 ticks to compute, 5
slot to compute, 6 slots a sample, 7 half ticks since power-on, 8 runs (2 in the first tick, then
3), 9 slots of the sample itself, 10..12 sum and 13..15 held sum and 16..18 sum with the sample's
own, LSB Q14, 19 play operators, 20..25 vibration, 26 refinement is on and 27 its bound; at 32
inputs of 6: kind, shift, offset, sum, count, value Q8; at 104 channels, as the application gave
them; at 112 slots of 40; at 432 tables of 9; at 450 rings of 66: newest, ticks since it, 64 kept;
from 582 refinement: piece to do, states, three rates Q8, first temperature, segments seen, and from
590 reals: scratch, at 602 regressors, 622 gains, 642 states of the axes, 702 covariance; at 902
play operators of 15.
A slot: 0 input's value's word, 1 lowest, 2 highest, 3 centre, each Q8, 4 shift to Q24; 5 power,
6 power first, 7 memory (lag, difference, rate, backlash, peak: 1..5), 8 lag's mantissa, 9 its
shift, 10 half the backlash, 11 knot; 12..16 as 0..4 for the second source (12: 0 is none);
17 decay's mantissa and 18 shift; 19 table's word, 20 its first point, 21 mantissa and 22 shift to
its nine; 23 shift and 24..26 mantissas of the coefficients; 27 ring's word, 28 delay and 29 ticks a
kept one; 30..32 the model's own coefficients, 33 follows the sample's own rate (1) or acceleration
(2), 34 started, 35 memory's Q24 and 36 remainder, 37 decay's and 38, 39 value Q24.
A play operator: 0..4 as a slot's; 5 radius Q24; 6 shift of the coefficients, 7..9 mantissas of what
it is and 10..12 of its square; 13 started, 14 where it stands, Q24.
"""

from array import array

from .model_file import IMPOSSIBLE, LOADED, NO_MODEL, UNREADABLE, compare, fill, judge, texts

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .settings import Sensor

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


WORDS = 992

_CHANNELS = const(8)
_INPUT = const(32)
_CHANNEL = const(104)
_SLOT = const(112)
_TABLE = const(432)
_SLOT_WORDS = const(40)
_NONE = const(-0x3FFFFFFF)
_ONE = const(9)
_PLAYS = const(19)
_PLAY = const(902)
_PLAY_WORDS = const(15)


class EffectModel:
    """An effect model and its running state, in `e`; with no model loaded e[0] is 0.

    channels: names of the extra channels that the model follows, in the order of their index;
    attend: the kernel that refines coefficients, None while it is off.
    """

    def __init__(self) -> None:
        self.e = array("i", [0] * WORDS)
        self.channels = ()
        self.reason = NO_MODEL
        self.attend: "Any" = None

    def load_file(self, path: str, sensor: "Sensor", binding: "bytes | None" = None) -> int:
        """As load, from a file."""
        try:
            with open(path, "rb") as file:
                data = file.read()
        except OSError:
            self.forget()
            self.reason = UNREADABLE
            return UNREADABLE
        return self.load(data, sensor, binding)

    def load(self, data: bytes, sensor: "Sensor", binding: "bytes | None" = None) -> int:
        """Take the model in `data` if it fits this device; LOADED, or why there is none now.

        sensor: the Corrector's Sensor; binding: MPU6050.binding, None where no driver is (the
        scales alone are compared). REASONS says each result in words. Raises nothing for data.
        """
        self.forget()
        reason = judge(data)
        if reason == LOADED:
            reason = compare(data, sensor, binding)
        if reason == LOADED:
            reason = fill(self.e, data, sensor)
        if reason == LOADED:
            self.channels = texts(data)[1 : 1 + data[9]]
            if len(self.channels) < data[9]:
                reason = IMPOSSIBLE
        if reason == LOADED:
            self.e[0] = data[6]
            self.power_on()
        self.reason = reason
        return reason

    def forget(self) -> None:
        """Have no model."""
        for i in range(WORDS):
            self.e[i] = 0
        self.channels = ()
        self.reason = NO_MODEL
        self.attend = None

    def power_on(self) -> None:
        """Begin a power-on: time, means, lags and memories anew; coefficients stay."""
        e = self.e
        for i in (3, 4, 5, 8, 10, 11, 12, 13, 14, 15, 23, 24, 25):
            e[i] = 0
        e[7] = 1
        for a in range(_INPUT, _INPUT + 6 * e[1], 6):
            e[a + 3] = 0
            e[a + 4] = 0
            e[a + 5] = 256 if e[a] == _ONE else _NONE
        if e[26]:
            from .refine_kernels import effect_refine

            effect_refine.renew(e)
        for i in range(_CHANNELS):
            e[_CHANNEL + i] = _NONE
        for a in range(_SLOT, _TABLE, _SLOT_WORDS):
            e[a + 34] = 0
            e[a + 39] = 0
        for a in range(_PLAY, _PLAY + _PLAY_WORDS * e[_PLAYS], _PLAY_WORDS):
            e[a + 13] = 0

    def refine(self, bound: float = 0.5) -> None:
        """Let the coefficients of the loaded model go on learning from rests, from now on.

        What they have learned is forgotten when the model is loaded anew. bound: how far each may
        leave the model's, as a share of the slot's largest, 0..1; 0 ends it and puts the model's
        own back. Raises ValueError.
        """
        if not 0 <= bound <= 1:
            raise ValueError("bound is 0..1")
        e = self.e
        e[27] = int(bound * 8 + 0.5)
        e[26] = 1 if e[27] else 0
        for a in range(_SLOT, _SLOT + _SLOT_WORDS * e[0], _SLOT_WORDS):
            e[a + 24], e[a + 25], e[a + 26] = e[a + 30], e[a + 31], e[a + 32]
        from .refine_kernels import effect_refine  # a few kB that nobody else needs

        effect_refine.begin(e, e[0])
        self.attend = effect_refine.attend if e[26] else None

    def channel(self, name: str, value: int) -> bool:
        """Say what an extra channel, by name or index, reads now (an int); False: no such one.

        It is held until the next call. Allocates nothing.
        """
        names = self.channels
        for i in range(len(names)):
            if i == name or names[i] == name:
                self.e[_CHANNEL + i] = value
                return True
        return False
