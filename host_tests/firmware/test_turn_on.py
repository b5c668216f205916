"""How a power-on begins: with a first bias, and with an offset from the last one's curve."""

from array import array
from copy import deepcopy

import numpy as np
import pytest
from zerorate import Corrector, Sensor

from host_tests.firmware.played import LSB, play, rest

SENSOR = Sensor(odr_hz=10.0)
SLOPE_DPS, TURN_ON_DPS = 0.01, 0.2


def temperature_lsb(degc):
    return round((degc - SENSOR.temp_offset_degc) * SENSOR.temp_lsb_per_degc)


def power_on(corrector, degc, offset_dps, seed):
    """A session at rest through the temperatures `degc`, one a sample."""
    rng = np.random.default_rng(seed)
    corrector.power_on()
    for t in degc:
        rate = (offset_dps + SLOPE_DPS * (t - 30.0)) * SENSOR.gyro_lsb_per_dps
        gyro = np.round(rate + rng.normal(0, 4, 3)).astype(int)
        accel = np.round(rng.normal(0, 30, 3)).astype(int) + [0, 0, 16384]
        frame = array("i", [*accel.tolist(), temperature_lsb(t), *gyro.tolist()])
        corrector.update(frame, 100_000)


def first_bias_dps(corrector, degc):
    """What is subtracted from the very first sample of a power-on at that temperature."""
    corrector = deepcopy(corrector)
    corrector.power_on()
    frame = array("i", [0, 0, 16384, temperature_lsb(degc), 0, 0, 0])
    corrector.update(frame, 100_000)
    return corrector.bias_lsb(0) / SENSOR.gyro_lsb_per_dps


@pytest.fixture(scope="module")
def learned():
    """One power-on over 20..40 degC, then two of another offset that see the upper half only."""
    corrector = Corrector(SENSOR)
    power_on(corrector, np.linspace(20, 40, 4000), 0.0, 1)
    power_on(corrector, np.linspace(30, 40, 2000), TURN_ON_DPS, 2)
    power_on(corrector, np.linspace(40, 30, 2000), -TURN_ON_DPS, 3)
    return corrector


@pytest.mark.parametrize("degc", [25.0, 35.0, 39.0])
def test_turn_on_offsets_do_not_bend_the_curve(learned, degc):
    rise = first_bias_dps(learned, degc) - first_bias_dps(learned, 30.0)
    assert rise == pytest.approx(SLOPE_DPS * (degc - 30.0), abs=0.004)


def test_a_power_on_begins_nearer_to_the_last_one_than_to_the_first():
    corrector = Corrector(SENSOR)
    power_on(corrector, np.full(1500, 30.0), 0.0, 1)
    power_on(corrector, np.full(1500, 30.0), TURN_ON_DPS, 2)
    assert first_bias_dps(corrector, 30.0) == pytest.approx(TURN_ON_DPS / 2, abs=0.02)


def test_a_whole_power_on_is_corrected_by_its_own_offset(learned):
    learned = deepcopy(learned)
    power_on(learned, np.linspace(22, 30, 1200), TURN_ON_DPS, 4)
    assert learned.bias_lsb(0) / SENSOR.gyro_lsb_per_dps == pytest.approx(TURN_ON_DPS, abs=0.01)


@pytest.mark.parametrize("odr_hz", [25.0, 100.0, 200.0])
def test_the_very_first_bias_stands_while_it_is_being_learned(odr_hz):
    frames = rest(6, bias_dps=(1.5, -2.2, 0.7), odr_hz=odr_hz)
    corrector, outcome = play(frames, Corrector(Sensor(odr_hz=odr_hz)))
    bias = outcome.bias_q8 / 256
    known = np.maximum.accumulate(bias != 0)
    assert known[-1].all() and not known[0].any()
    assert np.abs(bias - np.array([1.5, -2.2, 0.7]) * LSB)[known].max() < 0.1 * LSB
