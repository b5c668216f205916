"""Every fault of a real bus: an error passes or the chip is set up again, nothing false given."""

import pytest
from zerorate_fakes import FakeMPU6050
from zerorate_fakes.pins import BusWires
from zerorate_i2c.bus_recovery import free_bus
from zerorate_i2c.mpu6050 import FRESH, RESTARTED, SUSPECT, VERIFIED

from host_tests.drivers.bus_faults import FAULTS, run_fault


def read_some(bench, count=5):
    return [bench.read() for _ in range(count)]


def test_after_a_bus_error_the_configuration_is_read_back(bench):
    bench.bus.fault("nack")
    assert [bench.read() for _ in range(4)] == [FRESH, VERIFIED, FRESH, FRESH]
    bench.bus.fault("nack")
    assert [bench.read() for _ in range(3)] == [FRESH, VERIFIED, FRESH]


@pytest.mark.parametrize("at_byte", range(14))
def test_a_bus_gone_in_mid_burst_gives_no_half_sample(bench, at_byte):
    read_some(bench)
    before = list(bench.sample)
    bench.bus.fault("gone", times=3, at_byte=at_byte)
    with pytest.raises(OSError):
        bench.read()
    assert list(bench.sample) == before
    assert bench.read() == VERIFIED


@pytest.mark.parametrize("kind", ["all_ff", "all_00"])
def test_a_dead_bus_is_suspect_at_once_and_an_error_next(bench, kind):
    read_some(bench)
    bench.bus.fault(kind, times=None)
    assert bench.read() == SUSPECT
    with pytest.raises(OSError, match="a dead bus|was 0x68"):
        bench.read()


@pytest.mark.parametrize("kind", ["all_ff", "all_00"])
def test_a_bus_that_dies_between_a_leap_and_its_second_reading_is_suspect(make_bench, kind):
    bench = make_bench(source=[[300 * row + word for word in range(7)] for row in range(50)])
    read_some(bench)
    bench.bus.fault(kind, times=None, skip=1)
    assert bench.read() == SUSPECT
    assert bench.imu.suspects == 1


def test_data_stand_for_sixteen_periods_and_no_longer(bench):
    bench.read()
    changed_us = bench.clock.now_us
    for after_periods, after_us, said in ((1, 0, FRESH), (16, 0, FRESH), (16, 1, SUSPECT)):
        bench.clock.now_us = changed_us + after_periods * bench.imu.period_us + after_us
        assert bench.imu.read(bench.sample) == said
    assert (bench.imu.repeats, bench.imu.suspects, bench.imu.restarts) == (3, 1, 0)
    assert bench.imu.read(bench.sample) == RESTARTED
    assert bench.imu.restarts == 1
    assert [bench.read() for _ in range(3)] == [FRESH] * 3


@pytest.mark.parametrize("byte", range(14))
def test_one_byte_that_differs_makes_a_frame_a_sample(make_bench, byte):
    words = bytearray([1, 2] * 7)
    words[byte] ^= 4
    rows = [[3] * 7, [words[i] << 8 | words[i + 1] for i in range(0, 14, 2)], [0x0102] * 7]
    bench = make_bench(source=rows)
    assert [bench.read() for _ in rows] == [SUSPECT, VERIFIED, SUSPECT]
    assert bench.imu.suspects == 2


@pytest.mark.parametrize("at_byte", [0, 2, 6, 8, 12])
def test_a_word_torn_by_a_clone_that_samples_while_it_is_read_is_read_again(make_bench, at_byte):
    bench = make_bench(source=[[251 + row % 12] + [250 + row % 12] * 6 for row in range(2000)])
    bench.chip.shadowed = False
    bench.read()
    for _ in range(100):
        bench.bus.between_bytes = sample_once(bench, at_byte)
        bench.read()
        assert max(abs(word - 256) for word in bench.sample) < 20
    assert bench.imu.torn > 5


def sample_once(bench, at_byte):
    """What makes the chip sample after that byte of the next burst."""

    def step(i):
        if i == at_byte:
            bench.bus.between_bytes = None
            bench.chip.step()

    return step


def test_a_brown_out_that_blanks_the_data_is_found_at_the_next_read(bench):
    read_some(bench)
    bench.chip.power_up()
    assert read_some(bench, 2) == [SUSPECT, RESTARTED]


@pytest.mark.parametrize("register", [0x19, 0x1A, 0x1B, 0x1C, 0x6B, 0x6C])
def test_any_register_changed_behind_the_driver_is_restored(make_bench, register):
    bench = make_bench(check_every=10)
    wanted = bench.chip.registers[register]
    bench.chip.registers[register] = wanted ^ 0x02
    assert RESTARTED in read_some(bench, 12)
    assert bench.chip.registers[register] == wanted


def test_another_part_on_the_bus_is_an_error_that_names_both(make_bench):
    bench = make_bench(check_every=10)
    other = FakeMPU6050(part="MPU-6500")
    bench.bus.devices[0x68] = other
    with pytest.raises(OSError, match="0x70 .MPU-6500.*was 0x68"):
        read_some(bench, 12)
    with pytest.raises(OSError):
        bench.imu.read(bench.sample)


def test_a_chip_that_keeps_nothing_is_an_error_and_not_a_loop(bench):
    bench.chip.write = lambda register, value: None
    bench.chip.registers[0x1A] = 0
    with pytest.raises(OSError, match="does not keep"):
        bench.imu.restart()


@pytest.mark.parametrize("bits", [0, 1, 2, 8, 9, 10, 1000])
def test_a_bus_is_freed_by_nine_clocks_at_most_and_a_stop(bench, monkeypatch, bits):
    bench.bus.hold_sda(bits)
    wires, driven = BusWires(bench.bus), []
    drive = wires.drive
    monkeypatch.setattr(wires, "drive", lambda *said: (driven.append(said), drive(*said)))
    monkeypatch.setattr(bench.clock, "sleep_ms", lambda ms: driven.append(ms))
    assert free_bus(wires.scl, wires.sda, bench.clock) is (bits <= 10)
    clock = [("scl", 0), 1, ("scl", 1), 1]
    stop = [("scl", 0), 1, ("sda", 0), 1, ("scl", 1), 1, ("sda", 1), 1]
    assert driven == [("sda", 1), ("scl", 1), *clock * min(bits, 9), *stop]
    if bits <= 10:
        assert bench.read() == FRESH


@pytest.mark.parametrize("name", sorted(FAULTS))
def test_a_fault_is_detected_every_time_and_never_learned_from(name):
    injected, detected, learned_from = run_fault(name)
    assert detected == injected > 0 == learned_from
