"""The fake chip behaves as the register map says, and refuses what it does not say."""

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical, UnknownRegister
from zerorate_fakes.pins import InterruptPin
from zerorate_fakes.registers import PARTS


def burst(bus, register, length):
    data = bytearray(length)
    bus.readfrom_mem_into(0x68, register, data)
    return bytes(data)


def test_an_mpu6050_powers_up_asleep_with_only_two_registers_set():
    chip = FakeMPU6050()
    held = {i: value for i, value in enumerate(chip.registers) if value}
    assert held == {0x6B: 0x40, 0x75: 0x68}


@pytest.mark.parametrize("part", sorted(PARTS))
def test_every_part_answers_with_its_own_id(part):
    assert burst(FakeI2C(FakeMPU6050(part=part)), 0x75, 1)[0] == PARTS[part][1]


def test_an_undocumented_register_cannot_be_read():
    with pytest.raises(UnknownRegister, match="0x05 of MPU-6050"):
        burst(FakeI2C(FakeMPU6050()), 0x05, 1)


def test_a_register_only_to_be_read_cannot_be_written():
    with pytest.raises(UnknownRegister, match="written"):
        FakeI2C(FakeMPU6050()).writeto_mem(0x68, 0x75, b"\x00")


def test_a_burst_counts_up_and_runs_out_of_the_map():
    with pytest.raises(UnknownRegister, match="0x76"):
        burst(FakeI2C(FakeMPU6050()), 0x75, 2)


def test_asleep_the_data_stay_as_they_are():
    chip = FakeMPU6050([[1] * 7, [2] * 7])
    chip.step()
    assert burst(FakeI2C(chip), 0x3B, 14) == bytes(14)


def test_awake_a_burst_is_the_sample_in_big_endian_words():
    chip = FakeMPU6050([[1, -2, 3, -4, 5, -6, 32767]])
    chip.write(0x6B, 1)
    chip.step()
    assert burst(FakeI2C(chip), 0x3B, 14).hex() == "0001fffe0003fffc0005fffa7fff"


def test_data_ready_is_cleared_by_reading_it():
    chip = FakeMPU6050()
    chip.write(0x6B, 1)
    chip.step()
    bus = FakeI2C(chip)
    assert burst(bus, 0x3A, 1) == b"\x01"
    assert burst(bus, 0x3A, 1) == b"\x00"


def test_the_sample_clock_keeps_the_rate_that_the_registers_give():
    chip = FakeMPU6050()
    clock = FakeClock(chip)
    chip.write(0x6B, 1)
    chip.write(0x1A, 3)
    chip.write(0x19, 9)
    clock.advance_us(chip.start_up_us + 1000000)
    assert chip.samples_made == 100


def test_a_shorter_period_set_in_mid_sample_loses_no_time():
    chip = FakeMPU6050()
    for register, value in ((0x6B, 1), (0x1A, 3), (0x19, 99)):
        chip.write(register, value)
    chip.advance_us(chip.start_up_us + 80000)
    chip.write(0x19, 9)
    chip.advance_us(100000)
    assert chip.samples_made == 11


def test_no_sample_is_made_during_start_up():
    chip = FakeMPU6050()
    chip.write(0x6B, 1)
    chip.advance_us(chip.start_up_us)
    assert chip.samples_made == 0


def test_the_reset_bit_brings_back_reset_values():
    chip = FakeMPU6050()
    chip.write(0x6B, 1)
    chip.write(0x1B, 0x18)
    chip.write(0x6B, 0x80)
    assert chip.asleep and chip.registers[0x1B] == 0


def test_the_fifo_is_read_at_one_address():
    chip = FakeMPU6050([[1, 2, 3, 4, 5, 6, 7]])
    for register, value in ((0x6B, 1), (0x23, 0xF8), (0x6A, 0x40)):
        chip.write(register, value)
    chip.step()
    bus = FakeI2C(chip)
    assert burst(bus, 0x72, 2) == b"\x00\x0e"
    assert burst(bus, 0x74, 14) == bytes([0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0, 7])
    assert burst(bus, 0x72, 2) == b"\x00\x00"


def test_a_full_fifo_loses_its_oldest_bytes_and_tells_once():
    chip = FakeMPU6050([[row] * 7 for row in range(80)])
    for register, value in ((0x6B, 1), (0x23, 0xF8), (0x6A, 0x40)):
        chip.write(register, value)
    while chip.step():
        pass
    bus = FakeI2C(chip)
    assert burst(bus, 0x3A, 1)[0] & 0x10
    assert not burst(bus, 0x3A, 1)[0] & 0x10
    assert burst(bus, 0x72, 2) == (1024).to_bytes(2, "big")
    assert len(set(burst(bus, 0x74, 14)[1::2])) == 2  # 1024 is no multiple of 14: out of step


