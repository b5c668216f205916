"""What the firmware's machine code is made of: the parts, and how each is entered.

A part is one piece of code with one entry of four arguments, as MicroPython's inline assembler has
it. `what` is a time, or below -2^29, where no clock
ends, the number of a stage in its upper half word and a value in its lower one. At odd settings the
guard alone sees the sample.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

_STAGE = [-0x40000000 + (number << 16) for number in range(7)]
#: `what` of a burst, to which the number of its samples is added.
BURST = _STAGE[6]


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
