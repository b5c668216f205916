"""The fake on MicroPython, and under published drivers that know nothing of it."""

import importlib.util
import sys
import types
from math import degrees, radians
from pathlib import Path

import pytest
from zerorate_fakes import FakeI2C, FakeMPU6050
from zerorate_fakes.circuitpython import CircuitPythonI2C
from zerorate_fakes.smbus import SMBus

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

    def test_its_axes_are_of_different_samples_as_it_reads_each_alone(self, chip, sensor):
        chip.step()
        sensor.i2c_device.i2c.bus.between_bytes = lambda i: chip.step() if i == 1 else None
        rates_lsb = [degrees(rate) * 65.5 for rate in sensor.gyro]
        assert rates_lsb == pytest.approx([FIRST[4], SECOND[5], THIRD[6]])

    def test_its_signal_path_reset_sets_only_reserved_bits(self, chip, sensor):
        assert (0x68, 0x38) in chip.reserved_writes


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

    def test_its_range_of_500_dps_reads_5_percent_high(self, run):
        # it divides by 62.5, the data sheet says 65.5
        text = (
            "imu = mpu6886.MPU6886(\n"
            "    FakeI2C(chip), gyro_fs=mpu6886.GYRO_FS_SEL_500DPS, gyro_sf=1)\n"
            "chip.step()\nprint(imu.gyro[2])"
        )
        assert float(run(text)) == pytest.approx(104.8, abs=0.1)


ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = Path(__file__).parent / "on_micropython"
MODULES = [ROOT / "drivers", ROOT / "host_tests" / "fakes"]


def run(runtime, script):
    return runtime.run(SCRIPTS / script, modules=MODULES, check=True).stdout.strip()


def test_a_recording_with_faults_reads_as_on_cpython(micropython, find_runtime):
    script = "read_whole_recording.py"
    assert run(micropython, script) == run(find_runtime("cpython"), script)


def test_two_thousand_reads_under_heap_lock(micropython):
    assert run(micropython, "read_without_heap.py") == "39 True 0"


def test_a_thousand_frames_of_the_fifo_under_heap_lock(micropython):
    assert run(micropython, "fifo_without_heap.py") == "1000 True 0 4"


def test_two_thousand_interrupts_under_heap_lock(micropython):
    assert run(micropython, "data_ready_without_heap.py") == "1000 1000"
