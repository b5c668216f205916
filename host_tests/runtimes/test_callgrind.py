"""Counting instructions on the x86 interpreter."""

import pytest
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.runtimes.callgrind import instructions_per_item

EMPTY = "import sys\nfor i in range(int(sys.argv[1])):\n    {}\n"


@pytest.fixture
def per_item(find_runtime):
    runtime = find_runtime("x86")

    def count(body):
        try:
            return instructions_per_item(runtime, EMPTY.format(body), 100, 1100)
        except MissingRuntime as missing:
            pytest.skip(str(missing))

    return count


def test_more_work_costs_more_instructions(per_item):
    one, three = per_item("i + i"), per_item("i + i; i + i; i + i")
    assert 0 < one < three < 3 * one


def test_the_count_is_repeatable(per_item):
    assert abs(per_item("i + 1") - per_item("i + 1")) < 1


def test_a_script_that_fails_is_not_counted(per_item):
    with pytest.raises(ZerorateError, match="NameError"):
        per_item("absent")


def test_a_missing_valgrind_says_how_to_get_it(find_runtime, tmp_path, monkeypatch):
    x86 = find_runtime("x86")
    monkeypatch.setenv("ZERORATE_CACHE", str(tmp_path))
    with pytest.raises(MissingRuntime, match="zerorate runtimes get valgrind"):
        instructions_per_item(x86, EMPTY.format("pass"), 1, 2)
