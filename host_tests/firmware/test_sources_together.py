"""Three sources and one decision: equal on every interpreter, no heap, no leap, in words."""

import sys
from array import array
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate import Corrector, Sensor
from zerorate.motion.orientation import orientation
from zerorate_tools.layout import GRAVITY, MOTION, SOURCE, STATE
from zerorate_tools.model import Slot
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales
from zerorate_tools.simulate import simulate

from . import motions
from .played import by_machine_code, estimators
from .simulated_sources import loaded
from .test_motion_frame import as_rotation

HZ = 25.0
DT_US = 40000
BIAS_DPS = np.array([1.0, -2.0, 3.0])
OUT_Q8, SOURCE_WORD, LSB = STATE.OUT_Q8, STATE.SOURCE, 131.0
MOTION_LEARNED, GRAVITY_COUNTED = MOTION.ACCEPTED, GRAVITY.OBSERVED


@pytest.fixture(scope="module")
def samples():
    """(n, 7): a minute of swinging at a lean, then a quarter of one at rest."""
    lean = Rotation.from_rotvec([0.5, -0.6, 0.2])
    swing = motions.swinging(7, 60, hz=HZ, bias_dps=BIAS_DPS, start=lean)
    rest = motions.turning(15, 0.0, [1, 0, 0], hz=HZ, bias_dps=BIAS_DPS, start=lean)
    return np.vstack([swing.samples, rest.samples])


def both(**options):
    return Corrector(Sensor(HZ), **options)


def played(corrector, samples, look=lambda corrector: None):
    for sample in samples.tolist():
        corrector.update(array("i", sample), DT_US)
        look(corrector)
    return corrector


def words(corrector):
    return b"".join(x.tobytes() for x in (corrector.state, corrector.motion, corrector.gravity))


@pytest.fixture(scope="module")
def expected(samples):
    corrector = played(both(), samples)
    assert corrector.motion[MOTION_LEARNED] > 0
    assert max(corrector.gravity[GRAVITY_COUNTED : GRAVITY_COUNTED + 3]) > 50
    assert list(corrector.state[SOURCE_WORD : SOURCE_WORD + 3]) == [SOURCE.FIT] * 3, (
        "the rest has the last word"
    )
    return words(corrector)


def test_every_interpreter_decides_the_same_and_allocates_nothing(
    micropython, repository, samples, expected
):
    result = micropython.run(
        Path(__file__).parent / "on_micropython" / "parts_without_heap.py",
        ["sources"],
        modules=[repository / "firmware"],
        files_in={"samples.bin": samples.astype("int32").tobytes()},
        files_out=["out.bin"],
        check=True,
    )
    assert result.files["out.bin"] == expected


def test_the_kernels_that_are_compiled_decide_the_same(samples, expected):
    corrector = both()
    by_machine_code(corrector, samples.astype(np.int32), np.full(len(samples), DT_US))
    assert words(corrector) == expected


def test_the_output_slews_no_faster_than_stated_when_the_source_changes(samples):
    """0.5 dps a second, once an axis has had its first bias at all."""
    steps = {axis: [] for axis in range(3)}
    last = {}

    def look(corrector):
        for axis in range(3):
            bias = corrector.state[OUT_Q8 + axis] / 256 / LSB
            if axis in last:
                steps[axis].append(abs(bias - last[axis]))
            if corrector.state[SOURCE_WORD + axis] > 1:
                last[axis] = bias

    played(both(), samples, look)
    most = [max(found) * HZ for found in steps.values()]
    print("steepest change of the output:", np.round(most, 3), "dps/s")
    assert 0 < max(most) <= 0.5


SCALES = Scales("MPU-6050", HZ, LSB, 16384, 340.0, 36.53)
RATES = [Term(f"rate_{axis}", -500.0, 500.0) for axis in "xyz"]
SCALE_AND_AXES = np.array([[0.05, -0.02, 0.01], [0.03, -0.04, 0.02], [-0.01, 0.02, 0.03]])
MATRIX = [Slot(t, tuple(c), "scale-factor") for t, c in zip(RATES, SCALE_AND_AXES.T.tolist())]
PER_DEGC = np.array([0.1, -0.05, 0.08])
OF_TEMPERATURE = [Slot(Term("temp", 0.0, 60.0, 30.0), tuple(PER_DEGC), "temperature")]


def with_effect(samples, slots):
    """The samples of a device that has what these slots say."""
    rates = samples[:, 4:].astype(float)
    if slots is MATRIX:  # the slots read the rate as it is measured
        rates = rates @ np.linalg.inv(np.eye(3) - SCALE_AND_AXES).T
    else:
        rates = rates + PER_DEGC * (SCALES.temp_offset_degc - 30.0) * LSB
    return np.column_stack([samples[:, :4], np.round(rates)]).astype(np.int32)


