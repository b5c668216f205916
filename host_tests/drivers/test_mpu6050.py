"""The driver brings a chip up, reads whole samples and says what it is talking to."""

import sys

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.registers import PARTS as FAKE_PARTS
from zerorate_i2c.mpu6050 import FRESH, MPU6050, VERIFIED
from zerorate_i2c.parts import PARTS

FACTS = {  # reference: data sheets, temperature formula and FIFO size by WHO_AM_I
    0x68: (340.0, 36.53, 1024),
    0x70: (333.87, 21.0, 512),
    0x71: (333.87, 21.0, 512),
    0x73: (333.87, 21.0, 512),
    0x74: (333.87, 21.0, 512),
    0x78: (333.87, 21.0, None),
    0x11: (326.8, 25.0, 1008),
    0x12: (326.8, 25.0, 1008),
    0xAF: (326.8, 25.0, 512),
    0xAE: (326.8, 25.0, 512),
    0xA6: (326.8, 25.0, 512),
    0x98: (326.8, 25.0, 4096),
    0x20: (326.8, 25.0, 1024),
    0xA9: (326.8, 25.0, 512),
    0x19: (326.8, 25.0, None),
}


def test_where_no_chip_answers_a_scan_of_the_bus_is_told():
    bus = FakeI2C({0x69: FakeMPU6050()})
    with pytest.raises(OSError, match="a scan of the bus sees 0x69"):
        MPU6050(bus, clock=FakeClock())
    with pytest.raises(OSError, match="sees nothing at all"):
        MPU6050(FakeI2C({}), clock=FakeClock())


def test_the_table_of_parts_has_every_id_once_known():
    assert {row[0] for row in PARTS} == set(FACTS)


@pytest.mark.parametrize("part", sorted(FAKE_PARTS))
def test_every_part_comes_up_with_its_own_formula(make_bench, part):
    imu = make_bench(part=part).imu
    lsb_per_degc, offset_degc, fifo_bytes = FACTS[imu.who_am_i]
    assert imu.part == part
    assert imu.temperature_degc(1000) == pytest.approx(1000 / lsb_per_degc + offset_degc)
    assert fifo_bytes in (None, imu.fifo_bytes)


def test_a_read_fills_seven_signed_words(make_bench):
    bench = make_bench(source=[[1, -2, 3, -4, 5, -6, -32768]])
    assert bench.read() == FRESH
    assert list(bench.sample) == [1, -2, 3, -4, 5, -6, -32768]


@pytest.mark.parametrize(
    "dps, lsb_per_dps", [(250, 131.0), (500, 65.5), (1000, 32.8), (2000, 16.4)]
)
def test_the_gyro_range_sets_bits_and_scale(make_bench, dps, lsb_per_dps):
    bench = make_bench(full_scale_dps=dps)
    assert bench.imu.gyro_lsb_per_dps == lsb_per_dps
    assert bench.chip.registers[0x1B] >> 3 & 3 == [250, 500, 1000, 2000].index(dps)


@pytest.mark.parametrize("g, lsb_per_g", [(2, 16384.0), (4, 8192.0), (8, 4096.0), (16, 2048.0)])
def test_the_accel_range_sets_bits_and_scale(make_bench, g, lsb_per_g):
    bench = make_bench(full_scale_g=g)
    assert bench.imu.accel_lsb_per_g == lsb_per_g
    assert bench.chip.registers[0x1C] >> 3 == [2, 4, 8, 16].index(g)


@pytest.mark.parametrize(
    "options, said",
    [
        ({"full_scale_dps": 300}, "full_scale_dps is one of"),
        ({"odr_hz": 2}, "odr_hz is"),
        ({"dlpf_hz": 1}, "dlpf_hz is one of"),
        ({"named": "LSM6DS3"}, "no part is called LSM6DS3"),
    ],
)
def test_a_value_no_part_can_take_is_a_value_error(make_bench, options, said):
    with pytest.raises(ValueError, match=said):
        make_bench(**options)


@pytest.mark.parametrize("who_am_i", [0x72, 0x00, 0xFF, 0x47])
def test_an_unknown_id_is_an_os_error_with_address_and_id(who_am_i):
    bus = FakeI2C({0x69: FakeMPU6050(who_am_i=who_am_i)})
    with pytest.raises(OSError, match=f"address 0x69 .*0x{who_am_i:02x}: ") as caught:
        MPU6050(bus, address=0x69, clock=FakeClock())
    assert caught.value.errno == 19


def test_no_chip_is_an_os_error_with_the_address():
    with pytest.raises(OSError, match="address 0x68, no id") as caught:
        MPU6050(FakeI2C({}), clock=FakeClock())
    assert caught.value.errno == 19


def test_an_id_of_no_genuine_part_comes_up_when_the_part_is_named():
    bus = FakeI2C(FakeMPU6050(part="MPU-6500", who_am_i=0x72))
    imu = MPU6050(bus, part="mpu6500", clock=FakeClock())
    assert imu.part == "MPU-6500" and imu.who_am_i == 0x72


