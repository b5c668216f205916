"""The self-test passes a chip that answers as its trim says and fails any other."""

import pytest
from zerorate_i2c.self_test import self_test

# Codes 16 on all axes: 4096 * 0.34 * (0.92/0.34)**0.5 = 2290.8 LSB, 25 * 131 * 1.046**15 = 6429.8
CODES_6050 = [4 << 5 | 16] * 3 + [0]
GOOD_6050 = [2291, 2291, 2291, 0, 6430, -6430, 6430]
# Codes 101: 2620 * 1.01**100 = 7086.6 LSB
CODES_6500 = [101, 101, 101, 0]
GOOD_6500 = [7087, 7087, 7087, 0, 7087, 7087, 7087]


def make(make_bench, part, codes, response):
    bench = make_bench(source=[[100, -200, 4000, 0, 30, -60, 10]] * 4000, part=part, linked=True)
    bench.chip.set_self_test(codes, codes[:3], response)
    bench.imu.configure()
    return bench


@pytest.mark.parametrize(
    "part, codes, response",
    [("MPU-6050", CODES_6050, GOOD_6050), ("MPU-6500", CODES_6500, GOOD_6500)],
)
def test_a_good_chip_passes_with_ratios_of_one(make_bench, part, codes, response):
    passed, ratios = self_test(make(make_bench, part, codes, response).imu)
    assert passed
    assert ratios == pytest.approx([1.0] * 6, abs=0.001)


@pytest.mark.parametrize("word", [0, 1, 2, 4, 5, 6])
@pytest.mark.parametrize(
    "part, codes, response",
    [("MPU-6050", CODES_6050, GOOD_6050), ("MPU-6500", CODES_6500, GOOD_6500)],
)
def test_one_axis_that_does_not_move_fails(make_bench, part, codes, response, word):
    broken = list(response)
    broken[word] = 0
    passed, ratios = self_test(make(make_bench, part, codes, broken).imu)
    assert not passed
    assert ratios[word if word < 3 else word - 1] == pytest.approx(0.0)


def test_a_chip_without_factory_trim_does_not_pass(make_bench):
    passed, ratios = self_test(make(make_bench, "MPU-6050", [0] * 4, GOOD_6050).imu)
    assert not passed and ratios == [None] * 6


def test_the_configuration_is_back_afterwards(make_bench):
    bench = make(make_bench, "MPU-6050", CODES_6050, GOOD_6050)
    self_test(bench.imu)
    assert bench.imu.check()
