"""What goes onto the wire for every range, filter and rate: the tables of the data sheets."""

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_i2c.parts import ICM20689_KIND, ICM20690_KIND, MPU6050_KIND, MPU6500_KIND
from zerorate_i2c.self_test import self_test
from zerorate_i2c.settings import choose_divider, choose_filter, register_settings

KINDS = (MPU6050_KIND, MPU6500_KIND, ICM20689_KIND, ICM20690_KIND)
# DLPF_CFG 0 to 6, gyro: RM-MPU-6000A-00 register 26; RM-MPU-6500A-00 register 26
BANDWIDTHS_HZ = {MPU6050_KIND: (256, 188, 98, 42, 20, 10, 5)}
LATER_HZ = (250, 184, 92, 41, 20, 10, 5)


@pytest.mark.parametrize("kind", KINDS)
def test_a_filter_is_the_widest_not_wider_than_asked(kind):
    table = BANDWIDTHS_HZ.get(kind, LATER_HZ)
    first = 0 if kind == MPU6050_KIND else 1  # the others run at 8 kHz without a divider at 0
    for code in range(first, 7):
        assert choose_filter(kind, 1000, table[code]) == (code, table[code])
        assert choose_filter(kind, 1000, table[code] + 0.5) == (code, table[code])
        if code < 6:
            assert choose_filter(kind, 1000, table[code] - 0.5) == (code + 1, table[code + 1])
    assert choose_filter(kind, 1000, 1000) == (first, table[first])
    with pytest.raises(ValueError, match=rf"dlpf_hz is one of \({table[0]}, .* 5\), not 4.5"):
        choose_filter(kind, 1000, 4.5)


@pytest.mark.parametrize("kind", KINDS)
def test_a_filter_not_asked_for_is_the_widest_within_half_the_rate(kind):
    table = BANDWIDTHS_HZ.get(kind, LATER_HZ)
    for code in range(1, 7):
        assert choose_filter(kind, 2 * table[code], None) == (code, table[code])
    assert choose_filter(kind, 1000, None) == choose_filter(kind, 8000, None) == (1, table[1])
    assert choose_filter(kind, 9.9, None) == choose_filter(kind, 1, None) == (6, 5)


@pytest.mark.parametrize(
    "dlpf_code, odr_hz, kept",
    [
        (0, 8000, (0, 8000)),
        (0, 4000, (1, 4000)),
        (0, 31.25, (255, 31.25)),
        (1, 1000, (0, 1000)),
        (6, 999, (0, 1000)),
        (1, 300, (2, 1000 / 3)),
        (3, 100, (9, 100)),
        (3, 25, (39, 25)),
        (3, 1000 / 256.4, (255, 1000 / 256)),
    ],
)
def test_a_rate_is_the_nearest_that_the_divider_gives(dlpf_code, odr_hz, kept):
    assert choose_divider(dlpf_code, odr_hz) == kept


@pytest.mark.parametrize("dlpf_code, base_hz", [(0, 8000), (1, 1000), (6, 1000)])
def test_a_rate_beyond_the_divider_is_a_value_error_that_says_the_ends(dlpf_code, base_hz):
    said = f"odr_hz is {base_hz / 256} to {base_hz} with this filter, not"
    for odr_hz in (0, -1, -base_hz, base_hz + 0.5, base_hz / 257):
        with pytest.raises(ValueError, match=said):
            choose_divider(dlpf_code, odr_hz)
    assert choose_divider(dlpf_code, base_hz / 256) == (255, base_hz / 256)


@pytest.mark.parametrize(
    "kind, gyro_config, accel_config2",
    [
        (MPU6050_KIND, 0x18, None),
        (MPU6500_KIND, 0x18, 0x04),
        (ICM20689_KIND, 0x18, 0xC4),
        (ICM20690_KIND, 0x0C, 0xC4),
    ],
)
def test_registers_are_those_of_the_data_sheets(kind, gyro_config, accel_config2):
    pairs = list(register_settings(kind, 3, 2, 4, 39))
    usual = [0x6B, 0x01, 0x6C, 0x00, 0x19, 39, 0x1A, 4, 0x1B, gyro_config, 0x1C, 0x10]
    assert pairs == usual + ([] if accel_config2 is None else [0x1D, accel_config2])


