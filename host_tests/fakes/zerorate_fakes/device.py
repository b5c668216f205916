"""One chip of the MPU-6050 family, register by register.

Left out: the auxiliary I2C master, motion detection and the DMP; their registers, and the DMP's
memory, only keep values.
"""

from .registers import PARTS, READ, WRITE, Fifo, access_of
from .source import Physical, samples_of

TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .source import Source

_SELF_TEST_X = 0x0D
_SMPLRT_DIV = 0x19
_CONFIG = 0x1A
_GYRO_CONFIG = 0x1B
_ACCEL_CONFIG = 0x1C
_ACCEL_CONFIG2 = 0x1D
_FIFO_EN = 0x23
_INT_PIN_CFG = 0x37
_INT_ENABLE = 0x38
_INT_STATUS = 0x3A
_ACCEL_XOUT_H = 0x3B
_GYRO_ZOUT_L = 0x48
_SIGNAL_PATH_RESET = 0x68
_USER_CTRL = 0x6A
_PWR_MGMT_1 = 0x6B
_PWR_MGMT_2 = 0x6C
_BANK_SEL = 0x6D
_MEM_START_ADDR = 0x6E
_MEM_R_W = 0x6F
_FIFO_COUNT_H = 0x72
_FIFO_COUNT_L = 0x73
_FIFO_R_W = 0x74
_WHO_AM_I = 0x75

_INT_LEVEL_LOW = 0x80
_LATCH_INT = 0x20
_ANY_READ_CLEARS = 0x10
_DATA_RDY = 0x01
_FIFO_OFLOW = 0x10
_GYRO_LSB_PER_DPS = (131.0, 65.5, 32.8, 16.4)
_BANDWIDTH_HZ = (256, 188, 98, 42, 20, 10, 5, 256)
# FIFO_EN bit and PWR_MGMT_2 standby bit of each data word ax ay az temp gx gy gz
_FIFO_BIT = (0x08, 0x08, 0x08, 0x80, 0x40, 0x20, 0x10)
_STANDBY_BIT = (0x20, 0x10, 0x08, 0x00, 0x04, 0x02, 0x01)


class UnknownRegister(Exception):
    """An address that the data sheet does not document, or an access it does not allow."""


