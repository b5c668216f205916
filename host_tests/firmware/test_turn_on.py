"""How a power-on begins, what is published of one axis then, and how sure of it."""

from array import array
from copy import deepcopy
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate_tools.layout import AXIS, ESTIMATOR, SETTINGS, axis_at
from zerorate_tools.simulate.channels import flicker

from .played import DOCUMENT_MDPS, LEARNED_LSB, LSB, NOISE_LSB, READ_OUT_MDPS, play, rest
from .test_stillness import BIAS_DPS, handled, turning

SENSOR = Sensor(odr_hz=10.0)
SLOPE_DPS, TURN_ON_DPS = 0.01, 0.2


def temperature_lsb(degc):
    return round((degc - SENSOR.temp_offset_degc) * SENSOR.temp_lsb_per_degc)


def power_on(corrector, degc, offset_dps, seed):
    """A session at rest through the temperatures `degc`, one a sample."""
    corrector.power_on()
    frames = rest(len(degc) / SENSOR.odr_hz, seed, odr_hz=SENSOR.odr_hz)
    frames[:, 3] = [temperature_lsb(t) for t in degc]
    frames[:, 4:] += (offset_dps + SLOPE_DPS * (np.asarray(degc) - 30.0))[:, None] * LSB
    play(frames, corrector)


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
    # over seeds it spreads by 0.003; were the offsets in the curve it would be off by 0.15
    assert rise == pytest.approx(SLOPE_DPS * (degc - 30.0), abs=0.009)


def test_a_power_on_begins_nearer_to_the_last_one_than_to_the_first():
    corrector = Corrector(SENSOR)
    power_on(corrector, np.full(1500, 30.0), 0.0, 1)
    power_on(corrector, np.full(1500, 30.0), TURN_ON_DPS, 2)
    assert first_bias_dps(corrector, 30.0) == pytest.approx(TURN_ON_DPS / 2, abs=0.02)


def test_a_whole_power_on_is_corrected_by_its_own_offset(learned):
    learned = deepcopy(learned)
    power_on(learned, np.linspace(22, 30, 1200), TURN_ON_DPS, 4)
    assert learned.bias_lsb(0) / SENSOR.gyro_lsb_per_dps == pytest.approx(TURN_ON_DPS, abs=0.02)


@pytest.mark.parametrize("axis", range(3))
def test_a_jump_that_is_gone_at_the_next_power_on_is_in_no_curve(axis):
    # what had not jumped is believed at once, while the axis that had is held back
    corrector, jump_dps = Corrector(), 30.0 * np.eye(3)[axis]
    for bias_dps in (np.zeros(3), jump_dps, np.zeros(3)):
        corrector.power_on()
        play(rest(200, bias_dps=bias_dps), corrector)
    left = corrector.state[axis_at(corrector.settings, axis) + AXIS.OFFSET_Q8] / 256 / LSB
    assert left == pytest.approx(0, abs=0.03)


def test_a_bent_curve_is_foretold_below_all_that_was_seen():
    bend_dps = 0.001

    def curve(degc):
        return 0.5 + SLOPE_DPS * (degc - 30.0) + bend_dps * (degc - 30.0) ** 2

    warming = np.linspace(20, 45, 4000)
    frames = rest(400, bias_dps=(0, 0, 0), odr_hz=10.0)
    frames[:, 3] = [temperature_lsb(t) for t in warming]
    frames[:, 4:] += curve(warming)[:, None] * LSB
    corrector, _ = play(frames, Corrector(SENSOR))
    straight = curve(20.0) + (curve(22.0) - curve(20.0)) / 2 * -3
    assert first_bias_dps(corrector, 17.0) == pytest.approx(curve(17.0), abs=0.012)
    assert abs(straight - curve(17.0)) > 0.012


def test_the_noise_of_a_thermometer_hardly_reaches_the_bias():
    slope_dps, noise_degc = 0.06, 0.3
    warming = np.linspace(20, 32, 24000)
    frames = rest(240, odr_hz=100.0)
    read = warming + np.random.default_rng(3).normal(0, noise_degc, len(warming))
    frames[:, 3] = (read - SENSOR.temp_offset_degc) * SENSOR.temp_lsb_per_degc
    frames[:, 4:] += slope_dps * (warming - 25.0)[:, None] * LSB
    _, outcome = play(frames, Corrector(Sensor()))
    error = outcome.bias_q8 / 256 / LSB - slope_dps * (warming - 25.0)[:, None]
    # two windows of 32 readings of that thermometer differ by 4.5 mdps
    assert np.std(np.diff(error[12000::32], axis=0)) < 0.0025
    assert np.abs(error[12000:]).mean() < 0.004


