"""Killed anywhere, a writer leaves what was there or all that it wrote."""

import sys

import pytest

if sys.platform == "win32":
    pytest.skip("processes fork and have limits there", allow_module_level=True)

from host_tests.tools.killed_writers import Trials


@pytest.mark.parametrize("name", ["CSV", "Parquet", "model", "simulate"])
def test_killed_at_each_rename_and_write_it_leaves_the_old_or_the_new_whole(tmp_path, name):
    done = Trials(name, tmp_path).all(sizes=3)
    assert done.tried >= 7 and not done.fallen