def test_the_configuration_is_read_back_every_so_many_samples(make_bench):
    bench = make_bench(check_every=10)
    statuses = [bench.read() for _ in range(21)]
    assert [i for i, status in enumerate(statuses) if status == VERIFIED] == [10, 20]
    assert set(statuses) == {FRESH, VERIFIED}
    assert bench.imu.read_backs == 3  # and one at the start


def test_a_setting_is_kept_in_the_place_of_its_register_and_no_other(make_bench):
    bench = make_bench(odr_hz=1000 / 0x38)  # the divider 0x37 is also a register's number
    usual = list(bench.imu._settings)
    for register, value in ((0x37, 0x10), (0x37, 0x30), (0x6B, 0x02), (0x6C, 0x07)):
        bench.imu.keep_setting(register, value)
        assert bench.chip.registers[register] == value
    usual[1], usual[3] = 0x02, 0x07
    assert list(bench.imu._settings) == [*usual, 0x37, 0x30]


@pytest.mark.parametrize(
    "odr_hz, period_us", [(100, 10000), (1000, 1000), (300, 3000), (5, 5000 * 40)]
)
def test_the_period_is_that_of_the_rate_kept(make_bench, odr_hz, period_us):
    imu = make_bench(odr_hz=odr_hz).imu
    assert imu.period_us == period_us == round(1000000 / imu.odr_hz)


@pytest.mark.parametrize("retries", [0, 1, 2, 5])
def test_a_transfer_is_tried_once_more_than_retries_and_each_failure_counted(make_bench, retries):
    bench = make_bench(retries=retries)
    bench.read()
    transfers = bench.bus.transfers
    bench.bus.fault("nack", times=retries)
    assert bench.read() == FRESH
    assert (bench.imu.bus_errors, bench.bus.transfers - transfers) == (retries, retries + 1)
    bench = make_bench(retries=retries)
    bench.read()
    transfers = bench.bus.transfers
    bench.bus.fault("nack", times=None)
    with pytest.raises(OSError):
        bench.read()
    assert (bench.imu.bus_errors, bench.bus.transfers - transfers) == (retries + 1, retries + 1)


@pytest.mark.parametrize("word", range(7))
@pytest.mark.parametrize(
    "base, leap", [(5000, 160), (-5000, 160), (3 * 256 + 100, 160), (1000, 0), (-1, 160)]
)
@pytest.mark.parametrize("sign", [1, -1])
def test_a_word_that_leaps_by_more_than_160_is_read_twice(make_bench, word, base, leap, sign):
    rows = [[base + place for place in range(7)] for _ in range(3)]
    rows[1][word] += sign * leap
    rows[2][word] = rows[1][word] + sign * 161
    bench = make_bench(source=rows)
    bench.read()
    transfers = []
    for row in rows[1:]:
        before = bench.bus.transfers
        assert bench.read() == FRESH
        assert list(bench.sample) == row
        transfers.append(bench.bus.transfers - before)
    assert transfers == [1, 2]
    assert bench.imu.torn == 0


def test_it_knows_a_chip_that_kept_its_power_from_a_program_before(make_bench):
    bench = make_bench(odr_hz=50)
    assert not bench.imu.kept_power
    assert MPU6050(bench.bus, odr_hz=50, clock=bench.clock).kept_power
    assert not MPU6050(bench.bus, odr_hz=100, clock=bench.clock).kept_power
    bench.chip.power_up()
    assert not MPU6050(bench.bus, odr_hz=100, clock=bench.clock).kept_power


def test_the_binding_names_chip_range_and_filter(make_bench):
    assert make_bench().imu.binding == bytes([0x68, 0, 0, 3])
    assert make_bench(full_scale_dps=500, full_scale_g=16).imu.binding == bytes([0x68, 1, 3, 3])
    assert make_bench(part="MPU-6500", dlpf_hz=20).imu.binding == bytes([0x70, 0, 0, 4])


def test_on_a_computer_the_modules_of_the_constructor_stay(bench):
    assert {f"zerorate_i2c.{name}" for name in ("identity", "parts", "settings")} <= set(
        sys.modules
    )


def test_a_chip_with_ad0_high_answers_at_0x69():
    imu = MPU6050(FakeI2C({0x69: FakeMPU6050()}), address=0x69, clock=FakeClock())
    assert (imu.address, imu.who_am_i) == (0x69, 0x68)


def test_the_scales_are_in_the_order_in_which_the_firmware_takes_them(make_bench):
    assert make_bench(full_scale_dps=500).imu.scales == (100.0, 65.5, 16384.0, 340.0, 36.53)


@pytest.mark.parametrize("id_read", [0x00, 0xFF])
def test_a_part_that_is_named_does_not_make_a_dead_bus_a_part(make_bench, id_read):
    bench = make_bench()
    bench.bus.fault("all_ff" if id_read else "all_00", times=None)
    with pytest.raises(OSError, match="a dead bus"):
        MPU6050(bench.bus, part="MPU-6500", clock=bench.clock)
