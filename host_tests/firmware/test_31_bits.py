"""Every intermediate result of every kernel fits 31 bits, whatever comes in."""

import random

import pytest
from zerorate import Sensor
from zerorate.layout import GUARD, SETTINGS, STATE

from . import trace
from .checked import I31, MOST, CheckedCorrector, OutOf31Bits, Words, checked
from .trace_on_host import frames

RAIL = 32767
GOOD = 8  # word of the state: good frames, then those of each fault

SENSORS = {
    "MPU-6050": Sensor(),
    "2000 dps": Sensor(1000.0, 16.4, 2048.0, 340.0, 36.53),
    "one sample in 15 s": Sensor(1 / 15, 1000.0, 0.0, 100.0, 0.0),
    "1 kHz": Sensor(1000.0, 131.0, 16384.0, 333.87, 21.0),
    "8 kHz": Sensor(8000.0, 8000.0, 32768.0, 2000.0, 0.0),
    "least of all": Sensor(0.01, 1.0, 1.0, 1.0, 0.0),
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


def drive(corrector, signal, updates, seed=1):
    """Give it `updates` hostile frames at hostile times."""
    pick = random.Random(seed)
    period_us = max(2, min(900000000, int(corrector.settings[1]) // 10))
    for n in range(updates):
        accel = [pick.randint(-9, 9), 0, RAIL if n % 501 == 500 else 16384]
        frame = [*accel, temperatures(n, pick), *signal(n, pick)]
        dt_us = period_us
        if n % 331 == 330:
            dt_us = pick.choice([0, -1, 1 << 29, -(1 << 29), MOST >> 1])
        corrector.update(frame, dt_us)


@pytest.mark.parametrize("mode", sorted(MODES))
@pytest.mark.parametrize("sensor", sorted(SENSORS))
def test_no_result_leaves_31_bits(sensor, mode):
    # windows as short as they come, so that few updates learn, evict and fit
    corrector = CheckedCorrector(SENSORS[sensor], window_s=0.0001, **MODES[mode])
    for name, signal in SIGNALS.items():
        try:
            drive(corrector, signal, 90)
        except OutOf31Bits as error:
            raise AssertionError(f"{name}: {error}") from error
    assert int(corrector.state[STATE.COUNTS]) > 500


@pytest.mark.parametrize("signal", ["just below the rail", "anything"])
def test_no_result_leaves_31_bits_in_the_longest_windows(signal):
    corrector = CheckedCorrector(SENSORS["8 kHz"])
    drive(corrector, SIGNALS[signal], 1400)
    assert corrector.settings[SETTINGS.WINDOW] == 256


@pytest.mark.parametrize("mode", sorted(trace.MODES))
def test_no_result_leaves_31_bits_in_the_trace_that_covers_every_event(mode):
    corrector = CheckedCorrector(Sensor(*trace.SENSOR), **trace.LIMITS, **trace.MODES[mode])
    rows, dt_us = frames(min(6000, trace.UPDATES[mode]))
    for row, since in zip(rows.tolist(), dt_us.tolist()):
        corrector.update(row, since)
    assert int(corrector.state[STATE.COUNTS]) > 1900


def test_an_hour_of_repeated_frames_leaves_31_bits_alone():
    corrector = CheckedCorrector(SENSORS["MPU-6050"])
    for _ in range(400):
        corrector.update([1, 2, 16384, 3, 4, 5, 6], 9000000 // 100)
        corrector.update([1, 2, 16384, 3, 4, 5, 6], 9000000)
    assert int(corrector.state[STATE.COUNTS + GUARD.REPEAT]) > 390


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


def test_the_checking_integer_stays_one_through_plain_ones():
    assert all(isinstance(v, I31) for v in (1 + checked(2), checked(2) >> 1, -checked(2)))
