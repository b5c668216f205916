"""Every intermediate result of every kernel fits 31 bits, whatever comes in."""

import random

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate import settings as rest
from zerorate.ratio import Ratio
from zerorate_tools.layout import SETTINGS, STATE
from zerorate_tools.replay.engines import others_of

from . import trace
from .checked import MOST, OutOf31Bits, Words, checked
from .checked_c import CheckedLibrary
from .sweep import attack
from .trace_on_host import corrector_for, frames

RAIL = 32767

SENSORS = {
    "MPU-6050": Sensor(),
    "2000 dps": Sensor(1000.0, 16.4, 2048.0, 340.0, 36.53),
    "one sample in 15 s": Sensor(1 / 15, 1000.0, 0.0, 100.0, 0.0),
    "1 kHz": Sensor(1000.0, 131.0, 16384.0, 333.87, 21.0),
    "8 kHz": Sensor(8000.0, 8000.0, 32768.0, 2000.0, 0.0),
    "least of all": Sensor(0.01, 1.0, 1.0, 1.0, 0.0),
    "finest of the slow": Sensor(1, 8000, 16384, 340, 36.53),
    "gyroscope alone": Sensor(100.0, 131.0, 0.0, 0.0, 0.0),
}
MODES = {
    "default": {},
    "every": {"every": True},
    "document": {"document": True},
    "document, many": {"document": True, "bins": 19, "short": 6, "long": 12},
    "few": {"bins": 4, "short": 1, "long": 1, "ignore_outside": True},
}


def around(centre, noise):
    def make(n, pick):
        return [centre + pick.randint(-noise, noise) if noise else centre for _ in range(3)]

    return make


def alternating(n, pick):
    return [(RAIL if n & 1 else -RAIL) - pick.randint(0, 1)] * 3


def anything(n, pick):
    return [pick.randint(-32768, 32767) for _ in range(3)]


def climbing(n, pick):
    return [max(-RAIL, min(RAIL, (n * 37) % 65536 - 32768))] * 3


