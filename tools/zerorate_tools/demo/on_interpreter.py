"""Runs on a MicroPython: samples.bin through emulated chip, bus, driver and firmware to out.bin."""

import sys
from array import array

from zerorate import Corrector, Sensor
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050, RESTARTED, SUSPECT

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_OUT_Q8 = const(63)
_EFFECT_Q8 = const(75)
# layout: end
_ROWS = 256


class Recording:
    """Rows of dt_us ax ay az temp gx gy gz from a file; `dt_us` is that of the latest."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.dt_us = 0

    def __iter__(self) -> object:
        words = bytearray(32 * _ROWS)
        with open(self.name, "rb") as file:
            while True:
                count = file.readinto(words) // 32
                if count == 0:
                    return
                rows = array("i", words)
                for i in range(count):
                    self.dt_us = rows[8 * i]
                    yield rows[8 * i + 1 : 8 * i + 8]


def content(name: str) -> bytes:
    try:
        with open(name, "rb") as file:
            return file.read()
    except OSError:
        return b""


def switched_on(imu: MPU6050, odr_hz: float) -> Corrector:
    """A Corrector at power-on, with the learned state and the model that lie beside this script."""
    scales = (imu.gyro_lsb_per_dps, imu.accel_lsb_per_g)
    degrees = (imu.temp_lsb_per_degc, imu.temp_offset_degc)
    # an interpreter without machine code takes minutes for the other sources
    corrector = Corrector(Sensor(odr_hz, *scales, *degrees), motion=False, gravity=False)
    if content("model.bin"):
        model = EffectModel()
        reason = model.load_file("model.bin", corrector.sensor, imu.binding)
        print("effect model: " + REASONS[reason])
        if reason == LOADED:
            corrector.use_model(model)
    learned = array("i", content("learned.bin"))
    if learned:
        for i in range(len(corrector.state)):
            corrector.state[i] = learned[i]
        corrector.power_on()
    return corrector


def play(part: str, dps: int, g: int, odr_hz: float) -> Corrector:
    recording = Recording("samples.bin")
    chip = FakeMPU6050(recording, part=part)
    imu = MPU6050(
        FakeI2C(chip), full_scale_dps=dps, full_scale_g=g, odr_hz=odr_hz, clock=FakeClock()
    )
    print(f"{imu.part} at 0x{imu.address:02X}, WHO_AM_I 0x{imu.who_am_i:02X}")
    corrector = switched_on(imu, odr_hz)
    state = corrector.state
    sample = array("i", [0] * 7)
    row = array("i", [0] * 6)
    with open("out.bin", "wb") as target:
        while chip.step():
            status = imu.read(sample)
            if status != RESTARTED and status != SUSPECT:
                corrector.update(sample, recording.dt_us)
            for i in range(3):
                row[i] = state[_OUT_Q8 + i] + state[_EFFECT_Q8 + i]
                row[3 + i] = sample[4 + i]
            target.write(row)
    print(corrector.explain())
    return corrector


corrector = play(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4]))
with open("state.bin", "wb") as file:
    file.write(corrector.state)
    if corrector.effects is not None:
        file.write(corrector.effects.e)
