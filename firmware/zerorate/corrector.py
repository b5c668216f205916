"""The user's object: one sample in, the same sample out without its zero-rate output."""

try:
    from uarray import array  # so MicroPython does not look for it on its file system first
except ImportError:
    from array import array

from .machine_code import unload
from .native import rest
from .sensor import Sensor

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_STILLNESS = const(50)
_OUT_Q8 = const(61)
_EFFECT_Q8 = const(67)
_QUALITY_Q8 = const(76)
_SOURCE = const(79)
# layout: An axis
_WAITING_N = const(1)
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
_STEP_LSB = const(29)
_GATE_Q4 = const(40)
_TURN_ON_VARIANCE_Q8 = const(47)
# layout: The effect model and its running state
_CURVE_LSB = const(35)
# layout: What a window was
_STILL = const(1)
# layout: Where a bias comes from
_ANY_TEMPERATURE = const(1)
# layout: What a store says
_OUT_OF_RANGE = const(7)
# layout: Values that stand for none
_NO_VALUE = const(-0x3FFFFFFF)
# layout: end
# Of twice the range of temperature: a model holds a curve half of it farther on either side.
_ESTIMATORS_OF_A_CURVE = const(16)
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
        from .settings import settings

        self.sensor = sensor or Sensor()
        if every is None:
            every = document
        self.settings, self._walk_q16, chosen = settings(
            self.sensor, bins, short, long, document, every, ignore_outside, limits
        )
        unload("zerorate", "settings")
        c = self.settings
        self._step_lsb = c[_STEP_LSB]
        # before other sources are loaded, while there is heap in one piece; a list of as many zeros
        # would want as much again
        _held.clear()
        self.state = array("i", range(c[_AXES] + 3 * c[_AXIS_WORDS]))
        self.alone = True
        self.left_out = []  # type: ignore[var-annotated]
        if every or document:  # who asks for other rules gets those alone
            motion, gravity = bool(motion), bool(gravity)
        self._begin("motion", motion, document, chosen["motion_start_dps"])
        self._begin("gravity", gravity, document, 0)
        unload("zerorate", "ratio")
        if rest.run and self.alone and type(self) is Corrector:
            self.update = _bound(self.state, c)  # type: ignore[method-assign]
        self.reset()

    def _begin(self, part, wanted, document, start_dps):
        # loaded here, so that who does without it has no memory taken by it
        if wanted or wanted is None:
            package, name = "zerorate." + part, part + "_settings"
            try:
                __import__(package + "." + name, None, None, (part,)).join(
                    self, document, start_dps
                )
                unload(package, name)
                self._join_others()
            except ImportError:
                if wanted:
                    raise
                text = "Left out: %s is not on this board; zerorate flash --with %s sends it."
                self.left_out.append(text % (part, part))
            except ValueError as error:
                if wanted:
                    raise
                self.left_out.append("Left out: %s." % error)

    def _join_others(self):
        if self.alone:
            from .others import Others  # who rests alone has no memory taken by them

            self._with_others = Others(self).update
            self.alone = False
            if "update" in self.__dict__:
                del self.update

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
                s[a + _OFFSET_VARIANCE_Q8] = c[_TURN_ON_VARIANCE_Q8]
                s[a + _LEFT_Q4] = _NO_VALUE
                s[a + _OFFSET_AGE_MS] = 0

    def update(self, sample: "array[int]", dt_us: int) -> int:
        """Learn from `sample` and correct its rates in place; allocates nothing.

        sample: array('i') ax ay az temp gx gy gz, raw LSB; dt_us: since the sample before.
        Returns 0, or the guard's name for a frame that is not a good reading (see guard.py).
        """
        if self.alone:
            return rest.step(self.state, self.settings, sample, dt_us)
        return self._with_others(sample, dt_us)

    def use_model(self, effects: "Any") -> None:
        """Subtract what this model says (a loaded model.EffectModel), and learn what is left."""
        from .native.effects import sense

        self._sense = sense
        self.effects = effects
        # A curve that the model holds whole leaves little but noise at a temperature: estimators
        # that share its range have more of the readings each.
        step = effects.e[_CURVE_LSB] // _ESTIMATORS_OF_A_CURVE
        self.settings[_STEP_LSB] = max(self._step_lsb, step)
        self._join_others()

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
