"""Lines of all recordings together: slow ones of ticks at rest, quick ones of samples."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.read.lines import Line, Spectrum
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.search import periodic
from zerorate_tools.model.term import Term

AT = np.arange(2000.0)
WAVE = np.sin(2 * np.pi * AT / 50)
NO_TERMS = [], np.zeros((0, 3))
FOLLOWS = [Term("temp", centre=25.0)], np.full((1, 3), 4e-3)


def noise(wave_dps):
    """Four recordings of a tick a second, with a wave in their rates and their temperature."""
    made = []
    for k in range(4):
        rate = np.random.default_rng(k).normal(0, 1e-3, (2000, 3)) + wave_dps * WAVE[:, None]
        blocks = rate.reshape(-1, 20, 3).mean(axis=1)
        sources = {"temp": 25 + WAVE}
        made.append(Session(str(k), 20.0, 20, blocks, np.ones(100), sources, ticks_dps=rate))
    return made


def lines(made, terms=NO_TERMS):
    """Those found where the last recording is held out."""
    return periodic.periodic(made[:-1], made[-1:], *terms)


@pytest.mark.parametrize(
    ("quick", "slow", "same"),
    [
        *((10.1, 0.1, True), (9.9, 0.1, True), (10.1, 0.13, False)),
        *((10.5, 0.5, True), (10.1, 0.119, True)),
    ],
)
def test_a_slow_line_may_be_a_quick_one_as_ticks_show_it(quick, slow, same):
    both = [Line(hz, np.ones(3), 1e-9, True) for hz in (quick, slow)]
    assert periodic._folds(*both, 1.0, 0.02) is same


def test_a_line_in_ticks_is_found_with_its_period():
    (line,) = lines(noise(4e-3))
    assert line.hz == pytest.approx(1 / 50, rel=0.03) and line.in_holdout


@pytest.mark.parametrize(
    ("moving", "ticks", "found"), [(190, 2000, True), (210, 2000, False), (0, 380, False)]
)
def test_a_line_takes_enough_ticks_at_rest(moving, ticks, found):
    made = [replace(s, ticks_dps=s.ticks_dps[:ticks].copy()) for s in noise(4e-3)]
    made[0].ticks_dps[:moving] = np.nan
    assert bool(lines(made)) is found
    assert lines([replace(s, ticks_dps=None) for s in made]) == []


def test_a_line_that_a_term_explains_is_none_and_one_that_it_makes_is_none():
    assert lines(noise(4e-3), FOLLOWS) == []
    assert lines(noise(0.0), FOLLOWS) == []


def test_quick_lines_are_of_the_samples_where_all_recordings_have_them_alike():
    def loud(step_hz):
        power = np.ones((200, 3))
        power[40] += 100.0
        welch = Spectrum(power, step_hz, 50.0)
        return Session("x", 20.0, 1, np.zeros((9, 3)), np.ones(9), {}, welch=welch)

    (line,) = lines([loud(0.1), loud(0.1), loud(0.1)])
    assert line.hz == pytest.approx(4.0) and line.in_holdout
    assert lines([loud(0.1), loud(0.1), loud(0.2)]) == []
    assert lines([loud(0.1), loud(0.1), replace(loud(0.1), welch=None)]) == []
    assert lines([loud(0.01), loud(0.01), loud(0.01)]) == []  # ticks show what is so slow