@pytest.mark.parametrize("odr_hz", [25.0, 100.0, 200.0])
def test_the_very_first_bias_stands_while_it_is_being_learned(odr_hz):
    frames = rest(6, bias_dps=(1.5, -2.2, 0.7), odr_hz=odr_hz)
    corrector, outcome = play(frames, Corrector(Sensor(odr_hz=odr_hz)))
    bias = outcome.bias_q8 / 256
    known = np.maximum.accumulate(bias != 0)
    assert known[-1].all() and not known[0].any()
    assert np.abs(bias - np.array([1.5, -2.2, 0.7]) * LSB)[known].max() < 0.1 * LSB


READINGS = 30000
SEEDS = range(10)


def moving(kind, n, draw):
    """n readings of motion, LSB."""
    if kind == "uniform":
        return draw.uniform(-100 * LSB, 100 * LSB, n)
    if kind == "sinusoid":
        return 80 * LSB * np.sin(2 * np.pi * 1.3 * np.arange(n) / 100 + draw.uniform(0, 6))
    return draw.normal(0, 40 * LSB, n)


def interleaved(how, draw):
    """Which of the readings move: half of them, at random or in stretches of 10 s."""
    if how == "at random":
        return draw.permutation(READINGS) < READINGS // 2
    return np.arange(READINGS) // 1000 % 2 == 0


def errors_mdps(kind, how, **options):
    """(seeds x axes) error of the read-out of the any-temperature estimator, mdps."""
    errors = []
    bias_of_all = AXIS.ESTIMATORS + ESTIMATOR.EST_BIAS_Q8
    for seed in SEEDS:
        draw = np.random.default_rng(seed)
        truth = draw.uniform(-20, 20, 3) * LSB
        frames = rest(READINGS / 100, seed, truth / LSB)
        moves = interleaved(how, draw)
        for axis in range(3):
            frames[moves, 4 + axis] += moving(kind, moves.sum(), draw)
        corrector, _ = play(frames, **options)
        s, c = corrector.state, corrector.settings
        found = [s[axis_at(c, axis) + bias_of_all] / 256 for axis in range(3)]
        errors += list((np.array(found) - truth) * 1000 / LSB)
    return np.array(errors)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


cases = pytest.mark.parametrize("how", ["at random", "in stretches of 10 s"])
kinds = pytest.mark.parametrize("kind", ["uniform", "sinusoid", "Gaussian"])


@cases
@kinds
def test_half_of_the_readings_moving_leaves_no_more_than_the_target(kind, how, capsys):
    default = rms(errors_mdps(kind, how, every=True))
    with capsys.disabled():
        print(f"\nread-out, {kind}, {how}: {default:.2f} mdps rms")
    assert default <= READ_OUT_MDPS


def test_the_documents_rule_leaves_its_nine_mdps(capsys):
    literal = rms(errors_mdps("uniform", "at random", document=True))
    with capsys.disabled():
        print(f"\nread-out by the document, uniform, at random: {literal:.2f} mdps rms")
    least, most = DOCUMENT_MDPS
    assert least <= literal <= most


@pytest.mark.parametrize("bias_dps", [-40, -20, -3, 0, 3, 20, 40])
@pytest.mark.parametrize("rule", ["default", "document", "every"])
def test_a_bias_of_up_to_40_dps_is_learned(bias_dps, rule):
    options = {} if rule == "default" else {rule: True, "ignore_outside": False}
    corrector, _ = play(rest(30, 3, (bias_dps, -bias_dps, bias_dps)), **options)
    limit = 4 * NOISE_LSB if rule == "document" else LEARNED_LSB
    for axis, sign in enumerate((1, -1, 1)):
        assert corrector.source(axis) > 0
        assert corrector.bias_lsb(axis) == pytest.approx(sign * bias_dps * LSB, abs=limit)


@pytest.mark.parametrize(("beyond", "share"), [(-1, 2), (0, 1)])
@pytest.mark.parametrize("sign", [-1, 1])
def test_of_an_offset_within_the_gate_half_is_kept_and_of_a_jump_all(beyond, share, sign):
    corrector = Corrector()
    offset = sign * ((corrector.settings[SETTINGS.GATE_Q4] + beyond) << 4)
    at = axis_at(corrector.settings, 1) + AXIS.OFFSET_Q8
    corrector.state[at] = offset
    corrector.power_on(same=True)
    assert corrector.state[at] == offset
    corrector.power_on()
    assert corrector.state[at] == offset // share


def test_what_is_saved_and_held_back_is_explained_in_numbers():
    corrector = Corrector(Sensor(odr_hz=200.0))
    corrector.schedule = SimpleNamespace(saves=3, postponed=0, longest_us=45_000)
    corrector.state[axis_at(corrector.settings, 2) + AXIS.SUSPECT] = 7
    said = corrector.explain()
    insist = corrector.settings[SETTINGS.INSIST]
    assert f"held back (7 of {insist})" in said and said.count("held back") == 1
    assert "Saved 3 times, for 45 ms at the longest: 9 samples pass" in said


