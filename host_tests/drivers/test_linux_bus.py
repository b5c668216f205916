"""Driver, recorder and corrector on the I2C bus of a real Linux kernel, under QEMU."""

import os

import pytest
from zerorate_tools.errors import MissingRuntime

from host_tests.drivers.linux_bus import machine
from host_tests.drivers.linux_bus.run import run_guest


@pytest.fixture(scope="module")
def found():
    if os.environ.get("ZERORATE_REQUIRE_LINUX_BUS"):
        machine.fetch()
    try:
        return run_guest()
    except MissingRuntime as missing:
        pytest.skip(str(missing))


def test_every_row_recorded_is_a_sample_played_and_in_order(found):
    record = found["record"]
    assert record["rows"] == record["samples"] > 100
    assert record["false_rows"] == record["out_of_order"] == 0


def test_the_samples_lost_are_counted(found):
    record = found["record"]
    assert record["really_lost"] < record["rows"] / 4
    assert record["said_lost"] == pytest.approx(record["really_lost"], abs=record["rows"] / 20)


def test_the_corrector_learns_the_bias_played(found):
    assert found["corrector"]["bias_lsb"][:2] == pytest.approx([44, -21], abs=1)