class FakeMPU6050:
    """A chip just powered: registers at their reset values, asleep where the part wakes so.

    source gives one sample for each tick of the sample clock: raw words (see source.samples_of),
    served as they are whatever range is set, or a Physical, which the ranges set turn into words.
    Time passes by step() and advance_us() only. who_am_i overrides the part's id, as boards sold
    with another chip than named do. interrupt, where set, is called when INT may have changed.
    Raises ValueError for an unknown part and a source of the wrong shape.
    """

    def __init__(
        self,
        source: "Source | Physical | None" = None,
        part: str = "MPU-6050",
        who_am_i: "int | None" = None,
    ) -> None:
        if part not in PARTS:
            raise ValueError("no part is called {}; known: {}".format(part, ", ".join(PARTS)))
        ranges, chip_id, self._pwr_reset, self._config_reset, size, start_up_us = PARTS[part][:6]
        self._temp_scale = PARTS[part][6]
        self.part = part
        self.who_am_i = chip_id if who_am_i is None else who_am_i
        self.start_up_us = start_up_us
        self._fifo_bytes = size
        self.samples_made = 0
        self.shadowed = True
        self.frozen = False
        self.interrupt: "Callable[[], object] | None" = None
        self.self_test_response = [0] * 7
        self._size_chosen = part in ("ICM-20689", "ICM-20690")
        self._access = access_of(ranges)
        self._trim = bytearray(16)
        self._physical = source if isinstance(source, Physical) else None
        self._samples = samples_of(None if isinstance(source, Physical) else source)
        self._latched = bytearray(14)
        self.power_up()

    def power_up(self) -> None:
        """Reset values everywhere, as after power came (back) or DEVICE_RESET."""
        self.registers = bytearray(256)
        self.registers[_PWR_MGMT_1] = self._pwr_reset
        self.registers[_CONFIG] = self._config_reset
        self.registers[_WHO_AM_I] = self.who_am_i
        self.registers[_SELF_TEST_X : _SELF_TEST_X + 4] = self._trim[:4]
        if self._access[0]:
            self.registers[0:3] = self._trim[4:7]
        self.fifo = Fifo(512 if self._size_chosen else self._fifo_bytes)
        self._dmp: "dict[tuple[int, int], int]" = {}
        self._int_active = False
        self._awake_us = 0
        self._phase_us = 0

    def set_self_test(
        self, codes: "Sequence[int]", gyro_codes: "Sequence[int]", response: "Sequence[int]"
    ) -> None:
        """Burn factory trim: bytes at 0x0D and at 0x00; LSB each word's self-test bit adds."""
        self._trim[0:4] = bytes(codes)
        self._trim[4:7] = bytes(gyro_codes)
        self.self_test_response = list(response)
        self.power_up()

    @property
    def asleep(self) -> bool:
        return bool(self.registers[_PWR_MGMT_1] & 0x40)

    @property
    def period_us(self) -> int:
        """Sample period that SMPLRT_DIV and CONFIG give: 8 kHz without the filter, else 1 kHz."""
        unfiltered = self.registers[_CONFIG] & 7 in (0, 7)
        return (125 if unfiltered else 1000) * (1 + self.registers[_SMPLRT_DIV])

    @property
    def int_level(self) -> int:
        """Level of the INT pin: high while active, or low with INT_LEVEL."""
        return int(self._int_active != bool(self.registers[_INT_PIN_CFG] & _INT_LEVEL_LOW))

    def advance_us(self, us: int) -> None:
        """Let us microseconds pass; awake and started up, the sample clock ticks in them."""
        while us > 0 and not self.asleep:
            waiting = self.start_up_us - self._awake_us
            passed = min(us, waiting if waiting > 0 else max(0, self.period_us - self._phase_us))
            us -= passed
            self._awake_us += passed
            if waiting <= 0:
                self._phase_us += passed
                if self._phase_us >= self.period_us:
                    self._phase_us = 0
                    self.step()

    def step(self) -> bool:
        """One tick of the sample clock now; False when the source has no more.

        Asleep, the source's sample is lost and the registers keep what they hold.
        """
        sample = self._physical_sample() if self._physical else next(self._samples, None)
        if sample is None:
            return False
        self.samples_made += 1
        if not self.asleep:
            self._awake_us = self.start_up_us
            if not self.frozen:
                self._store(sample)
            self._fill_fifo()
            self.registers[_INT_STATUS] |= _DATA_RDY
            if self.registers[_INT_ENABLE] & _DATA_RDY:
                self._set_int(True)
                if not self.registers[_INT_PIN_CFG] & _LATCH_INT:
                    self._set_int(False)  # a pulse of 50 us
        return True

    def begin_read(self) -> None:
        """Latch the data words, so that one burst is one sample (unless shadowed is False)."""
        self._latched[:] = self.registers[_ACCEL_XOUT_H : _GYRO_ZOUT_L + 1]

    def read(self, register: int) -> int:
        """The byte at register, with what reading it changes."""
        self._require(register, READ)
        value = self._value(register)
        if register == _INT_STATUS or self.registers[_INT_PIN_CFG] & _ANY_READ_CLEARS:
            self.registers[_INT_STATUS] = 0
            self._set_int(False)
        return value

    def write(self, register: int, value: int) -> None:
        """Put value at register, with what writing it starts."""
        self._require(register, WRITE)
        if register == _PWR_MGMT_1 and value & 0x80:
            self.power_up()
            return
        if register == _PWR_MGMT_1 and self.asleep and not value & 0x40:
            self._awake_us = 0
            self._phase_us = 0
        if register == _SIGNAL_PATH_RESET:
            value = 0
        if register == _FIFO_R_W:
            self.fifo.put(value)
        if register == _MEM_R_W:
            self._dmp[self._next_in_dmp()] = value
        if register == _ACCEL_CONFIG2 and self._size_chosen:
            self.fifo = Fifo(min(self._fifo_bytes, 512 << (value >> 6)))
        if register == _USER_CTRL:
            if value & 0x04:
                self.fifo.clear()
            value &= 0xF0
        self.registers[register] = value

    def next_register(self, register: int) -> int:
        """Where a burst goes on: FIFO_R_W and MEM_R_W stay, everything else counts up."""
        return register if register in (_FIFO_R_W, _MEM_R_W) else (register + 1) & 0xFF

    def _value(self, register: int) -> int:
        if register == _FIFO_R_W:
            return self.fifo.get()
        if register == _MEM_R_W:
            return self._dmp.get(self._next_in_dmp(), 0)
        if register == _FIFO_COUNT_H:
            self.registers[_FIFO_COUNT_L] = self.fifo.count & 0xFF
            return self.fifo.count >> 8
        if self.shadowed and _ACCEL_XOUT_H <= register <= _GYRO_ZOUT_L:
            return self._latched[register - _ACCEL_XOUT_H]
        value = self.registers[register]
        if register == _INT_STATUS and self.fifo.overflowed:
            self.fifo.overflowed = False
            value |= _FIFO_OFLOW
        return value

    def _set_int(self, active: bool) -> None:
        if active != self._int_active:
            self._int_active = active
            if self.interrupt:
                self.interrupt()

    def _next_in_dmp(self) -> "tuple[int, int]":
        """Bank and address of MEM_R_W, which then counts up."""
        place = (self.registers[_BANK_SEL], self.registers[_MEM_START_ADDR])
        self.registers[_MEM_START_ADDR] = (place[1] + 1) & 0xFF
        return place

    def _physical_sample(self) -> "Sequence[int]":
        registers = self.registers
        shift = 2 if self.part == "ICM-20690" else 3
        lsb_per_g = 16384 >> (registers[_ACCEL_CONFIG] >> 3 & 3)
        lsb_per_dps = _GYRO_LSB_PER_DPS[registers[_GYRO_CONFIG] >> shift & 3]
        bandwidth_hz = _BANDWIDTH_HZ[registers[_CONFIG] & 7]
        scales = (lsb_per_g, self._temp_scale[0], self._temp_scale[1], lsb_per_dps)
        return self._physical.words(self.period_us, bandwidth_hz, scales)  # type: ignore

    def _require(self, register: int, kind: int) -> None:
        if not self._access[register] & kind:
            verb = "read" if kind == READ else "written"
            text = "register 0x{:02x} of {} is not to be {}"
            raise UnknownRegister(text.format(register, self.part, verb))

    def _store(self, sample: "Sequence[int]") -> None:
        standby = self.registers[_PWR_MGMT_2]
        for i in range(7):
            if standby & _STANDBY_BIT[i] or (i == 3 and self.registers[_PWR_MGMT_1] & 0x08):
                continue
            word = max(-32768, min(32767, sample[i] + self._self_test(i))) & 0xFFFF
            self.registers[_ACCEL_XOUT_H + 2 * i] = word >> 8
            self.registers[_ACCEL_XOUT_H + 2 * i + 1] = word & 0xFF

    def _self_test(self, i: int) -> int:
        config = self.registers[_ACCEL_CONFIG if i < 3 else _GYRO_CONFIG]
        if i == 3 or not config & (0x80 >> (i % 4)):
            return 0
        return self.self_test_response[i]

    def _fill_fifo(self) -> None:
        if not self.registers[_USER_CTRL] & 0x40:
            return
        self.fifo.keep_oldest = bool(self._access[0] and self.registers[_CONFIG] & 0x40)
        for i in range(7):
            if self.registers[_FIFO_EN] & _FIFO_BIT[i]:
                self.fifo.put(self.registers[_ACCEL_XOUT_H + 2 * i])
                self.fifo.put(self.registers[_ACCEL_XOUT_H + 2 * i + 1])
