"""The driver brings a chip up, reads whole samples and says what it is talking to."""

import sys
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.registers import PARTS as FAKE_PARTS
from zerorate_i2c.mpu6050 import FRESH, MPU6050, VERIFIED
from zerorate_i2c.parts import PARTS

# temperature in LSB a degC and degC at 0, FIFO bytes -> WHO_AM_I; reference: data sheets
_IDS = {
    (340.0, 36.53, 1024): (0x68,),
    (333.87, 21.0, 512): (0x70, 0x71, 0x73, 0x74),
    (333.87, 21.0, None): (0x78,),
    (326.8, 25.0, 1008): (0x11, 0x12),
    (326.8, 25.0, 512): (0xAF, 0xAE, 0xA6, 0xA9),
    (326.8, 25.0, 4096): (0x98,),
    (326.8, 25.0, 1024): (0x20,),
    (326.8, 25.0, None): (0x19,),
}
FACTS = {who_am_i: facts for facts, ids in _IDS.items() for who_am_i in ids}


def test_every_id_is_one_whose_facts_are_known():
    assert {row[0] for row in PARTS} == set(FACTS)


@pytest.mark.parametrize("part", sorted(FAKE_PARTS))
def test_every_part_comes_up_with_its_own_formula(make_bench, part):
    imu = make_bench(part=part).imu
    lsb_per_degc, offset_degc, fifo_bytes = FACTS[imu.who_am_i]
    assert imu.part == part
    assert imu.temperature_degc(1000) == pytest.approx(1000 / lsb_per_degc + offset_degc)
    assert fifo_bytes in (None, imu.fifo_bytes)


@pytest.mark.parametrize(
    "dps, lsb_per_dps, g, lsb_per_g",
    [
        (250, 131.0, 2, 16384.0),
        (500, 65.5, 4, 8192.0),
        (1000, 32.8, 8, 4096.0),
        (2000, 16.4, 16, 2048.0),
    ],
)
def test_a_range_sets_its_bits_and_the_scales_that_the_firmware_takes(
    make_bench, dps, lsb_per_dps, g, lsb_per_g
):
    bench = make_bench(full_scale_dps=dps, full_scale_g=g)
    assert bench.imu.scales == (100.0, lsb_per_dps, lsb_per_g, 340.0, 36.53)
    bits = [250, 500, 1000, 2000].index(dps) << 3
    assert [*bench.chip.registers[0x1B:0x1D]] == [bits, bits]


@pytest.mark.parametrize(
    "options, said",
    [
        ({"full_scale_dps": 300}, r"full_scale_dps is one of \(250, 500, 1000, 2000\), not 300"),
        ({"odr_hz": 2}, "odr_hz is"),
        ({"dlpf_hz": 1}, "dlpf_hz is one of"),
        ({"named": "LSM6DS3"}, "no part is called LSM6DS3"),
    ],
)
def test_a_value_no_part_can_take_is_a_value_error(make_bench, options, said):
    with pytest.raises(ValueError, match=said):
        make_bench(**options)


@pytest.mark.parametrize(
    "devices, said",
    [
        ({0x69: FakeMPU6050()}, "address 0x68, no id.*a scan of the bus sees 0x69"),
        ({}, "address 0x68, no id.*sees nothing at all"),
        ({0x68: FakeMPU6050(who_am_i=0x72)}, "address 0x68 .*0x72: "),
        ({0x68: FakeMPU6050(who_am_i=0)}, "address 0x68 .*0x00: "),
    ],
)
def test_no_chip_or_an_unknown_one_is_an_os_error_with_the_address(devices, said):
    with pytest.raises(OSError, match=said) as caught:
        MPU6050(FakeI2C(devices), clock=FakeClock())
    assert caught.value.errno == 19


def test_a_chip_of_another_address_and_no_genuine_id_comes_up_when_the_part_is_named():
    bus = FakeI2C({0x69: FakeMPU6050(part="MPU-6500", who_am_i=0x72)})
    imu = MPU6050(bus, 0x69, part="mpu6500", clock=FakeClock())
    assert (imu.part, imu.address, imu.who_am_i) == ("MPU-6500", 0x69, 0x72)
    for kind in ("all_ff", "all_00"):
        bus.fault(kind, times=None)
        with pytest.raises(OSError, match="a dead bus"):
            MPU6050(bus, 0x69, part="MPU-6500", clock=FakeClock())


@pytest.mark.parametrize(
    ("error", "taken", "bus", "opened"),
    [
        (ValueError("bad SCL pin"), 0, None, [0]),  # of a Pico
        (ValueError("bad SCL pin"), 1, None, [0, 1]),
        (ValueError("bad SCL pin"), 1, 1, [1]),
        (ValueError("explicit choice of scl/sda is not implemented"), None, None, [0, 1, "soft"]),
        (TypeError("extra keyword arguments given"), None, None, [0, 1, "soft"]),
    ],
)
def test_any_pins_of_any_port_come_up_by_number_or_name(monkeypatch, error, taken, bus, opened):
    clock, wire, numbers = FakeClock(), Mock(), []

    def i2c(number, **wires):
        assert wires == {"scl": wire, "sda": wire, "freq": 400000}
        numbers.append(number)
        if number not in (taken, "soft"):
            raise error
        return FakeI2C(FakeMPU6050())

    ports = {"Pin": Mock(return_value=wire), "I2C": i2c, "SoftI2C": lambda **w: i2c("soft", **w)}
    monkeypatch.setitem(sys.modules, "machine", SimpleNamespace(**ports))
    monkeypatch.delitem(sys.modules, "zerorate_i2c.board", raising=False)
    from zerorate_i2c.board import setup

    assert setup(scl="GP5", sda="GP4", bus=bus, clock=clock).part == "MPU-6050"
    assert numbers == opened


def test_a_read_fills_seven_signed_words(make_bench):
    bench = make_bench(source=[[1, -2, 3, -4, 5, -6, -32768]])
    assert bench.read() == FRESH
    assert list(bench.sample) == [1, -2, 3, -4, 5, -6, -32768]


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
