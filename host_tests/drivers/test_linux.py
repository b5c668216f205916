"""LinuxI2C reads and writes through smbus2's own messages, or by blocks where there is no more."""

import os
from array import array

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.smbus import SMBus
from zerorate_i2c.fifo import Fifo
from zerorate_i2c.linux import LinuxI2C
from zerorate_i2c.mpu6050 import MPU6050

from host_tests.drivers.linux_bus import machine
from host_tests.drivers.linux_bus.run import run_guest

pytest.importorskip("smbus2")


@pytest.fixture(params=[True, False], ids=["i2c_rdwr", "blocks"])
def smbus(request):
    chip = FakeMPU6050([[1, -2, 3, -4, 5, -6, row] for row in range(100)])
    bus = SMBus(FakeI2C(chip), raw_i2c=request.param)
    bus.chip = chip
    return bus


def test_the_driver_comes_up_and_reads(smbus):
    imu = MPU6050(LinuxI2C(smbus), clock=FakeClock())
    sample = array("i", [0] * 7)
    smbus.chip.step()
    imu.read(sample)
    assert list(sample) == [1, -2, 3, -4, 5, -6, 0]


def test_the_fifo_takes_batches_the_bus_can_carry(smbus):
    clock = FakeClock(smbus.chip)
    imu = MPU6050(LinuxI2C(smbus), clock=clock)
    fifo = Fifo(imu)
    sample = array("i", [0] * 7)
    clock.advance_us(80000)
    for _ in range(7):
        fifo.read(sample)
    assert fifo.frames == 7 and fifo.lost == 0


def test_a_read_too_long_for_blocks_is_refused():
    bus = LinuxI2C(SMBus(FakeI2C(FakeMPU6050()), raw_i2c=False))
    with pytest.raises(ValueError, match="32 bytes"):
        bus.readfrom_mem_into(0x68, 0x3B, bytearray(33))


def test_a_missing_device_file_is_an_os_error():
    with pytest.raises(OSError):
        LinuxI2C("/dev/i2c-of-no-machine")


@pytest.fixture
def found():
    if not os.environ.get("ZERORATE_REQUIRE_LINUX_BUS"):
        pytest.skip("it boots a Linux for a minute; ZERORATE_REQUIRE_LINUX_BUS=1 does so, as in CI")
    machine.fetch()
    return run_guest()


# One test: booting the machine takes a minute, and workers of pytest-xdist share no fixtures.
def test_a_real_kernels_bus_is_recorded_from_and_corrected_from(found):
    record = found["record"]
    assert record["rows"] == record["samples"] > 100
    assert record["false_rows"] == record["out_of_order"] == 0
    assert record["really_lost"] < record["rows"]
    assert record["said_lost"] == pytest.approx(record["really_lost"], abs=record["rows"] / 10)
    assert found["corrector"]["bias_lsb"][:2] == pytest.approx([44, -21], abs=1)
