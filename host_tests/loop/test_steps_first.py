"""Which steps are taken out of a session, when they were, and what else was seen then."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search import steps_first
from zerorate_tools.model.term import Term

from . import dense
from .selections import step

BLOCKS, TICKS = 60, np.arange(120)


@pytest.mark.parametrize(
    ("degc", "beside", "reading_degc", "explained"),
    [
        *((0.4, 0.99, 0.5, True), (-0.4, 0.99, 0.5, True), (0.4, 1.01, 0.5, False)),
        *((0.4, 0.99, None, False), (0.5 + 0.99, 0.0, 0.5, True), (0.5 + 1.01, 0.0, 0.5, False)),
        *((-0.5 - 0.99, 0.0, 0.5, True), (-0.5 - 1.01, 0.0, 0.5, False)),
    ],
)
@pytest.mark.parametrize("block", [37, BLOCKS])
def test_a_step_that_a_reading_of_the_thermometer_explains_is_none(
    block, degc, beside, reading_degc, explained
):
    temp = 25 + 9 * np.sin(np.arange(BLOCKS) / 9)
    session = replace(dense.white(4, BLOCKS, temp=temp), temp_step_degc=reading_degc)
    session.rate_dps += np.outer(temp, [3.0, -2.0, 1.0])
    regression, late = Regression([session]), {Term("temp", lag_s=45.0, lag_mode="lag"): 9.0}
    line, bend = steps_first.bend_of(session)
    with regression.shrinking(late):
        own, squares, lagged = regression.fit([line, bend, *late]).coefficients
    warm = temp[min(block, BLOCKS - 1)]
    slope = own + 2 * (warm - temp.mean()) * squares
    slope += lagged * 45.0 / 20.0 * (1 - np.exp(-20.0 / 45.0))
    deviation = np.array([0.3, 0.2, 0.5])
    deviation *= np.linalg.norm(slope / deviation) / np.sqrt(chi2.isf(1e-3, 2))  # of 1 degC
    aside = np.array([1.0, 0.0, -slope[0] / deviation[0] / (slope[2] / deviation[2])])
    aside *= deviation * np.sqrt(chi2.isf(1e-3, 2)) / np.linalg.norm(aside)
    one = step(block, degc * slope + beside * aside, deviation)
    assert steps_first._is_thermometers(regression, [line, bend], late, one) is explained
    blind = Regression([dense.white(4, BLOCKS)])
    assert not steps_first._is_thermometers(blind, [], {}, one)


def in_ticks(known, jump, **sources):
    """12 blocks of 10 ticks of 2 s, of which some are known; after a jump the bias is another."""
    level = (TICKS >= jump)[:, None] * np.array([1.0, -1.0, 0.0])
    ticks = np.where(known[:, None], level, np.nan)
    session = dense.white(4, 12)
    return replace(session, ticks_per_block=10, ticks_dps=ticks, sources=sources)


KNOWN, GAP = TICKS >= 0, (TICKS < 60) | (TICKS > 66)
STEP = step(6, (1.0, -1.0, 0.0), (0.1, 0.1, 1.0))


def test_of_several_steps_each_is_timed_without_the_others_and_all_are_taken_out():
    sizes = [(1.0, -1.0, 0.0), (0.5, 2.0, 1.0), (-2.0, 0.5, 1.0)]
    steps = [step(block, size, [0.1] * 3) for block, size in zip((3, 6, 9), sizes)]
    level = sum(np.outer(TICKS >= at, size) for at, size in zip((33, 64, 91), sizes))
    session = replace(in_ticks(KNOWN, 0), ticks_dps=level)
    plain = session.rate_dps.copy()
    session.rate_dps += level.reshape(12, 10, 3).mean(axis=1)
    less = steps_first._less(session, steps)
    assert [s.at_s for s in less.steps] == [66.0, 128.0, 182.0]
    assert less.ticks_dps == pytest.approx(np.zeros((120, 3)))
    assert less.rate_dps == pytest.approx(plain)


# of what shakes within a tick, squares
SHAKEN = np.where(TICKS == 64, 0.01, 0.0009)


@pytest.mark.parametrize(
    ("known", "force", "vib", "at_s", "seen"),
    [
        (GAP, (TICKS > 68) * 0.5, 0 * SHAKEN, 138.0, "0.87 g"),
        (KNOWN, 0.0 * TICKS, SHAKEN, 128.0, "0.07 g"),
    ],
)
def test_a_knock_within_its_ticks_has_the_step_s_moment(known, force, vib, at_s, seen):
    session = in_ticks(known, 63, vib=vib, **{f"acc_{axis}": force for axis in "xyz"})
    told = steps_first._timed(session, STEP, np.zeros((120, 3)))
    assert told.at_s == at_s and seen in told.said


@pytest.mark.parametrize(
    ("second", "sign", "listed"), [(31, 1, [2.0]), (31, -1, [1.0, -1.0]), (32, 1, [1.0, 1.0])]
)
def test_a_step_that_two_blocks_in_turn_show_is_one(answers, second, sign, listed):
    one, two = step(30, deviation_dps=[0.3] * 3), step(second, [sign] * 3, [0.4] * 3)
    answers(steps_first, hold_disturbed=None, steps_and_lags=([two, one], {}))
    found = steps_first._steps(dense.white(4, BLOCKS), 1)
    assert [s.size_dps.tolist() for s in found] == [[size] * 3 for size in listed]
    assert found[0].block == 30
    assert found[0].deviation_dps == pytest.approx([0.5 if len(listed) == 1 else 0.3] * 3)
