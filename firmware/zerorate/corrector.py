"""The user's object: one sample in, the same sample out without its zero-rate output."""

from .machine_code import unload
from .native import rest
from .sensor import Sensor

TYPE_CHECKING = False
if TYPE_CHECKING:
    from array import array
    from typing import Any

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_STILLNESS = const(19)
_OUT_Q8 = const(63)
_QUALITY_Q8 = const(69)
_EFFECT_Q8 = const(75)
_SOURCE = const(78)
# layout: The last words before the axes
_TURN_ON_OFFSET_Q8 = const(-3)
# layout: An axis
_WAITING_N = const(1)
_OFFSET_FROM = const(13)
_OFFSET_Q8 = const(27)
_OFFSET_VARIANCE_Q8 = const(28)
_WALK_Q16 = const(29)
_SUSPECT = const(30)
_OFFSET_AGE_MS = const(31)
_LINE_TEMP = const(34)
_LEFT_Q4 = const(37)
# layout: The corrector's settings
_AXES = const(0)
_AXIS_WORDS = const(15)
_GATE_Q4 = const(40)
_TURN_ON_VARIANCE_Q8 = const(47)
# layout: What a window was
_STILL = const(1)
# layout: Where a bias comes from
_ANY_TEMPERATURE = const(1)
# layout: What a store says
_OUT_OF_RANGE = const(7)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end
# A piece of heap held through a program's imports, or none as long is left on a small board for the
# state, its checkpoint and an open file.
_held = [bytearray(5600)]


