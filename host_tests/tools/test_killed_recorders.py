"""Recorders that are killed lose two seconds at most, and harm no older file."""

import sys

import pytest

if sys.platform == "win32":
    pytest.skip("processes fork and have limits there", allow_module_level=True)

from host_tests.tools.killed_recorders import MOST_S, trials


def test_a_recorder_killed_at_a_random_moment_loses_two_seconds_at_most():
    fallen, most_s, ends = trials(24, seed=1)
    assert not fallen and most_s <= MOST_S
    assert ends["run"] >= 8 and ends["recovered"] >= 2
