"""What an application does with the corrector: settings, checkpoints, the store, and words."""

from array import array

import pytest
from zerorate import Corrector, Sensor
from zerorate.gravity.gravity_settings import gravity_settings
from zerorate.motion.motion_settings import motion_settings
from zerorate.settings import DEFAULTS
from zerorate.storage.codes import LOADED, OUT_OF_RANGE, UNREADABLE
from zerorate.storage.store import _PIECE, Store
from zerorate_fakes.memory import FakeMemory
from zerorate_tools.layout import AXIS, MOTION, STATE, axis_at

RATES = (800, -300, 40)
PERIOD_US = 10000
BLIND = Sensor(accel_lsb_per_g=0.0)


def rest(corrector, samples, rates=RATES, temp=1000):
    """Feed a resting device: a fixed dither stands for noise, so that frames are no repeats."""
    frame = array("i", [0] * 7)
    for n in range(samples):
        dither = (n * 7) % 13 - 6
        words = (3, dither, 16384 - dither, temp, *(rate + dither for rate in rates))
        for i in range(7):
            frame[i] = words[i]
        corrector.update(frame, PERIOD_US)
    return frame


@pytest.fixture
def learned():
    corrector = Corrector()
    rest(corrector, 1000)
    return corrector


def store_for(corrector, binding=b"\x68\0\0\0", memory=None):
    size = 4 * len(corrector.state)
    return Store(memory or FakeMemory(2 * size + 100), binding, size)


def test_the_documents_forms_of_all_three_are_within_reach():
    corrector = Corrector(document=True, motion=True, gravity=True)
    assert corrector.motion_settings == motion_settings(document=True)
    assert corrector.gravity_settings == gravity_settings(document=True)


def test_a_resting_device_reads_zero(learned):
    frame = rest(learned, 13)
    assert [abs(frame[4 + i]) <= 7 for i in range(3)] == [True] * 3
    assert [learned.bias_lsb(i) for i in range(3)] == pytest.approx(RATES, abs=0.5)


def test_rounding_loses_no_angle(learned):
    total = [0, 0, 0]
    for _ in range(520):
        frame = rest(learned, 1)
        total = [t + frame[4 + i] for i, t in enumerate(total)]
    # the dither of rest(1) is -6 each time; what is left is the bias error, below 0.5 LSB
    assert [t / 520 + 6 for t in total] == pytest.approx([0, 0, 0], abs=0.5)


def test_after_a_power_cut_the_first_sample_is_corrected(learned):
    store = store_for(learned)
    assert learned.save(store)
    again = Corrector()
    assert again.load(store_for(again, memory=store.storage)) == LOADED
    frame = rest(again, 1)
    assert [abs(frame[4 + i]) <= 7 for i in range(3)] == [True] * 3


def test_a_storage_that_reads_otherwise_while_a_state_is_filled_leaves_a_clean_start(learned):
    store = store_for(learned)
    learned.save(store)
    reads, readblock = [], store.storage.readblock
    pieces = 2 * -(-store.slot_bytes // _PIECE)  # of both slots, to find the newest

    def read(offset, buf):
        readblock(offset, buf)
        reads.append(offset)
        buf[-1] ^= len(reads) > pieces

    store.storage.readblock = read
    again = Corrector()
    assert again.load(store_for(again, memory=store.storage)) == UNREADABLE
    assert list(again.state) == list(Corrector().state)


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("CURRENT", 5000),
        ("ORDER", 0),
        ("HOTTEST", -32000),
        ("LINE_SHIFT", 32),
        ("OFFSET_AGE_MS", -64),
        ("WALK_Q16", -1),
    ],
)
def test_a_state_that_cannot_be_starts_afresh_and_says_so(learned, name, word):
    learned.state[axis_at(learned.settings, 1) + getattr(AXIS, name)] = word
    store = store_for(learned)
    assert learned.save(store)
    again = Corrector()
    assert again.load(store_for(again, memory=store.storage)) == OUT_OF_RANGE
    assert list(again.state) == list(Corrector().state)
    rest(again, 1000)
    assert again.learned


@pytest.mark.parametrize(
    ("keywords", "sentence"),
    [
        ({"bins": 20}, "bins must be 1 or 4..19"),
        ({"short": 0}, "short must be 1..6"),
        ({"colour": 1}, "no such setting: colour"),
        ({"sensor": Sensor(5.0), "motion": True}, "in motion needs 8 Hz or more, not 5"),
        ({"sensor": Sensor(2.5), "gravity": True}, "gravity needs 4 Hz or more, not 2.5"),
        ({"sensor": BLIND, "motion": True}, "in motion needs an accelerometer"),
        ({"sensor": BLIND, "gravity": True}, "gravity needs an accelerometer"),
    ],
)
def test_a_setting_that_cannot_be_is_refused_in_words(keywords, sentence):
    with pytest.raises(ValueError, match=sentence):
        Corrector(**keywords)


def test_a_sensor_that_cannot_be_is_refused_in_words():
    with pytest.raises(ValueError, match="odr_hz must be"):
        Sensor(odr_hz=0)


def test_it_says_what_it_lacks():
    text = Corrector(Sensor(accel_lsb_per_g=0, temp_lsb_per_degc=0)).explain()
    assert "slow turn cannot be told" in text and "all temperatures count as one" in text


def test_a_bias_shown_as_zero_has_no_sign():
    corrector = Corrector(motion=True)
    corrector.state[STATE.SOURCE] = 4
    corrector.state[STATE.OUT_Q8] = corrector.motion[MOTION.MOTION_BIAS_Q8] = -10
    corrector.motion[MOTION.MOTION_QUALITY_Q8] = 100
    text = corrector.explain()
    assert "gx: bias 0.000 dps" in text and "; gx 0.000 +-" in text


def test_a_new_power_on_forgets_what_the_other_sources_were_watching():
    corrector = Corrector(motion=True, gravity=True)
    fresh = list(corrector.motion), list(corrector.gravity)
    rest(corrector, 500)
    assert (list(corrector.motion), list(corrector.gravity)) != fresh
    corrector.power_on()
    assert (list(corrector.motion), list(corrector.gravity)) == fresh


def warming(corrector, first, end):
    """Feed a slow device at rest that warms by a degree a sample, its bias by ten LSB a degree.

    Returns what was left of the first axis' bias in each sample, LSB.
    """
    left, frame = [], array("i", [0] * 7)
    for degree in range(first, end):
        bias, dither = 10 * degree, degree % 3 - 1
        words = (3, dither, 16384, 100 * degree, bias + dither, dither - 300, 40 - dither)
        for i in range(7):
            frame[i] = words[i]
        corrector.update(frame, 15_000_000)
        left.append(frame[4] - dither)
    return left


def test_at_a_slow_rate_the_bias_follows_the_thermometer_at_every_sample():
    corrector = Corrector(Sensor(1 / 15, temp_lsb_per_degc=100.0))
    warming(corrector, 0, 40)
    corrector.power_on()
    # a window is four samples: the bias of its mean temperature would be up to 45 LSB late
    assert max(abs(lsb) for lsb in warming(corrector, 8, 30)) <= 2


@pytest.mark.parametrize("value", [-1.0, 1e300, 500000.0, float("nan"), float("inf")])
@pytest.mark.parametrize("name", sorted(DEFAULTS))
def test_a_setting_outside_of_its_range_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=f"{name} must be 0"):
        Corrector(**{name: value})
