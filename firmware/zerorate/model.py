"""An effect model in the firmware: one array with its numbers and all that is running.

docs/layout.md has the words of `e`.
"""

from array import array

from .machine_code import unload

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .sensor import Sensor

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's settings
_STEP_LSB = const(29)
# layout: The effect model and its running state
_SLOT_COUNT = const(7)
_INPUT_COUNT = const(8)
_TICK_US = const(9)
_TICK_ELAPSED_US = const(10)
_TICKS_DUE = const(11)
_NEXT_SLOT = const(12)
_HALF_TICKS = const(14)
_RUNNING = const(15)
_SUM_Q14 = const(17)
_HELD_Q14 = const(20)
_PLAY_COUNT = const(26)
_SQUARES = const(30)
_SLOW_BEGUN = const(32)
_REFINE_ON = const(33)
_BOUND_EIGHTHS = const(34)
_CURVE_LSB = const(35)
_INPUTS = const(39)
_CHANNELS = const(111)
_SLOTS = const(119)
_TABLES = const(439)
_PLAYS = const(909)
_EFFECTS_WORDS = const(999)
# layout: An input of the effect model
_INPUT_KIND = const(0)
_INPUT_SUM = const(3)
_INPUT_N = const(4)
_INPUT_VALUE_Q8 = const(5)
_INPUT_WORDS = const(6)
# layout: An effect slot
_SLOT_COEFFICIENT = const(24)
_SLOT_OWN = const(30)
_SLOT_STARTED = const(34)
_SLOT_VALUE = const(39)
_SLOT_WORDS = const(40)
# layout: A play operator
_PLAY_STARTED = const(13)
_PLAY_WORDS = const(15)
# layout: What the reader of model.bin says
_IMPOSSIBLE = const(11)
# layout: Sources of effects: an acceleration, the temperature, a mean rate, ..., a channel
_KIND_ONE = const(9)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: How many of each an effect model has at most
_MOST_CHANNELS = const(8)
# layout: end
# effects.model_file has the same numbers, and all; its 4 KB are there while a model is loaded
LOADED = const(0)
NO_MODEL = const(1)
UNREADABLE = const(6)
_WITHOUT_MODEL_US = const(1_000_000)
# Of twice the range of temperature: a model holds a curve half of it farther on either side.
_ESTIMATORS_OF_A_CURVE = const(16)


class EffectModel:
    """An effect model and its running state, in `e`; without slots while no model is loaded.

    channels: names of the extra channels that the model follows, in the order of their index;
    attend: the kernel that refines coefficients, None while it is off; crc: the last four bytes of
    model.bin, its CRC-32, which tell models apart.
    """

    def __init__(self) -> None:
        self.e = array("i", [0] * _EFFECTS_WORDS)
        self.attend: "Any" = None
        self.forget()

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
        from .effects.model_file import compare, fill, judge, texts

        self.forget()
        reason = judge(data)
        if reason == LOADED:
            reason = compare(data, sensor, binding)
        if reason == LOADED:
            reason = fill(self.e, data, sensor)
        if reason == LOADED:
            self.channels = texts(data)[1 : 1 + data[9]]
            if len(self.channels) < data[9]:
                reason = _IMPOSSIBLE
        if reason == LOADED:
            self.e[_SLOT_COUNT] = data[6]
            self.crc = bytes(data[-4:])
            self.power_on()
        else:
            self.forget()
        unload("zerorate.effects", "model_file")
        self.reason = reason
        return reason

    def forget(self) -> None:
        """Have no model."""
        for i in range(_EFFECTS_WORDS):
            self.e[i] = 0
        self.e[_TICK_US] = _WITHOUT_MODEL_US  # time is divided by it all the same
        self.channels = ()
        self.crc = b""
        self.reason = NO_MODEL
        self.attend = None

    def power_on(self) -> None:
        """Begin a power-on: time, means, lags and memories anew; coefficients stay."""
        e = self.e
        for i in (_TICK_ELAPSED_US, _TICKS_DUE, _NEXT_SLOT, _RUNNING, _SLOW_BEGUN):
            e[i] = 0
        e[_SQUARES] = 0
        e[_SQUARES + 1] = 0
        for axis in range(3):
            e[_SUM_Q14 + axis] = 0
            e[_HELD_Q14 + axis] = 0
        e[_HALF_TICKS] = 1
        for a in range(_INPUTS, _INPUTS + _INPUT_WORDS * e[_INPUT_COUNT], _INPUT_WORDS):
            e[a + _INPUT_SUM] = 0
            e[a + _INPUT_N] = 0
            e[a + _INPUT_VALUE_Q8] = 256 if e[a + _INPUT_KIND] == _KIND_ONE else _NO_VALUE
        if e[_REFINE_ON]:
            from .native.refine import renew

            renew(e)
        for i in range(_MOST_CHANNELS):
            e[_CHANNELS + i] = _NO_VALUE
        for a in range(_SLOTS, _TABLES, _SLOT_WORDS):
            e[a + _SLOT_STARTED] = 0
            e[a + _SLOT_VALUE] = 0
        for a in range(_PLAYS, _PLAYS + _PLAY_WORDS * e[_PLAY_COUNT], _PLAY_WORDS):
            e[a + _PLAY_STARTED] = 0

    def refine(self, bound: float = 0.5) -> None:
        """Let the coefficients of the loaded model go on learning from rests, from now on.

        What they have learned is forgotten when the model is loaded anew. bound: how far each may
        leave the model's, as a share of the slot's largest, 0..1; 0 ends it and puts the model's
        own back. Raises ValueError.
        """
        if not 0 <= bound <= 1:
            raise ValueError("bound is 0..1")
        e = self.e
        e[_BOUND_EIGHTHS] = int(bound * 8 + 0.5)
        e[_REFINE_ON] = 1 if e[_BOUND_EIGHTHS] else 0
        for a in range(_SLOTS, _SLOTS + _SLOT_WORDS * e[_SLOT_COUNT], _SLOT_WORDS):
            for axis in range(3):
                e[a + _SLOT_COEFFICIENT + axis] = e[a + _SLOT_OWN + axis]
        from .native.refine import attend, begin  # a few kB that nobody else needs

        begin(e, e[_SLOT_COUNT])
        self.attend = attend if e[_REFINE_ON] else None

    def channel(self, name: str, value: int) -> bool:
        """Say what an extra channel, by name or index, reads now (an int); False: no such one.

        It is held until the next call. Allocates nothing.
        """
        names = self.channels
        for i in range(len(names)):
            if i == name or names[i] == name:
                self.e[_CHANNELS + i] = value
                return True
        return False


def use_model(corrector, effects):
    """As Corrector.use_model."""
    from .native.effects import sense
    from .others import join

    corrector._sense = sense
    corrector.effects = effects
    # A curve that the model holds whole leaves little but noise at a temperature: estimators
    # that share its range have more of the readings each.
    step = effects.e[_CURVE_LSB] // _ESTIMATORS_OF_A_CURVE
    corrector.settings[_STEP_LSB] = max(corrector._step_lsb, step)
    join(corrector)
