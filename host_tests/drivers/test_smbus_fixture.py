"""The fixture smbus reaches a program however that program imports smbus2."""

from threading import Thread

import pytest
import smbus2
from smbus2 import SMBus  # as applications do, before any test has begun
from zerorate_fakes import Physical

_ADDRESS, _WHO_AM_I, _MPU6050 = 0x68, 0x75, 0x68


def test_a_class_imported_before_the_test_opens_the_fake(smbus):
    with SMBus(1) as bus:
        assert bus.read_byte_data(_ADDRESS, _WHO_AM_I) == _MPU6050


def test_a_class_imported_within_the_test_opens_the_fake(smbus):
    from smbus2 import SMBus as late

    assert late(1).read_byte_data(_ADDRESS, _WHO_AM_I) == _MPU6050


def test_the_module_opens_the_fake(smbus):
    assert smbus2.SMBus(1).read_i2c_block_data(_ADDRESS, _WHO_AM_I, 1) == [_MPU6050]


def test_a_later_test_without_the_fixture_has_the_real_class():
    with pytest.raises(OSError, match="No such file"):
        SMBus(1999)


@pytest.mark.imu(part="MPU-6500")
def test_the_next_test_has_its_own_chip(smbus):
    assert SMBus(1).read_byte_data(_ADDRESS, _WHO_AM_I) == 0x70


def test_a_rate_of_two_axes_is_refused():
    with pytest.raises(ValueError, match="gyro_dps has 2 values; give three"):
        Physical(gyro_dps=(1, 2))


def test_a_thread_s_transfer_waits_for_the_end_of_another_s(imu_bus, smbus):
    other = Thread(target=smbus.read_byte_data, args=(_ADDRESS, _WHO_AM_I))

    def in_the_middle(place):
        imu_bus.between_bytes = None
        other.start()
        other.join(0.05)

    smbus.write_byte_data(_ADDRESS, 0x1A, 3)
    imu_bus.between_bytes = in_the_middle
    assert smbus.read_i2c_block_data(_ADDRESS, 0x19, 2) == [0, 3]
    other.join()
