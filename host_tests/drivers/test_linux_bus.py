"""Driver, recorder and corrector on the I2C bus of a real Linux kernel, under QEMU."""

import os

import pytest
from zerorate_tools.errors import MissingRuntime

from host_tests.drivers.linux_bus import machine
from host_tests.drivers.linux_bus.run import run_guest


@pytest.fixture
def found():
    if os.environ.get("ZERORATE_REQUIRE_LINUX_BUS"):
        machine.fetch()
    try:
        return run_guest()
    except MissingRuntime as missing:
        pytest.skip(str(missing))


# One test: booting the machine takes a minute, and workers of pytest-xdist share no fixtures.
def test_a_real_kernels_bus_is_recorded_from_and_corrected_from(found):
    record = found["record"]
    assert record["rows"] == record["samples"] > 100
    assert record["false_rows"] == record["out_of_order"] == 0
    assert record["really_lost"] < record["rows"]
    assert record["said_lost"] == pytest.approx(record["really_lost"], abs=record["rows"] / 10)
    assert found["corrector"]["bias_lsb"][:2] == pytest.approx([44, -21], abs=1)
