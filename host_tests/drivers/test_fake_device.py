"""The fake chip behaves as the register map says, and refuses what it does not say."""

import struct
from array import array
from statistics import mean, pstdev

import numpy as np
import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical, UnknownRegister
from zerorate_fakes.pins import InterruptPin


def burst(bus, register, length):
    data = bytearray(length)
    bus.readfrom_mem_into(0x68, register, data)
    return bytes(data)


def awake(source=None, *written):
    """A chip that samples, with (register, value) pairs written to it."""
    chip = FakeMPU6050(source)
    for register, value in ((0x6B, 1), *written):
        chip.write(register, value)
    return chip


def test_an_mpu6050_powers_up_asleep_with_only_two_registers_set_and_reset_does_so():
    chip = FakeMPU6050()
    for _ in range(2):
        assert chip.asleep
        assert {i: value for i, value in enumerate(chip.registers) if value} == {
            0x6B: 64,
            0x75: 104,
        }
        for register, value in ((0x6B, 1), (0x1B, 0x18), (0x6B, 0x80)):
            chip.write(register, value)


@pytest.mark.parametrize(
    ("access", "said"),
    [
        (lambda bus: burst(bus, 0x05, 1), "0x05 of MPU-6050 is not to be read"),
        (lambda bus: burst(bus, 0x75, 2), "0x76"),
        (lambda bus: bus.writeto_mem(0x68, 0x75, b"\0"), "0x75 .*written"),
    ],
    ids=["no such register", "a burst that runs out of the map", "one only to be read"],
)
def test_what_the_register_map_does_not_document_fails(access, said):
    with pytest.raises(UnknownRegister, match=said):
        access(FakeI2C(FakeMPU6050()))


def test_data_ready_is_cleared_by_reading_it():
    chip = awake()
    chip.step()
    assert [burst(FakeI2C(chip), 0x3A, 1) for _ in range(2)] == [b"\x01", b"\x00"]


def test_the_sample_clock_starts_up_and_keeps_the_rate_of_the_registers():
    chip = awake(None, (0x1A, 3), (0x19, 99))
    clock = FakeClock(chip)
    clock.advance_us(chip.start_up_us)
    assert chip.samples_made == 0
    clock.advance_us(80000)
    chip.write(0x19, 9)  # a shorter period: the time that has passed already is not lost
    clock.advance_us(100000)
    assert chip.samples_made == 11


def test_a_full_fifo_loses_its_oldest_bytes_and_tells_once():
    chip = awake([[row] * 7 for row in range(80)], (0x23, 0xF8), (0x6A, 0x40))
    while chip.step():
        pass
    bus = FakeI2C(chip)
    assert [burst(bus, 0x3A, 1)[0] & 0x10 for _ in range(2)] == [0x10, 0]
    assert burst(bus, 0x72, 2) == (1024).to_bytes(2, "big")
    assert len(set(burst(bus, 0x74, 14)[1::2])) == 2  # 1024 is no multiple of 14: out of step


def test_a_standby_axis_keeps_its_last_word():
    chip = awake([[5] * 7, [9] * 7])
    chip.step()
    chip.write(0x6C, 0x04)
    chip.step()
    assert burst(FakeI2C(chip), 0x43, 6) == b"\x00\x05\x00\x09\x00\x09"


def test_the_memory_of_the_dmp_keeps_what_is_written():
    bus = FakeI2C(FakeMPU6050())
    for data in (bytes(range(16)), b""):
        bus.writeto_mem(0x68, 0x6D, b"\x02\x10")  # bank and start
        bus.writeto_mem(0x68, 0x6F, data)
    assert bus.readfrom_mem(0x68, 0x6F, 16) == bytes(range(16))


