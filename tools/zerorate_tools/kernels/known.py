"""What each part's machine code is tried on before a board uses it, and what must come out.

Small arrays that reach most of a part's code within a few calls; firmware/zerorate/trying.py
says how they are written down and run.
"""

from array import array
from collections.abc import Callable, Sequence
from typing import Any

from zerorate import Corrector, Sensor
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.model import EffectModel
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate.trying import answer

from zerorate_tools.layout import SETTINGS, STATE, STILLNESS

from ..model import Binding, Slot, build_model, encoded
from ..model.term import Term
from ..recordings import Scales
from .parts import BURST

_FRAME = [0] * 7
_SCALES = Scales("MPU-6050", 4.0, 131.0, 16384.0, 340.0, 36.53)
_SHAKY = {"still_dps": 40.0, "still_g": 1.0, "turn_dps": 20.0, "change_dps": 40.0}


def known(part: str) -> tuple[Any, ...]:
    """The part's KNOWN (see trying.answer)."""
    rounds, what, new, bits, *arrays = _KNOWN[part]()
    return (rounds, what, new, bits, *(_sparse(words) for words in arrays))


def answer_by(run: Callable[..., Any], part: str) -> bytes:
    """What `run`, of four arguments, makes of the part's known arrays."""
    return answer(run, known(part))


def _sparse(words: Sequence[int]) -> tuple[int, bytes]:
    pairs = [number for at, word in enumerate(words) if word for number in (at, word)]
    return len(words), array("i", pairs).tobytes()


def _corrector() -> Corrector:
    limits = {"window_s": 0.08, "segment_s": 0.16, "promote_s": 0.1, "fit_s": 0.04, **_SHAKY}
    return Corrector(Sensor(), bins=4, short=1, long=2, **limits)


def _rest() -> tuple[Any, ...]:
    corrector = _corrector()
    return 2, BURST + 10, 8 * 10, 5, corrector.state, corrector.settings, [0] * (8 * 10)


def _motion() -> tuple[Any, ...]:
    settings = motion_settings(node_s=0.02, longest_stage=4, least_dps=0.001, least_up_g=0.0)
    return 60, 10000, 7, 10, motion_state(settings), settings, _FRAME


def _gravity() -> tuple[Any, ...]:
    settings = gravity_settings(sub_unit_s=0.04, units=4, threshold=1)
    return 30, 10000, 7, 12, gravity_state(settings), settings, _FRAME


def known_model() -> EffectModel:
    """A model of three slots, loaded, that uses much of what slots can do."""
    temp = ("temp", 20.0, 50.0, 36.0)
    slots = [
        Slot(Term(*temp, lag_mode="lag", lag_s=3.0, power=3, decay_s=9.0), (1e-4, 2e-4, 0.0)),
        Slot(Term(*temp, memory="backlash", width=1.0, knot=30.0), (0.3, -0.2, 0.1)),
        Slot(
            Term("rate_x", -20.0, 20.0, second="temp", second_lo=0, second_hi=60), (1e-3, 0, 1e-4)
        ),
    ]
    model = EffectModel()
    data = encoded(build_model(slots, _SCALES, binding=Binding(0, 0, 0, 0)))
    if model.load(data, Sensor(4.0)):
        raise AssertionError(f"the known model is refused: {model.reason}")
    return model


def _effects() -> tuple[Any, ...]:
    return 20, 250000, 7, 12, [0] * 100, known_model().e, _FRAME


def _refine() -> tuple[Any, ...]:
    model = known_model()
    model.refine()
    state, settings = Corrector().state[:100], array("i", [0] * SETTINGS.size)
    state[STATE.SEGMENT_TOTAL : STATE.SEGMENT_TOTAL + 3] = array("i", [9000, -300, 70])
    state[STATE.STILLNESS], state[STATE.TEMP] = STILLNESS.STILL, 900
    settings[SETTINGS.WINDOW_SHIFT], settings[SETTINGS.SEGMENT] = 6, 1
    return 20, 0, 0, 0, state, settings, model.e


_KNOWN: dict[str, Callable[[], tuple[Any, ...]]] = {
    "rest": _rest,
    "motion": _motion,
    "gravity": _gravity,
    "effects": _effects,
    "refine": _refine,
}
