"""The fake bus from its four sides, under published drivers, and as the fixture smbus."""

import importlib.util
import inspect
import re
import sys
import types
from math import radians
from pathlib import Path
from threading import Thread

import pytest
import smbus2
from smbus2 import SMBus as RealSMBus
from smbus2 import i2c_msg
from zerorate_fakes import FakeI2C, FakeMPU6050, Physical
from zerorate_fakes.circuitpython import CircuitPythonI2C
from zerorate_fakes.pytest_plugin import chip_as_marked
from zerorate_fakes.smbus import SMBus

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = Path(__file__).parent / "on_micropython"
MODULES = [ROOT / "drivers", ROOT / "host_tests" / "fakes"]
SAMPLE = [[1, 2, 3, 4, 5, 6, 7]]
WHO_AM_I = 0x75


@pytest.fixture
def bus():
    chip = FakeMPU6050(SAMPLE)
    chip.write(0x6B, 1)
    chip.step()
    return FakeI2C({0x69: chip})


def test_machine_i2c_scans_and_goes_on_from_the_register_of_the_last_transfer(bus):
    assert bus.scan() == [0x69]
    assert bus.writeto(0x69, b"\x43") == 1
    assert bus.readfrom(0x69, 2) == b"\x00\x05"
    assert bus.readfrom(0x69, 4) == b"\x00\x06\x00\x07"
    assert bus.writevto(0x69, (b"\x19", b"\x07\x03")) == 3
    assert bus.readfrom_mem(0x69, 0x19, 2) == b"\x07\x03"


def test_a_bus_that_hangs_ends_in_a_time_out(bus):
    bus.fault("hang")
    with pytest.raises(OSError) as error:
        bus.readfrom_mem(0x69, WHO_AM_I, 1)
    assert error.value.errno == 110


def test_the_smbus_has_every_method_of_smbus2():
    for name, theirs in inspect.getmembers(RealSMBus, inspect.isfunction):
        if not name.startswith("_"):
            parameters = [*inspect.signature(theirs).parameters]
            assert [*inspect.signature(getattr(SMBus, name)).parameters] == parameters, name


def test_an_smbus_transfers_bytes_words_and_messages(bus):
    with SMBus(bus) as smbus:
        smbus.write_byte(0x69, 0x43)
        assert [smbus.read_byte(0x69), smbus.read_byte(0x69)] == [0, 5]
        smbus.write_word_data(0x69, 0x19, 0x0307)
        assert smbus.read_word_data(0x69, 0x19) == 0x0307
        assert smbus.process_call(0x69, 0x19, 0x0105) == 0x0105
        smbus.write_quick(0x69)
        first, second = i2c_msg.read(0x69, 2), i2c_msg.read(0x69, 2)
        smbus.i2c_rdwr(i2c_msg.write(0x69, [0x43]), first, second)
        assert (list(first), list(second)) == ([0, 5], [0, 6])


@pytest.mark.parametrize("number, address, fault", [(6, 0x68, None), (121, 0x69, "nack")])
def test_errors_of_an_smbus_are_those_of_linux(bus, number, address, fault):
    if fault:
        bus.fault(fault)
    with pytest.raises(OSError) as error:
        SMBus(bus).read_byte_data(address, WHO_AM_I)
    assert error.value.errno == number


def test_busio_needs_its_lock_and_reads_into_a_slice(bus):
    data = bytearray(4)
    with CircuitPythonI2C(bus) as i2c:
        with pytest.raises(RuntimeError, match="requires lock"):
            i2c.scan()
        assert i2c.try_lock() and not i2c.try_lock()
        assert i2c.scan() == [0x69]
        i2c.writeto_then_readfrom(0x69, b"\x00\x43", data, out_start=1, in_start=2)
    assert data == b"\x00\x00\x00\x05"


@pytest.mark.parametrize(
    "words, said",
    [
        ({"gyro_dps": (1, 2, 3), "colour": 1}, "takes part, .*noise, seed, not colour$"),
        ({"source": SAMPLE, "noise": 0}, "takes source or noise, not both"),
    ],
)
def test_a_mark_with_wrong_words_says_which_are_right(words, said):
    with pytest.raises(ValueError, match=said):
        chip_as_marked(**words)


def test_a_mark_without_a_name_is_refused_and_not_overlooked():
    with pytest.raises(ValueError, match="takes names"):
        chip_as_marked((1, 2, 3))


def test_what_was_imported_before_and_what_is_imported_later_opens_the_fake(smbus):
    from smbus2 import SMBus as late

    for opens in (RealSMBus, late, smbus2.SMBus):
        with opens(1) as bus:
            assert bus.read_byte_data(0x68, WHO_AM_I) == 0x68
            assert bus.read_i2c_block_data(0x68, WHO_AM_I, 1) == [0x68]


def test_a_later_test_without_the_fixture_has_the_real_class():
    with pytest.raises(OSError, match="No such file"):
        RealSMBus(1999)


@pytest.mark.imu(part="MPU-6500")
def test_the_next_test_has_its_own_chip(smbus):
    assert RealSMBus(1).read_byte_data(0x68, WHO_AM_I) == 0x70


