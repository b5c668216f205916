"""Killed anywhere, a writer leaves the old or all of the new, a recorder all but two seconds."""

import sys

import pytest

if sys.platform == "win32":
    pytest.skip("processes fork and have limits there", allow_module_level=True)

from host_tests.tools.killed_recorders import MOST_S, trials
from host_tests.tools.killed_writers import Trials


def test_a_recorder_killed_at_a_random_moment_loses_two_seconds_at_most():
    fallen, most_s, ends = trials(24, seed=1)
    assert not fallen and most_s <= MOST_S
    assert ends["run"] >= 8 and ends["recovered"] >= 2


@pytest.mark.parametrize("name", ["CSV", "Parquet", "model", "simulate"])
def test_killed_at_each_rename_and_write_it_leaves_the_old_or_the_new_whole(tmp_path, name):
    done = Trials(name, tmp_path).all(sizes=3)
    assert done.tried >= 7 and not done.fallen
