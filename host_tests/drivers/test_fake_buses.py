"""The fake bus from its four sides, under published drivers, and as the fixture smbus."""

import importlib.util
import inspect
import sys
import types
from math import radians
from pathlib import Path
from threading import Thread

import pytest
import smbus2
from smbus2 import SMBus as RealSMBus
from zerorate_fakes import FakeI2C, FakeMPU6050, Physical
from zerorate_fakes.circuitpython import CircuitPythonI2C
from zerorate_fakes.pytest_plugin import chip_as_marked
from zerorate_fakes.smbus import SMBus

SAMPLE = [[1, 2, 3, 4, 5, 6, 7]]
WHO_AM_I = 0x75


@pytest.fixture
def bus():
    chip = FakeMPU6050(SAMPLE)
    chip.write(0x6B, 1)
    chip.step()
    return FakeI2C({0x69: chip})


class TestMachineI2C:
    def test_scan_finds_the_chips(self, bus):
        assert bus.scan() == [0x69]

    def test_a_register_pointer_stays_where_the_last_transfer_left_it(self, bus):
        assert bus.writeto(0x69, b"\x43") == 1
        assert bus.readfrom(0x69, 2) == b"\x00\x05"
        assert bus.readfrom(0x69, 4) == b"\x00\x06\x00\x07"

    def test_readfrom_mem_and_writevto(self, bus):
        assert bus.writevto(0x69, (b"\x19", b"\x07\x03")) == 3
        assert bus.readfrom_mem(0x69, 0x19, 2) == b"\x07\x03"

    def test_a_bus_that_hangs_ends_in_a_time_out(self, bus):
        bus.fault("hang")
        with pytest.raises(OSError) as error:
            bus.readfrom_mem(0x69, WHO_AM_I, 1)
        assert error.value.errno == 110


class TestSMBus:
    def test_it_has_every_method_of_smbus2(self):
        smbus2 = pytest.importorskip("smbus2")
        for name, theirs in inspect.getmembers(smbus2.SMBus, inspect.isfunction):
            if name.startswith("_") and name not in ("__enter__", "__exit__"):
                continue
            ours = getattr(SMBus, name)
            if name[0] != "_":
                parameters = list(inspect.signature(theirs).parameters)
                assert list(inspect.signature(ours).parameters) == parameters, name

    def test_bytes_and_words(self, bus):
        with SMBus(bus) as smbus:
            smbus.write_byte(0x69, 0x43)
            assert [smbus.read_byte(0x69), smbus.read_byte(0x69)] == [0, 5]
            smbus.write_word_data(0x69, 0x19, 0x0307)
            assert smbus.read_word_data(0x69, 0x19) == 0x0307
            assert smbus.process_call(0x69, 0x19, 0x0105) == 0x0105
            smbus.write_quick(0x69)

    @pytest.mark.parametrize("number, address, fault", [(6, 0x68, None), (121, 0x69, "nack")])
    def test_errors_are_those_of_linux(self, bus, number, address, fault):
        if fault:
            bus.fault(fault)
        with pytest.raises(OSError) as error:
            SMBus(bus).read_byte_data(address, WHO_AM_I)
        assert error.value.errno == number

    def test_i2c_rdwr_goes_on_from_the_pointer(self, bus):
        i2c_msg = pytest.importorskip("smbus2").i2c_msg
        first, second = i2c_msg.read(0x69, 2), i2c_msg.read(0x69, 2)
        SMBus(bus).i2c_rdwr(i2c_msg.write(0x69, [0x43]), first, second)
        assert (list(first), list(second)) == ([0, 5], [0, 6])


class TestBusio:
    def test_nothing_goes_without_the_lock(self, bus):
        i2c = CircuitPythonI2C(bus)
        with pytest.raises(RuntimeError, match="requires lock"):
            i2c.scan()
        assert i2c.try_lock() and not i2c.try_lock()
        assert i2c.scan() == [0x69]

    def test_a_slice_of_the_buffer_is_read(self, bus):
        with CircuitPythonI2C(bus) as i2c:
            i2c.try_lock()
            data = bytearray(4)
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
        chip_as_marked(words)


_ADDRESS, _WHO_AM_I, _MPU6050 = 0x68, 0x75, 0x68


def test_a_class_imported_before_the_test_opens_the_fake(smbus):
    with RealSMBus(1) as bus:
        assert bus.read_byte_data(_ADDRESS, _WHO_AM_I) == _MPU6050


def test_a_class_imported_within_the_test_opens_the_fake(smbus):
    from smbus2 import SMBus as late

    assert late(1).read_byte_data(_ADDRESS, _WHO_AM_I) == _MPU6050


def test_the_module_opens_the_fake(smbus):
    assert smbus2.SMBus(1).read_i2c_block_data(_ADDRESS, _WHO_AM_I, 1) == [_MPU6050]


def test_a_later_test_without_the_fixture_has_the_real_class():
    with pytest.raises(OSError, match="No such file"):
        RealSMBus(1999)