def test_a_standby_axis_keeps_its_last_word():
    chip = FakeMPU6050([[5] * 7, [9] * 7])
    chip.write(0x6B, 1)
    chip.step()
    chip.write(0x6C, 0x04)
    chip.step()
    assert burst(FakeI2C(chip), 0x43, 6) == b"\x00\x05\x00\x09\x00\x09"


@pytest.mark.parametrize(
    "source",
    [
        [[1, 2, 3, 4, 5, 6, -7]],
        bytes([0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0xFF, 0xF9]),
        __import__("array").array("h", [1, 2, 3, 4, 5, 6, -7]),
    ],
    ids=["iterable", "frames", "array"],
)
def test_a_recording_may_be_an_iterable_frames_or_an_array(source):
    chip = FakeMPU6050(source)
    chip.write(0x6B, 1)
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


class TestPhysical:
    """What the chip feels becomes words as the registers say."""

    @staticmethod
    def words(chip):
        chip.step()
        return [word - ((word & 0x8000) << 1) for word in _words(burst(FakeI2C(chip), 0x3B, 14))]

    @pytest.fixture
    def chip(self):
        felt = {"gyro_dps": (100, -300, 0), "accel_g": (0, -3, 1), "temp_degc": 20}
        chip = FakeMPU6050(Physical(noise=0, **felt))
        chip.write(0x6B, 1)
        return chip

    def test_at_reset_the_ranges_are_the_smallest_and_words_end_there(self, chip):
        assert self.words(chip) == [0, -32768, 16384, -5620, 13100, -32768, 0]

    def test_wider_ranges_make_smaller_words(self, chip):
        chip.write(0x1B, 0x08)
        chip.write(0x1C, 0x10)
        assert self.words(chip) == [0, -12288, 4096, -5620, 6550, -19650, 0]

    def test_every_part_has_its_own_temperature(self):
        chip = FakeMPU6050(Physical(temp_degc=20, noise=0), part="MPU-9250")
        assert self.words(chip)[3] == round((20 - 21) * 333.87)

    def test_a_value_may_be_a_function_of_the_seconds(self):
        chip = FakeMPU6050(Physical(gyro_dps=lambda seconds: (seconds, 0, 0), noise=0))
        for register, value in ((0x6B, 1), (0x1A, 1), (0x19, 99)):  # 10 Hz
            chip.write(register, value)
        assert [self.words(chip)[4] for _ in range(3)] == [0, 13, 26]

    @pytest.mark.parametrize("dlpf, sigma_dps", [(2, 0.05), (6, 0.011)])
    def test_noise_is_the_data_sheets_through_the_filter_that_is_set(self, dlpf, sigma_dps):
        chip = FakeMPU6050(Physical())
        chip.write(0x6B, 1)
        chip.write(0x1A, dlpf)
        rates = [self.words(chip)[6] / 131 for _ in range(2000)]
        assert sum(rates) / 2000 == pytest.approx(0, abs=0.005)
        assert (sum(rate * rate for rate in rates) / 2000) ** 0.5 == pytest.approx(
            sigma_dps, rel=0.1
        )


def _words(data):
    return [data[i] << 8 | data[i + 1] for i in range(0, len(data), 2)]


class TestInterrupt:
    @pytest.fixture
    def edges(self):
        """edges(INT_PIN_CFG, trigger) -> (chip awake with its interrupt on, list of edges)."""

        def edges(config, trigger=InterruptPin.IRQ_RISING):
            chip = FakeMPU6050()
            for register, value in ((0x6B, 1), (0x37, config), (0x38, 1)):
                chip.write(register, value)
            seen = []
            InterruptPin(chip).irq(lambda pin: seen.append(pin.value()), trigger)
            return chip, seen

        return edges

    def test_a_pulse_comes_with_every_sample(self, edges):
        chip, seen = edges(0)
        chip.step()
        chip.step()
        assert seen == [1, 1]

    def test_latched_it_stays_until_the_status_is_read(self, edges):
        chip, seen = edges(0x20)
        chip.step()
        chip.step()
        assert seen == [1] and chip.int_level == 1
        chip.read(0x3A)
        assert chip.int_level == 0
        chip.step()
        assert seen == [1, 1]

    def test_any_read_clears_it_where_that_is_set(self, edges):
        chip, _ = edges(0x30)
        chip.step()
        chip.read(0x75)
        assert chip.int_level == 0

    def test_active_low_it_falls(self, edges):
        chip, seen = edges(0xA0, InterruptPin.IRQ_FALLING)
        assert chip.int_level == 1
        chip.step()
        assert seen == [0]


def test_the_memory_of_the_dmp_keeps_what_is_written():
    bus = FakeI2C(FakeMPU6050())
    bank_and_start = b"\x02\x10"
    bus.writeto_mem(0x68, 0x6D, bank_and_start)
    bus.writeto_mem(0x68, 0x6F, bytes(range(16)))
    bus.writeto_mem(0x68, 0x6D, bank_and_start)
    assert bus.readfrom_mem(0x68, 0x6F, 16) == bytes(range(16))