class Corrector:
    """Learns the bias of three axes while the device lives, and subtracts it.

    sensor: a Sensor, or None for an MPU-6050 at +-250 dps and 100 Hz. bins: 1, 4..19 an estimator;
    short, long: estimators an axis. document: the literal rules of the three patents
    (docs/learning.md): of US 9,354,080 every reading learned, mean of the most significant bin,
    split in halves, one straight line, with settings of its own; with every=False the same rules
    on this project's rests. every: learn every reading, moving or still (default: as document).
    ignore_outside: readings outside a histogram are ignored instead of extending it (default: as
    document). motion: learn in motion as well; gravity: against gravity as well (default: where
    the board has that part and the sensor serves it, but not with document or every); with
    document both in their literal forms. Any key of DEFAULTS (settings.py, docs/settings.md) may
    be given by name, in its unit. Raises ValueError.
    """

    # of the class, so that who has none of them pays no heap for it
    effects: "Any" = None
    schedule: "Any" = None
    motion = motion_settings = gravity = gravity_settings = None
    _sense: "Any" = None
    _observe_motion: "Any" = None
    _observe_gravity: "Any" = None
    _with_others: "Any" = None
    # set by making.py
    settings: "array[int]"
    state: "array[int]"
    left_out: "list[str]"
    _walk_q16: int
    _step_lsb: int
    alone = True
    leave_bursts: "Any" = None

    def __init__(
        self,
        sensor: "Sensor | None" = None,
        bins: "int | None" = None,
        short: int = 3,
        long: int = 5,
        document: bool = False,
        every: "bool | None" = None,
        ignore_outside: "bool | None" = None,
        motion: "bool | None" = None,
        gravity: "bool | None" = None,
        **limits: float,
    ) -> None:
        from .making import make  # loaded here and let go, as it runs once

        self.sensor = sensor or Sensor()
        make(
            self, _held, bins, short, long, document, every, ignore_outside, motion, gravity, limits
        )
        unload("zerorate", "making")
        if rest.run and self.alone and type(self) is Corrector:
            self.update = _bound(self.state, self.settings)  # type: ignore[method-assign]
        self.reset()

    def reset(self) -> None:
        """Forget everything that was learned."""
        s = self.state
        c = self.settings
        for axis in range(3):
            a = c[_AXES] + axis * c[_AXIS_WORDS]
            for i in range(a, a + c[_AXIS_WORDS]):
                s[i] = 0
            rest.reset(s, c, a)
            s[a + _WALK_Q16] = self._walk_q16
        self.power_on()

    def power_on(self, same: bool = False) -> None:
        """Begin a new power-on with what `state` holds: its curves, jumps, half of its offsets.

        same: only the program began anew, and the chip kept its power: the offsets stand, too.
        """
        s = self.state
        c = self.settings
        if self.effects is not None:
            self.effects.power_on()
        if self.motion is not None or self.gravity is not None:
            from .others import forget

            forget(self)
        for i in range(c[_AXES]):
            s[i] = 0
        for axis in range(3):
            a = c[_AXES] + axis * c[_AXIS_WORDS]
            s[a + _WAITING_N] = 0
            s[a + _SUSPECT] = 0
            s[a + _LINE_TEMP] = -32768
            if not same:
                # what is beyond the gate was a jump, and stays
                if abs(s[a + _OFFSET_Q8]) >> 4 < c[_GATE_Q4]:
                    s[a + _OFFSET_Q8] >>= 1
                # what motion left unsure is no surer after having been off
                if not s[a + _OFFSET_FROM] or s[a + _OFFSET_VARIANCE_Q8] < c[_TURN_ON_VARIANCE_Q8]:
                    s[a + _OFFSET_VARIANCE_Q8] = c[_TURN_ON_VARIANCE_Q8]
                    s[a + _LEFT_Q4] = _NO_VALUE
                s[a + _OFFSET_AGE_MS] = 0
            # else what is held back until it insists would be the curve's
            s[c[_AXES] + _TURN_ON_OFFSET_Q8 + axis] = s[a + _OFFSET_Q8]

    def update(self, sample: "array[int]", dt_us: int) -> int:
        """Learn from `sample` and correct its rates in place; allocates nothing.

        sample: array('i') ax ay az temp gx gy gz, raw LSB; dt_us: since the sample before.
        Returns 0, or the guard's name for a frame that is not a good reading (see guard.py).
        """
        if self.alone:
            return rest.step(self.state, self.settings, sample, dt_us)
        return self._with_others(sample, dt_us)

    def use_model(self, effects: "Any") -> None:
        """Subtract what this model says (a loaded model.EffectModel), and learn what is left.

        Call it before `update` is kept in a variable: one from before goes on without the model.
        """
        from .model import use_model  # who has none has no memory taken by it

        use_model(self, effects)

    def load(self, store: "Any", same: bool = False) -> int:
        """Begin a power-on with what `store` holds; returns its reason, 0 if it was loaded.

        store: a store.Store of `4 * len(corrector.state)` bytes; same: as of power_on. Anything
        but 0 leaves a clean start; reasons.REASONS says why.
        """
        reason = store.load(self.state)
        if reason == 0:
            from .storage.soundness import is_sound

            if is_sound(self.state, self.settings):
                self.power_on(same)
            else:
                self.reset()
                reason = _OUT_OF_RANGE
            unload("zerorate.storage", "soundness")
        elif not any(self.state):  # what was read again was not what had been judged
            self.reset()
        return reason

    def save(self, store: "Any") -> bool:
        """Write what was learned to `store`; False when that failed."""
        return store.save(self.state)

    def bias_lsb(self, axis: int) -> float:
        """Return what is subtracted from that axis now, LSB."""
        return (self.state[_OUT_Q8 + axis] + self.state[_EFFECT_Q8 + axis]) / 256

    def quality_lsb(self, axis: int) -> float:
        """Return the one-sigma uncertainty of that axis' bias, LSB."""
        return self.state[_QUALITY_Q8 + axis] / 256

    def source(self, axis: int) -> int:
        """Return where that axis' bias comes from: a number of SOURCE in docs/layout.md."""
        return self.state[_SOURCE + axis]

    @property
    def learned(self) -> bool:
        """Whether every axis has a bias that was learned, not one guessed from the current rest."""
        for axis in range(3):
            if self.state[_SOURCE + axis] <= _ANY_TEMPERATURE:
                return False
        return True

    @property
    def rests(self) -> bool:
        """Whether the device was still in the latest window of samples."""
        return self.state[_STILLNESS] == _STILL

    def explain(self) -> str:
        """Return a sentence or two on what is being learned, or why nothing is."""
        from .explain import explain  # words that take no heap but while somebody asks

        text = explain(self)
        unload("zerorate", "explain")
        unload("zerorate", "explain_sources")
        return text


def _bound(s, c):
    """Machine code's `update`, bound: to look up where two arrays lie takes as long as it."""
    run = rest.run
    s_at = rest.address(s)
    c_at = rest.address(c)

    def update(x, dt_us, kept=(s, c)):
        return run(s_at, c_at, x, dt_us)

    return update
