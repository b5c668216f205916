"""An effect model as a person reads it: slots of a basis with coefficients, and for which chip."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from zerorate_i2c.parts import part_by_name
from zerorate_i2c.settings import ACCEL_LSB_PER_G, GYRO_LSB_PER_DPS

from ..errors import ZerorateError
from ..layout import LIMITS
from ..recordings import Scales
from .term import Term

MOST_SLOTS, MOST_PLAYS, MOST_CHANNELS = LIMITS.MOST_SLOTS, LIMITS.MOST_PLAYS, LIMITS.MOST_CHANNELS
MOST_TABLES, MOST_RINGS = LIMITS.MOST_TABLES, LIMITS.MOST_RINGS
TABLE_POINTS = LIMITS.TABLE_POINTS
RATES = ("rate_x", "rate_y", "rate_z")
ACCELERATIONS = ("acc_x", "acc_y", "acc_z")
FRAME = (*ACCELERATIONS, "temp", *RATES)
#: Sources that a hand moves faster than a tick, in the order of the firmware's kinds of them.
FAST = (*RATES, *ACCELERATIONS)
VIBRATION, TIME, ONE = "vib", "time", "one"
#: Every source but an extra channel, by the firmware's number of its kind (layout.INPUT_KIND).
KINDS = (*FRAME, VIBRATION, TIME, ONE, *FAST)
KEY = "binding"
NAMES = ("chip_id", "gyro_range", "accel_range", "filter")


class CannotDeploy(ZerorateError):
    """An effect that the firmware's slots cannot hold; the text says which and why."""


@dataclass(frozen=True)
class Slot:
    """One effect: coefficient_dps (x, y, z), dps per unit of the term's basis.

    effect: what it corrects, for people.
    """

    term: Term
    coefficient_dps: tuple[float, float, float]
    effect: str = ""

    @property
    def is_of_the_sample(self) -> bool:
        """Whether it is computed for every sample: it follows the rate, acceleration or a channel
        of the application, and remembers nothing."""
        t = self.term
        remembers = t.lag_mode != "none" or t.memory != "none" or t.decay_s + t.delay_s > 0
        return not remembers and (is_fast(t.source) or is_fast(t.second))

    @property
    def is_play(self) -> bool:
        """Whether it is a play operator, or the square of one, which the firmware holds apart."""
        return self.term.memory == "play"

    def has_delay(self, tick_s: float) -> bool:
        """Whether it needs a ring of the firmware to remember its source in."""
        return round(self.term.delay_s / tick_s) > 0

    def sources(self) -> list[tuple[str, bool]]:
        """(name, whether of the very sample) of what it follows."""
        names = [self.term.source, *([self.term.second] if self.term.second else [])]
        return [(n, self.is_of_the_sample and is_fast(n)) for n in names]


@dataclass(frozen=True)
class Input:
    """A source as the board sees it: (reading - offset) / 2^shift in 16 bits, mean of a tick.

    of_the_sample: what the very sample reads instead of the tick's mean.
    """

    name: str
    of_the_sample: bool = False
    shift: int = 0
    offset: int = 0


@dataclass(frozen=True)
class Binding:
    """The chip's id and the codes of its ranges and filter, as its registers say; None: unknown."""

    chip_id: int | None = None
    gyro_range: int | None = None
    accel_range: int | None = None
    filter: int | None = None


@dataclass(frozen=True)
class Model:
    """What model.json and model.bin hold. tick_us: period of the slots."""

    slots: tuple[Slot, ...]
    scales: Scales
    binding: Binding = field(default_factory=Binding)
    tick_us: int = 1_000_000
    inputs: tuple[Input, ...] = ()

    @property
    def tick_s(self) -> float:
        """Seconds of a tick."""
        return self.tick_us / 1e6

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the extra channels that the application has to give, in their order."""
        return tuple(dict.fromkeys(i.name for i in self.inputs if is_channel(i.name)))


def is_channel(name: str) -> bool:
    """Whether a source is none of the sensor's own."""
    return name not in (*FRAME, VIBRATION, TIME, ONE)


def is_fast(name: str | None) -> bool:
    """Whether a source may move faster than a tick: no temperature does."""
    return name is not None and (name in FAST or is_channel(name))


def sources_of(slots: Sequence[Slot]) -> list[tuple[str, bool]]:
    """(name, of the very sample) of every input that the slots need, each once, in order."""
    return list(dict.fromkeys(source for slot in slots for source in slot.sources()))


def binding_of(scales: Scales) -> Binding:
    """The binding that a recording's scales hold (`zerorate record` writes it); else what follows
    from the sensor's name and scales for a part of the MPU-6050 family; else nothing.
    """
    recorded = scales.more.get(KEY)
    if isinstance(recorded, dict):
        codes = {name: recorded.get(name) for name in NAMES}
        if all(c is None or (type(c) is int and 0 <= c < 255) for c in codes.values()):
            return Binding(**codes)
    try:
        chip_id = part_by_name(scales.sensor)[0]
    except ValueError:
        return Binding()
    return Binding(
        chip_id,
        _code(scales.gyro_lsb_per_dps, GYRO_LSB_PER_DPS),
        _code(scales.accel_lsb_per_g, ACCEL_LSB_PER_G),
    )


def _code(lsb: float | None, known: tuple[float, ...]) -> int | None:
    """The index of the range with that scale, within a thousandth."""
    near = [i for i, one in enumerate(known) if lsb and abs(lsb - one) <= 1e-3 * one]
    return near[0] if near else None