def stepping(n, pick):
    return [(RAIL - 60) * (1 if n // 700 & 1 else -1) + pick.randint(-9, 9) for _ in range(3)]


SIGNALS = {
    "+40 dps": around(5240, 12),
    "-40 dps": around(-5240, 12),
    "just below the rail": around(RAIL - 13, 12),
    "just above the lower rail": around(-RAIL + 13, 12),
    "frozen but for the temperature": around(-RAIL, 0),
    "from rail to rail": alternating,
    "anything": anything,
    "climbing": climbing,
    "stepping from end to end": stepping,
}


def temperatures(n, pick):
    """Whole range of 16 bits in sweeps of steps just below a jump, some of them."""
    step = 390 * (n // 97)
    return max(
        -32768, min(32767, (step % 131072 if step % 131072 < 65536 else -step % 65536) - 32768)
    )


def hostile(signal, updates, leap_us, seed=1):
    """(frames, dt_us): hostile frames at hostile times."""
    pick = random.Random(seed)
    period_us = max(2, min(900000000, leap_us // 10))
    rows, dt_us = [], []
    for n in range(updates):
        accel = [pick.randint(-9, 9), 0, RAIL if n % 501 == 500 else 16384]
        rows.append([*accel, temperatures(n, pick), *signal(n, pick)])
        hostile_us = [0, -1, 1 << 29, -(1 << 29), MOST >> 1]
        dt_us.append(pick.choice(hostile_us) if n % 331 == 330 else period_us)
    return rows, dt_us


@pytest.fixture(scope="module")
def library():
    return CheckedLibrary()


def words(corrector):
    """The arrays of a corrector as the library takes them, the state first."""
    arrays = (corrector.state, corrector.settings, *others_of(corrector))
    return [None if part is None else np.array(part, np.int32) for part in arrays]


def test_no_result_leaves_31_bits(library):
    # windows as short as they come, so that few updates learn, evict and fit
    for sensor in SENSORS:
        signals = {}
        for mode in MODES:
            arrays = words(Corrector(SENSORS[sensor], window_s=0.0001, **MODES[mode]))
            for name, signal in SIGNALS.items():
                if name not in signals:
                    signals[name] = hostile(signal, 150, int(arrays[1][SETTINGS.LEAP_US]))
                assert library.run(arrays, *signals[name]) == "", (sensor, mode, name)
            assert arrays[0][STATE.COUNTS] > 800


@pytest.mark.parametrize("signal", ["just below the rail", "anything"])
def test_no_result_leaves_31_bits_in_the_longest_windows(library, signal):
    arrays = words(Corrector(SENSORS["8 kHz"]))
    leap_us = int(arrays[1][SETTINGS.LEAP_US])
    assert library.run(arrays, *hostile(SIGNALS[signal], 1400, leap_us)) == ""
    assert arrays[1][SETTINGS.WINDOW] == 256


@pytest.mark.parametrize("mode", sorted(trace.MODES))
def test_no_result_leaves_31_bits_in_the_trace_that_covers_every_event(library, mode):
    arrays = words(corrector_for(mode))
    assert library.run(arrays, *frames(trace.UPDATES[mode])) == ""
    assert arrays[0][STATE.COUNTS] > 1500


def test_random_sensors_and_settings_of_the_documented_ranges_leave_31_bits_alone(library):
    found = [attack(library, number, rows=1500) for number in range(60)]
    assert [left for left in found if left] == []


def test_what_another_source_found_and_every_reading_are_learned_one_by_one(library):
    # a frame that is none between them ended in a division by zero
    assert attack(library, 806) == ""


@pytest.mark.parametrize("number", [520, 625, 696, 1300])
def test_little_gravity_few_lsb_of_rate_and_a_bias_worth_many_readings_fit(library, number):
    assert attack(library, number) == ""


@pytest.mark.parametrize(
    "beyond",
    [
        lambda a: a + 1,
        lambda a: -2 - a,
        lambda a: 3 * a >> 2,
        lambda a: a << 1,
        lambda a: 1 << a,
        lambda a: 1 // (a - MOST),
        lambda a: Words([0]).__setitem__(0, int(a) + 1),
    ],
)
def test_the_checking_integer_finds(beyond):
    with pytest.raises(OutOf31Bits):
        beyond(checked(MOST))


OPERATIONS = ["a + b", "a - b", "a * b", "a << b", "a >> b", "a // b", "a % b", "-a", "~a", "a ^ b"]
VALUES = [0, 1, -1, 2, 30, 31, 0x7FFF, 0x8000, MOST >> 1, MOST, -MOST, -MOST - 1]
KERNELS = [f"def op_{i}(a: int, b: int) -> int:\n    return {o}" for i, o in enumerate(OPERATIONS)]
ASKED = [f"ask_{i}(int32_t a, int32_t b) {{ ASK({i}); }}" for i in range(len(OPERATIONS))]
ASK = "#define ASK(i) return setjmp(escape) ? 0 : tried_op_##i(a, b)"
SHOWN = '__attribute__((visibility("default"))) int32_t '


def test_c_that_minds_31_bits_says_what_the_checking_integer_says(tmp_path):
    (tmp_path / "tried.py").write_text("\n\n".join(KERNELS), encoding="utf-8")
    entries = [("tried", f"op_{i}") for i in range(len(OPERATIONS))]
    behind = "\n".join([ASK, *(SHOWN + asked for asked in ASKED)])
    tried = CheckedLibrary(tmp_path, entries, behind)
    for i, operation in enumerate(OPERATIONS):
        for a in VALUES:
            for b in VALUES:
                tried.allow(10)
                result = getattr(tried.functions, f"ask_{i}")(a, b)
                try:
                    said = int(eval(operation, {"a": checked(a), "b": checked(b)}))
                except OutOf31Bits:
                    said = None
                assert (None if tried.left() else result) == said, (operation, a, b)


RATES_HZ = [4.0, 12.5, 100.0, 1000 / 7, 1000.0]
GYRO_LSB_PER_DPS = [131.0, 65.5, 32.8, 16.4]
SCALES = [(16384.0, 340.0), (8192.0, 326.8), (4096.0, 333.87), (2048.0, 0.0)]


def single(value):
    """As most boards have it, of 24 bits."""
    return float(np.float32(value))


def shorter(value):
    """As MicroPython has it where a float is part of a word: its last two bits are cut off."""
    return float((np.float32(value).view(np.uint32) & np.uint32(0xFFFFFFFC)).view(np.float32))


def made(width, odr_hz, gyro, accel, temp):
    """All settings of a corrector, its sensor's scales of that width."""
    c = Corrector(Sensor(width(odr_hz), width(gyro), width(accel), width(temp), 36.53))
    return c.settings, c.motion_settings, c.gravity_settings, c.state


@pytest.mark.parametrize("width", [single, shorter])
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_every_range_and_rate_gives_the_same_integers(monkeypatch, width, odr_hz):
    for gyro in GYRO_LSB_PER_DPS:
        for scales in SCALES:
            wide = made(float, odr_hz, gyro, *scales)
            with monkeypatch.context() as patch:
                for name, value in rest.DEFAULTS.items():
                    patch.setitem(rest.DEFAULTS, name, width(value))
                assert made(width, odr_hz, gyro, *scales) == wide


@pytest.mark.parametrize("value", [0.0001, 0.0174533, 0.3, 36.53, 333.87, 1000 / 7, 32768.0])
def test_a_float_counts_to_six_digits(value):
    found = Ratio(value)
    assert found.over / found.under == pytest.approx(value, rel=5e-6)
    assert (found.over, found.under) == (Ratio(single(value)).over, Ratio(single(value)).under)