@pytest.mark.imu(part="MPU-6500")
def test_the_next_test_has_its_own_chip(smbus):
    assert RealSMBus(1).read_byte_data(_ADDRESS, _WHO_AM_I) == 0x70


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


STANDARD_GRAVITY = 9.80665
FIRST = [1000, -2000, 16000, -3000, 655, -1310, 32767]
SECOND = [255, 255, 255, 255, 255, 255, 255]
THIRD = [256, 256, 256, 256, 256, 256, 256]


@pytest.fixture
def chip():
    return FakeMPU6050([FIRST, SECOND, THIRD])


class TestAdafruitCircuitPython:
    @pytest.fixture
    def sensor(self, chip):
        adafruit_mpu6050 = pytest.importorskip("adafruit_mpu6050")
        return adafruit_mpu6050.MPU6050(CircuitPythonI2C(FakeI2C(chip)))

    def test_it_wakes_the_chip_and_sets_its_range(self, chip, sensor):
        assert not chip.asleep
        assert sensor.gyro_range == 1
        assert chip.registers[0x1B] == 0x08

    def test_it_reads_what_the_chip_holds(self, chip, sensor):
        chip.step()
        assert sensor.gyro == pytest.approx([radians(v / 65.5) for v in FIRST[4:]])
        assert sensor.acceleration == pytest.approx(
            [v / 16384 * STANDARD_GRAVITY for v in FIRST[:3]]
        )
        assert sensor.temperature == pytest.approx(-3000 / 340 + 36.53)


class TestMpu6050Raspberrypi:
    @pytest.fixture
    def sensor(self, chip, monkeypatch):
        self.bus = FakeI2C(chip)
        smbus = types.ModuleType("smbus")
        smbus.SMBus = lambda number: SMBus(self.bus)
        monkeypatch.setitem(sys.modules, "smbus", smbus)
        monkeypatch.delitem(sys.modules, "mpu6050.mpu6050", raising=False)
        monkeypatch.delitem(sys.modules, "mpu6050", raising=False)
        return pytest.importorskip("mpu6050").mpu6050(0x68)

    def test_it_reads_what_the_chip_holds(self, chip, sensor):
        chip.step()
        gyro = sensor.get_gyro_data()
        assert [gyro["x"], gyro["y"], gyro["z"]] == pytest.approx([v / 131 for v in FIRST[4:]])
        assert sensor.get_accel_data(g=True)["y"] == pytest.approx(FIRST[1] / 16384)
        assert sensor.get_temp() == pytest.approx(-3000 / 340 + 36.53)

    def test_a_sample_between_its_two_byte_reads_tears_the_word(self, chip, sensor):
        chip.step()
        chip.step()
        self.bus.between_bytes = lambda i: chip.step()
        torn = sensor.read_i2c_word(0x43)
        assert torn == 0  # high byte of 255, low byte of 256: neither was ever measured


class TestMicropythonMpu6886:
    """Written for machine.I2C, and run on a MicroPython."""

    @pytest.fixture
    def run(self, find_runtime):
        """run(text) -> what the driver's user prints, with its chip at rest and 100 dps about z."""
        found = importlib.util.find_spec("mpu6886")
        assert found, "micropython-mpu6886 is one of the dev extra's packages"
        fakes = Path(__file__).parents[1] / "fakes"
        begin = (
            "import sys\nfrom zerorate_fakes import FakeI2C, FakeMPU6050, Physical\n"
            "sys.modules['machine'] = type('machine', (), {'I2C': FakeI2C, 'Pin': None})\n"
            "import mpu6886\n"
            "chip = FakeMPU6050(Physical(gyro_dps=(0, 0, 100), noise=0), part='MPU-6886')\n"
        )

        def run(text):
            files = {"mpu6886.py": Path(found.origin)}
            runtime = find_runtime("x86")
            return runtime.run(begin + text, files_in=files, modules=[fakes], check=True).stdout

        return run

    def test_it_reads_what_the_chip_feels(self, run):
        text = (
            "imu = mpu6886.MPU6886(FakeI2C(chip), gyro_sf=1, accel_sf=1)\nchip.step()\n"
            "print(*imu.gyro, *imu.acceleration, imu.temperature)"
        )
        values = [float(word) for word in run(text).split()]
        assert values == pytest.approx([0, 0, 100, 0, 0, 1, 25], abs=0.01)


ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = Path(__file__).parent / "on_micropython"
MODULES = [ROOT / "drivers", ROOT / "host_tests" / "fakes"]


def run(runtime, script):
    return runtime.run(SCRIPTS / script, modules=MODULES, check=True).stdout.strip()


def test_a_recording_with_faults_reads_as_on_cpython(micropython, find_runtime):
    script = "read_whole_recording.py"
    assert run(micropython, script) == run(find_runtime("cpython"), script)


def test_reads_frames_and_interrupts_take_nothing_from_the_heap(micropython):
    said = run(micropython, "without_heap.py").splitlines()
    assert said == ["39 True 0", "1000 True 0 4", "1000 1000"]