@pytest.mark.parametrize("slots", [MATRIX, OF_TEMPERATURE])
def test_with_its_effects_taken_out_a_device_learns_in_motion_what_one_without_them_does(slots):
    lean = Rotation.from_rotvec([0.5, -0.6, 0.2])
    clean = motions.swinging(7, 90, hz=HZ, bias_dps=BIAS_DPS, start=lean).samples
    sensor = Sensor(HZ)
    plain, modelled, left_in = (Corrector(sensor) for _ in range(3))
    modelled.use_model(loaded(slots, SCALES, sensor))
    affected = with_effect(clean, slots)
    times = np.full(len(clean), DT_US)
    for corrector, rows in ((plain, clean), (modelled, affected), (left_in, affected)):
        by_machine_code(corrector, rows.astype(np.int32), times)
        assert corrector.motion[MOTION_LEARNED] > 0
    by_python = Corrector(sensor)
    by_python.use_model(loaded(slots, SCALES, sensor))
    assert words(played(by_python, affected)) == words(modelled)
    expected, found, wrong = (
        np.array(c.state[STATE.TARGET_Q8 : STATE.TARGET_Q8 + 3]) / 256 / LSB
        for c in (plain, modelled, left_in)
    )
    assert found == pytest.approx(expected, abs=0.025)
    assert np.abs(wrong - expected).max() > 3 * 0.025
    up = [as_rotation(orientation(c)).inv().apply([0, 0, 1]) for c in (plain, modelled)]
    assert up[0] == pytest.approx(up[1], abs=0.005)


def test_it_says_what_each_source_is_doing(samples):
    corrector = both()
    fresh = corrector.explain()
    assert "In motion: no window has been seen yet" in fresh
    assert "Against gravity: no half-second has been seen yet" in fresh
    played(corrector, samples[: round(40 * HZ)])
    swinging = corrector.explain()
    assert "In motion: the latest window taught a bias" in swinging
    assert "othing is learned" not in swinging
    assert "Observable against gravity: gx for" in swinging
    for _ in range(2):
        played(corrector, samples[-round(15 * HZ) :])
    assert "In motion: the latest window taught nothing: it hardly moves" in corrector.explain()


def test_it_says_which_axis_gravity_hides():
    flat = motions.turning(20, 0.0, [1, 0, 0], hz=HZ)
    text = played(both(), flat.samples).explain()
    assert "gz not at all, gravity lies along it" in text
    assert "gx for 1" in text


def test_every_source_is_on_by_default_and_left_out_by_name():
    assert Corrector().motion is not None and Corrector().gravity is not None
    corrector = Corrector(motion=False, gravity=False)
    text = corrector.explain()
    assert corrector.alone and "In motion" not in text and "Against gravity" not in text
    assert "Left out" not in text


def test_a_sensor_too_slow_for_a_source_goes_without_it_and_says_so():
    corrector = Corrector(Sensor(5.0))
    assert corrector.motion is None and corrector.gravity is not None
    assert "Left out: learning in motion needs 8 Hz or more, not 5." in corrector.explain()
    with pytest.raises(ValueError, match="needs 8 Hz or more"):
        Corrector(Sensor(5.0), motion=True)


def test_a_board_that_was_sent_the_rest_path_alone_goes_without_the_others(monkeypatch):
    for part in ("motion", "gravity"):
        for name in [name for name in sys.modules if name.startswith(f"zerorate.{part}")]:
            monkeypatch.delitem(sys.modules, name)
        monkeypatch.setitem(sys.modules, f"zerorate.{part}", None)
    corrector = Corrector()
    assert corrector.alone
    for part in ("motion", "gravity"):
        cure = f"Left out: {part} is not on this board; zerorate flash --with {part} sends it."
        assert cure in corrector.explain()
        with pytest.raises(ImportError, match=f"zerorate flash --with {part}"):
            Corrector(**{part: True})


def test_where_rests_exist_the_other_sources_do_not_touch_what_they_teach():
    """Rests of a second in ten: what motion found between them once taught the curve, too."""
    recording, _ = simulate("short-rests", session=1, seed=1)
    frames = recording.samples()[: 300 * 100].astype(np.int32)
    every, alone = Corrector(), Corrector(motion=False, gravity=False)
    for corrector in (every, alone):
        by_machine_code(corrector, frames.copy(), np.full(len(frames), 10000))
    assert every.motion[MOTION_LEARNED] > 20
    assert estimators(every) == estimators(alone)


def test_a_rough_guess_is_not_put_out(samples):
    """Beyond eight times what may teach, 1.2 dps, a first bias is kept back."""
    corrector = both(motion_most_dps=0.0001)
    played(corrector, samples[: round(40 * HZ)])
    assert corrector.motion[MOTION_LEARNED] > 0
    assert list(corrector.state[SOURCE_WORD : SOURCE_WORD + 3]) == [0, 0, 0]


def test_what_motion_left_unsure_is_no_surer_after_a_power_off(samples):
    corrector = played(both(motion_most_dps=1.0, motion_full_dps=0.1), samples[: round(60 * HZ)])
    before = [corrector.quality_lsb(axis) for axis in range(3)]
    corrector.power_on()
    played(corrector, samples[:1])
    for axis in range(3):
        assert 0.02 * LSB < before[axis] == pytest.approx(corrector.quality_lsb(axis), rel=0.01)
