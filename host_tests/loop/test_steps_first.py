"""When a step was, and which two are one."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.search import steps_first

from . import dense
from .selections import step

BLOCKS, TICKS = 60, np.arange(120)


def in_ticks(known, jump, **sources):
    """12 blocks of 10 ticks of 2 s, of which some are known; after a jump the bias is another."""
    level = (TICKS >= jump)[:, None] * np.array([1.0, -1.0, 0.0])
    ticks = np.where(known[:, None], level, np.nan)
    session = dense.white(4, 12)
    return replace(session, ticks_per_block=10, ticks_dps=ticks, sources=sources)


KNOWN, GAP = TICKS >= 0, (TICKS < 60) | (TICKS > 66)
STEP = step(6, (1.0, -1.0, 0.0), (0.1, 0.1, 1.0))


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
