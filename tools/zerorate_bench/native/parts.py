"""What the firmware's machine code is made of: the parts, and how each is entered.

A part is one piece of code with one entry of four arguments, as MicroPython's inline assembler has
it. `what` is a time, or below -2^29, where no clock ends, the number of a stage in its upper half
word and a value in its lower one. At odd settings the guard alone sees the sample. The small arrays
here reach most of a part's code in a few calls; firmware/zerorate/trying.py says how they are run.
"""

from array import array
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from zerorate import Corrector, Sensor
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.model import EffectModel
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate.trying import answer
from zerorate_tools.layout import SETTINGS, STATE, STILLNESS
from zerorate_tools.model import Binding, Slot, build_model, encoded
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

_STAGE = [-0x40000000 + (number << 16) for number in range(7)]
#: `what` of a burst, to which the number of its samples is added.
BURST = _STAGE[6]
_FRAME = [0] * 7
_SCALES = Scales("MPU-6050", 4.0, 131.0, 16384.0, 340.0, 36.53)
_SHAKY = {"still_dps": 40.0, "still_g": 1.0, "turn_dps": 20.0, "change_dps": 40.0}


@dataclass(frozen=True)
class Part:
    """kernels: file and function of what `body`, the entry's C, calls.

    calls: module of the kernels -> what the firmware imports of it from native/ -> how `run`, the
    machine code, does the same; pieces: those that few import, from a file PART_pieces.py.
    divides: its longest call is made of divisions, worth 370 bytes of a fast one where there is no
    instruction for it.
    """

    kernels: Sequence[tuple[str, str]]
    body: str
    calls: Mapping[str, Mapping[str, str]]
    pieces: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    divides: bool = False


PARTS = {
    "rest": Part(
        [
            *(("step", name) for name in ("step", "admit", "finish", "consider")),
            *(("estimators", "reset"), ("guard", "check"), ("block", "block")),
        ],
        """\
    if (what >= -0x20000000) {
        intptr_t at = (intptr_t)b;
        return at & 1 ? guard_check(a, (int32_t *)(at - 1), c, what) : step_step(a, b, c, what);
    }
    int32_t value = what & 0xffff;
    int32_t stage = (what >> 16) & 0xff;
    if (stage == 0) return step_admit(a, b, c, value);
    if (stage == 1) return step_finish(a, b, c, value);
    if (stage == 2) step_consider(a, b, c, value & 0xff, value >> 8);
    if (stage == 3) estimators_reset(a, b, value);
    if (stage == 4) for (int32_t i = value; i < (int32_t)(intptr_t)c; i++) b[i] = a[i];
    if (stage == 5) return (int32_t)(intptr_t)a;
    if (stage == 6) {
        int32_t room[7];
        block_block(a, c, b, room, value);
    }
    return 0;
""",
        {
            "rest.step": {"step": "run"},
            "rest.estimators": {"reset(s, c, a)": f"run(s, c, 0, {_STAGE[3]} + a)"},
            "rest.copying": {
                "copy(source, target, first, end)": f"run(source, target, end, {_STAGE[4]} + first)"
            },
            "": {"address(words)": f"run(words, 0, 0, {_STAGE[5]})"},
        },
        {
            "rest.step": {
                "admit(s, c, x, kind)": f"run(s, c, x, {_STAGE[0]} + kind)",
                "finish(s, c, x, kind)": f"run(s, c, x, {_STAGE[1]} + kind)",
                "consider(s, c, m, w, source)": f"run(s, c, m, {_STAGE[2]} + (source << 8) + w)",
            },
            "rest.guard": {"check": "run"},
        },
        divides=True,
    ),
    "motion": Part(
        [("in_motion", "update"), ("motion_verdict", "clear")],
        """\
    if (what >= -0x20000000) return in_motion_update(a, b, c, what);
    motion_verdict_clear(a, b);
    return 0;
""",
        {
            "motion.in_motion": {"update": "run"},
            "motion.motion_verdict": {"clear(s, c)": f"run(s, c, 0, {_STAGE[0]})"},
        },
    ),
    "gravity": Part(
        [("gravity", "update"), ("gravity", "clear")],
        """\
    if (what >= -0x20000000) return gravity_update(a, b, c, what);
    gravity_clear(a, b);
    return 0;
""",
        {"gravity.gravity": {"update": "run", "clear(s, c)": f"run(s, c, 0, {_STAGE[0]})"}},
    ),
    "effects": Part(
        [("effects", "sense")],
        """\
    effects_sense(a, b, c, what, c != 0);
    return 0;
""",
        {"effects.effects": {"sense(s, e, x, dt_us, good)": "run(s, e, x if good else 0, dt_us)"}},
    ),
    "refine": Part(
        [("effect_refine", name) for name in ("attend", "begin", "renew")],
        """\
    if (what == 0) effect_refine_attend(a, b, c);
    else if (what < 0) effect_refine_renew(c);
    else effect_refine_begin(c, what - 1);
    return 0;
""",
        {
            "effects.effect_refine": {
                "attend(s, c, e)": "run(s, c, e, 0)",
                "begin(e, slots)": "run(0, 0, e, 1 + slots)",
                "renew(e)": "run(0, 0, e, -1)",
            }
        },
    ),
}


def known(part: str) -> tuple[Any, ...]:
    """The part's KNOWN (see trying.answer)."""
    rounds, what, new, bits, *arrays = _refine() if part == "refine" else _known(part)
    return (rounds, what, new, bits, *(_sparse(words) for words in arrays))


def answer_by(run: Callable[..., Any], part: str) -> bytes:
    """What `run`, of four arguments, makes of the part's known arrays."""
    return answer(run, known(part))


def _sparse(words: Sequence[int]) -> tuple[int, bytes, bytes]:
    pairs: dict[str, list[int]] = {"h": [], "i": []}
    for at, word in enumerate(words):
        if word:
            pairs["h" if -0x8000 <= word < 0x8000 else "i"] += at, word
    short, whole = (array(kind, some).tobytes() for kind, some in pairs.items())
    return len(words), short, whole


def _known(part: str) -> tuple[Any, ...]:
    if part == "rest":
        limits = {"window_s": 0.08, "segment_s": 0.16, "promote_s": 0.1, "fit_s": 0.04, **_SHAKY}
        made = Corrector(Sensor(), bins=4, short=1, long=2, **limits)
        return 2, BURST + 10, 8 * 10, 5, made.state, made.settings, [0] * (8 * 10)
    if part == "motion":
        motion = motion_settings(node_s=0.02, longest_stage=4, least_dps=0.001, least_up_g=0.0)
        return 60, 10000, 7, 10, motion_state(motion), motion, _FRAME
    if part == "gravity":
        gravity = gravity_settings(sub_unit_s=0.04, units=4, threshold=1)
        return 30, 10000, 7, 12, gravity_state(gravity), gravity, _FRAME
    return 20, 250000, 7, 12, [0] * 100, known_model().e, _FRAME  # effects


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


def _refine() -> tuple[Any, ...]:
    model = known_model()
    model.refine()
    state, settings = Corrector().state[:100], array("i", [0] * SETTINGS.size)
    state[STATE.SEGMENT_TOTAL : STATE.SEGMENT_TOTAL + 3] = array("i", [9000, -300, 70])
    state[STATE.STILLNESS], state[STATE.TEMP] = STILLNESS.STILL, 900
    settings[SETTINGS.WINDOW_SHIFT], settings[SETTINGS.SEGMENT] = 6, 1
    return 20, 0, 0, 0, state, settings, model.e
