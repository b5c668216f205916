"""Every intermediate result of every kernel fits 31 bits, whatever comes in."""

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate import settings as rest
from zerorate.ratio import Ratio
from zerorate_tools.layout import STATE
from zerorate_tools.replay.engines import others_of

from . import trace
from .checked import CheckedLibrary
from .sweep import attack
from .trace_on_host import corrector_for, frames


@pytest.fixture(scope="module")
def library():
    return CheckedLibrary()


def words(corrector):
    """The arrays of a corrector as the library takes them, the state first."""
    arrays = (corrector.state, corrector.settings, *others_of(corrector))
    return [None if part is None else np.array(part, np.int32) for part in arrays]


@pytest.mark.parametrize("mode", sorted(trace.MODES))
def test_no_result_leaves_31_bits_in_the_trace_that_covers_every_event(library, mode):
    arrays = words(corrector_for(mode))
    assert library.run(arrays, *frames(trace.UPDATES[mode])) == ""
    assert arrays[0][STATE.COUNTS] > 1500


def test_random_sensors_and_settings_of_the_documented_ranges_leave_31_bits_alone(library):
    found = [attack(library, number, rows=1500) for number in range(60)]
    assert [left for left in found if left] == []


# 806: a frame that is none, between what another source found and every reading, ended in a
# division by zero. The others: little gravity, few LSB of rate, a bias worth many readings.
@pytest.mark.parametrize("number", [520, 625, 696, 806, 1300])
def test_what_once_left_31_bits_fits(library, number):
    assert attack(library, number) == ""


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