class Wire(FakeI2C):
    """What goes over it and how long the driver sleeps, in order."""

    def __init__(self, chip):
        super().__init__(chip)
        self.said = []
        self.clock = FakeClock()
        self.clock.sleep_ms = lambda ms: self.said.append(("sleep", ms))

    def readfrom_mem_into(self, addr, memaddr, buf, **more):
        self.said.append(("read", memaddr, len(buf)))
        super().readfrom_mem_into(addr, memaddr, buf, **more)

    def writeto_mem(self, addr, memaddr, buf, **more):
        self.said.append((memaddr, *buf))
        super().writeto_mem(addr, memaddr, buf, **more)


# the gyro's start-up times: PS-MPU-6000A-00 30 ms, PS-MPU-6500A-01 35 ms, twice that
@pytest.mark.parametrize(
    "part, start_up_ms, kept_of_later",
    [("MPU-6050", 60, []), ("MPU-6500", 70, [(0x1D, 3)]), ("ICM-20602", 100, [(0x1D, 3)])],
)
def test_a_chip_is_reset_written_read_back_and_waited_for(part, start_up_ms, kept_of_later):
    wire = Wire(FakeMPU6050(part=part))
    imu = MPU6050(wire, clock=wire.clock)
    kept = [(0x6B, 0x01), (0x6C, 0), (0x19, 9), (0x1A, 3), (0x1B, 0), (0x1C, 0), *kept_of_later]
    reset = [(0x6B, 0x80), ("sleep", 100), *kept]
    read_back = [("read", 0x75, 1)] + [("read", register, 1) for register, _ in kept]
    set_up = [*reset, *read_back, ("sleep", start_up_ms)]
    assert wire.said[-len(set_up) :] == set_up
    assert (imu.read_backs, imu.restarts, imu.bus_errors) == (1, 0, 0)
    wire.said.clear()
    imu.restart()
    assert wire.said == set_up
    assert (imu.read_backs, imu.restarts) == (2, 1)


# Factory codes, and the response in LSB that they stand for. Codes 17, 18 and 19 of an MPU-6050:
# 4096 * 0.34 * (0.92/0.34)**(16/30) and so on; 16 of its gyro 25 * 131 * 1.046**15 = 6429.8 LSB;
# codes 101 of an MPU-6500 2620 * 1.01**100 = 7086.6 LSB.
GOOD = {
    "MPU-6050": ([4 << 5 | 16] * 3 + [0b01_10_11], [2368, 2448, 2531, 0, 6430, -6430, 6430]),
    "MPU-6500": ([101, 101, 101, 0], [7087, 7087, 7087, 0, 7087, 7087, 7087]),
}


@pytest.fixture
def tested(make_bench):
    """tested(part, codes, response) -> (passed, ratios) of its self-test."""

    def tested(part, codes, response):
        rows = [[100, -200, 4000, 0, 30, -60, 10]] * 4000
        bench = make_bench(source=rows, part=part, linked=True)
        bench.chip.set_self_test(codes, codes[:3], response)
        bench.imu.configure()
        found = self_test(bench.imu)
        assert bench.imu.check(), "the configuration is back"
        return found

    return tested


@pytest.mark.parametrize("part", GOOD)
def test_a_good_chip_passes_with_ratios_of_one(tested, part):
    passed, ratios = tested(part, *GOOD[part])
    assert passed
    assert ratios == pytest.approx([1.0] * 6, abs=0.001)


@pytest.mark.parametrize("word", [0, 1, 2, 4, 5, 6])
@pytest.mark.parametrize("part", GOOD)
def test_one_axis_that_does_not_move_fails(tested, part, word):
    codes, response = GOOD[part]
    passed, ratios = tested(part, codes, [*response[:word], 0, *response[word + 1 :]])
    assert not passed
    assert ratios[word if word < 3 else word - 1] == pytest.approx(0.0)


def test_a_chip_without_factory_trim_does_not_pass(tested):
    assert tested("MPU-6050", [0] * 4, GOOD["MPU-6050"][1]) == (False, [None] * 6)
