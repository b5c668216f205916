"""The fake bus from its four sides: every method a driver may call, and each system's errors."""

import inspect

import pytest
from zerorate_fakes import FakeI2C, FakeMPU6050
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