@pytest.mark.parametrize(
    ("config", "trigger", "seen"),
    [
        (0, InterruptPin.IRQ_RISING, [1, 1]),  # pulses
        (0x20, InterruptPin.IRQ_RISING, [1, 1]),  # latched until the status is read
        (0x30, InterruptPin.IRQ_RISING, [1, 1, 1]),  # or anything
        (0xA0, InterruptPin.IRQ_FALLING, [0, 0]),  # active low
    ],
)
def test_an_interrupt_pin_does_what_its_configuration_says(config, trigger, seen):
    chip, edges = awake(None, (0x37, config), (0x38, 1)), []
    pin = InterruptPin(chip)
    pin.irq(lambda pin: edges.append(pin.value()), trigger)
    assert pin.value() == bool(config & 0x80)
    chip.step()
    chip.read(0x75)
    if config:
        chip.step()
        chip.read(0x3A)
        assert pin.value() == bool(config & 0x80)
    chip.step()
    assert edges == seen


@pytest.mark.parametrize(
    "source",
    [
        [[1, 2, 3, 4, 5, 6, -7]],
        bytes([0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0xFF, 0xF9]),
        array("h", [1, 2, 3, 4, 5, 6, -7]),
        np.array([[1, 2, 3, 4, 5, 6, -7]], np.int16),
    ],
    ids=["iterable", "frames", "array", "numpy"],
)
def test_a_recording_may_be_an_iterable_frames_or_an_array(source):
    chip = awake(source)
    assert chip.step() and not chip.step()
    assert burst(FakeI2C(chip), 0x43, 6).hex() == "00050006fff9"


@pytest.mark.parametrize(
    "source, sentence",
    [
        (list(range(20)), "a source of 20 integers is no whole number of samples of 7"),
        (bytes(15), "a source of 15 bytes is no whole number of samples of 14"),
        ([[1, 2, 3]], "sample 0 of the source is .1, 2, 3., not seven integers"),
        ([[0.5] * 7], "for dps and g use Physical"),
        ([[0] * 6 + [32768]], "seven integers of 16 bits"),
        (5, "the source is 5, not samples"),
    ],
)
def test_a_source_of_another_shape_is_refused_in_a_sentence(source, sentence):
    with pytest.raises(ValueError, match=sentence):
        FakeMPU6050(source).step()


def words(chip):
    """The next sample of the chip."""
    chip.step()
    return list(struct.unpack(">7h", burst(FakeI2C(chip), 0x3B, 14)))


def test_what_the_chip_feels_becomes_words_as_its_ranges_say():
    felt = {"gyro_dps": (100, -300, 0), "accel_g": (0, -3, 1), "temp_degc": 20}
    chip = awake(Physical(noise=0, **felt))
    assert words(chip) == [0, -32768, 16384, -5620, 13100, -32768, 0]
    chip.write(0x1B, 0x08)
    chip.write(0x1C, 0x10)
    assert words(chip) == [0, -12288, 4096, -5620, 6550, -19650, 0]


def test_every_part_has_its_own_temperature():
    chip = FakeMPU6050(Physical(temp_degc=20, noise=0), part="MPU-9250")
    assert words(chip)[3] == round((20 - 21) * 333.87)


def test_a_value_may_be_a_function_of_the_seconds():
    felt = Physical(gyro_dps=lambda seconds: (seconds, 0, 0), noise=0)
    chip = awake(felt, (0x1A, 1), (0x19, 99))  # 10 Hz
    assert [words(chip)[4] for _ in range(3)] == [0, 13, 26]


@pytest.mark.parametrize("dlpf, sigma_dps", [(2, 0.05), (6, 0.011)])
def test_noise_is_the_data_sheets_through_the_filter_that_is_set(dlpf, sigma_dps):
    chip = awake(Physical(), (0x1A, dlpf))
    rates = [words(chip)[6] / 131 for _ in range(2000)]
    assert mean(rates) == pytest.approx(0, abs=0.005)
    assert pstdev(rates) == pytest.approx(sigma_dps, rel=0.1)