def quality_dps(corrector, axis=0):
    return corrector.quality_lsb(axis) / LSB


def first_quality_dps(corrector):
    """One sigma at the very first sample of another power-on."""
    corrector = deepcopy(corrector)
    corrector.power_on()
    play(rest(0.01), corrector)
    return quality_dps(corrector)


@pytest.mark.parametrize("spread_dps", [0.0, 0.06])
def test_a_power_on_begins_as_sure_as_this_part_repeats(spread_dps):
    corrector, _ = play(rest(60))
    assert first_quality_dps(corrector) == pytest.approx(0.02, rel=0.1)  # that of any part
    for seed in range(1, 11):
        corrector.power_on()
        play(rest(30, seed, spread_dps * (-1) ** seed * np.ones(3)), corrector)
    if spread_dps:  # half of the last one's offset is kept, so it is off by one and a half times
        assert 0.06 < first_quality_dps(corrector) < 0.12
    else:
        assert first_quality_dps(corrector) < 0.007


def test_what_a_restarted_program_knew_of_a_chip_under_power_is_as_sure_as_it_was():
    corrector, _ = play(rest(30))
    before = quality_dps(corrector)
    corrector.power_on(same=True)
    play(rest(0.01), corrector)
    assert quality_dps(corrector) < before + 0.001


def with_flicker_noise(frames, dps):
    noisy = frames.copy()
    noisy[:, 4:] += LSB * flicker(np.random.default_rng(1), len(frames), 0.01, np.full(3, dps))
    return noisy


def without_doubt(frames, corrector=None):
    """The corrector after the frames, told at last that none of it was a turn."""
    corrector, _ = play(frames, corrector)
    for axis in range(3):
        corrector.state[axis_at(corrector.settings, axis) + AXIS.DOUBT_Q4] = 0
    return play(frames[-30:], corrector)[0]


def mean_quality_dps(frames):
    corrector = without_doubt(frames)
    return np.mean([quality_dps(corrector, axis) for axis in range(3)])


def test_a_minute_of_rest_shows_whether_there_is_flicker_noise():
    frames = rest(60, bias_dps=BIAS_DPS)
    assert mean_quality_dps(frames) < 0.0038
    assert mean_quality_dps(with_flicker_noise(frames, 0.006)) > 0.0085


def test_rests_of_a_second_too_short_for_two_segments_show_it_as_well():
    parts = [f for n in range(40) for f in (handled(9, n), rest(1.1, 99 + n, BIAS_DPS))]
    frames = np.concatenate([rest(2.6, bias_dps=BIAS_DPS), *parts])
    assert mean_quality_dps(frames) < 0.007
    assert mean_quality_dps(with_flicker_noise(frames, 0.006)) > 0.0085


@pytest.mark.parametrize(("hz", "octaves"), [(25.0, 6), (100.0, 8), (400.0, 10)])
def test_each_octave_of_flicker_noise_within_a_segment_adds_half_of_what_segments_show(hz, octaves):
    flickering, without = (
        without_doubt(rest(4, odr_hz=hz), Corrector(Sensor(odr_hz=hz), floor_dps=floor))
        for floor in (0.02, 0.0)
    )
    added = quality_dps(flickering) ** 2 - quality_dps(without) ** 2
    assert 0.02**2 * octaves / 2 < added < 0.02**2 * (octaves / 2 + 1)


def test_a_bias_that_insisted_may_be_a_turn_until_a_rest_of_ten_minutes_shows_none():
    corrector, _ = play(turning(0, 30, axis=2))
    play(turning(1, 120, axis=2, seed=2), corrector)
    assert corrector.bias_lsb(2) == pytest.approx(1.2 * LSB, abs=2)
    assert quality_dps(corrector, 2) > 0.5  # all of the turn is within two sigma
    play(turning(1, 600, axis=2, seed=3), corrector)
    assert quality_dps(corrector, 2) < 0.02


def posed(axis, seconds, seed):
    """A rest with that axis up."""
    frames = rest(seconds, seed, BIAS_DPS)
    frames[:, [axis, 2]] = frames[:, [2, axis]]
    return frames


def test_a_cold_part_is_unsure_along_gravity_until_it_has_rested_in_two_poses():
    corrector, _ = play(rest(5, bias_dps=BIAS_DPS))
    assert quality_dps(corrector, 2) > 0.9 > 0.06 > quality_dps(corrector, 0)
    play(np.concatenate([handled(4, 1), posed(0, 30, 2)]), corrector)
    assert quality_dps(corrector, 2) < 0.02


def test_a_rest_that_agrees_after_a_power_off_was_no_turn():
    corrector, _ = play(rest(60, bias_dps=BIAS_DPS))
    corrector.power_on()
    play(rest(10, 2, BIAS_DPS), corrector)
    assert quality_dps(corrector, 2) < 0.02