@pytest.mark.parametrize("rate", [(1, 2), 5, 5.0])
def test_a_rate_of_other_than_three_axes_is_refused(rate):
    with pytest.raises(ValueError, match=re.escape(f"gyro_dps is {rate}; give three")):
        Physical(gyro_dps=rate)
    chip = FakeMPU6050(Physical(gyro_dps=lambda seconds: rate))
    with pytest.raises(ValueError, match=re.escape(f"gyro_dps is {rate}; give three")):
        chip.step()


def test_a_thread_s_transfer_waits_for_the_end_of_another_s(imu_bus, smbus):
    other = Thread(target=smbus.read_byte_data, args=(0x68, WHO_AM_I))

    def in_the_middle(place):
        imu_bus.between_bytes = None
        other.start()
        other.join(0.05)

    smbus.write_byte_data(0x68, 0x1A, 3)
    imu_bus.between_bytes = in_the_middle
    assert smbus.read_i2c_block_data(0x68, 0x19, 2) == [0, 3]
    other.join()


SAMPLES = [[1000, -2000, 16000, -3000, 655, -1310, 32767], [255] * 7, [256] * 7]


def test_the_driver_of_adafruit_wakes_the_chip_sets_its_range_and_reads_it():
    adafruit_mpu6050 = pytest.importorskip("adafruit_mpu6050")
    chip = FakeMPU6050(SAMPLES)
    sensor = adafruit_mpu6050.MPU6050(CircuitPythonI2C(FakeI2C(chip)))
    chip.step()
    assert sensor.gyro_range == 1 and chip.registers[0x1B] == 0x08
    *force, temp, x, y, z = SAMPLES[0]
    assert sensor.gyro == pytest.approx([radians(v / 65.5) for v in (x, y, z)])
    assert sensor.acceleration == pytest.approx([v / 16384 * 9.80665 for v in force])
    assert sensor.temperature == pytest.approx(temp / 340 + 36.53)


def test_mpu6050_raspberrypi_reads_the_chip_byte_by_byte_so_that_words_tear(monkeypatch):
    chip = FakeMPU6050(SAMPLES)
    bus = FakeI2C(chip)
    smbus = types.ModuleType("smbus")
    smbus.SMBus = lambda number: SMBus(bus)
    monkeypatch.setitem(sys.modules, "smbus", smbus)
    for name in ("mpu6050.mpu6050", "mpu6050"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    sensor = pytest.importorskip("mpu6050").mpu6050(0x68)
    chip.step()
    assert [*sensor.get_gyro_data().values()] == pytest.approx([v / 131 for v in SAMPLES[0][4:]])
    assert sensor.get_accel_data(g=True)["y"] == pytest.approx(SAMPLES[0][1] / 16384)
    chip.step()
    bus.between_bytes = lambda i: chip.step()
    torn = sensor.read_i2c_word(0x43)
    assert torn == 0  # high byte of 255, low byte of 256: neither was ever measured


def test_micropython_mpu6886_reads_what_the_chip_feels_on_a_micropython(find_runtime):
    found = importlib.util.find_spec("mpu6886")
    assert found, "micropython-mpu6886 is one of the dev extra's packages"
    text = (
        "import sys\nfrom zerorate_fakes import FakeI2C, FakeMPU6050, Physical\n"
        "sys.modules['machine'] = type('machine', (), {'I2C': FakeI2C, 'Pin': None})\n"
        "import mpu6886\n"
        "chip = FakeMPU6050(Physical(gyro_dps=(0, 0, 100), noise=0), part='MPU-6886')\n"
        "imu = mpu6886.MPU6886(FakeI2C(chip), gyro_sf=1, accel_sf=1)\nchip.step()\n"
        "print(*imu.gyro, *imu.acceleration, imu.temperature)"
    )
    files = {"mpu6886.py": Path(found.origin)}
    said = find_runtime("x86").run(text, files_in=files, modules=MODULES, check=True).stdout
    assert [float(word) for word in said.split()] == pytest.approx(
        [0, 0, 100, 0, 0, 1, 25], abs=0.01
    )


#: The driver on the fake bus, both inside one interpreter: prints what it read and counted.
WITH_FAULTS = """
from array import array

from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050

rows = 300
chip = FakeMPU6050(array("h", [(257 * i) % 30000 - 15000 for i in range(7 * rows)]))
bus = FakeI2C(chip)
imu = MPU6050(bus, clock=FakeClock())
sample = array("i", [0] * 7)
total = 0
statuses = [0, 0, 0, 0]
while chip.step():
    if chip.samples_made == 150:
        chip.power_up()
    if chip.samples_made == 50:
        bus.fault("nack", times=2)
    status = imu.read(sample)
    statuses[status] += 1
    if status != 2:
        for word in sample:
            total += word
print(statuses, total, imu.bus_errors, imu.restarts, imu.part, imu.binding)
"""


def run(runtime, script):
    return runtime.run(script, modules=MODULES, check=True).stdout.strip()


def test_a_recording_with_faults_reads_as_on_cpython(micropython, find_runtime):
    assert run(micropython, WITH_FAULTS) == run(find_runtime("cpython"), WITH_FAULTS)


def test_reads_frames_and_interrupts_take_nothing_from_the_heap(micropython):
    said = run(micropython, SCRIPTS / "without_heap.py").splitlines()
    assert said == ["39 True 0", "1000 True 0 4", "1000 1000"]
