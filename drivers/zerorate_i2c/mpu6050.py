"""One chip of the MPU-6050 family: set-up, whole samples, and its faults found and answered."""

try:
    import utime as system_clock  # a board's own: a Pico need not read a file for 10 ms
except ImportError:
    from . import clock as system_clock  # type: ignore[no-redef]
from .registers import Registers, unload

TYPE_CHECKING = False
if TYPE_CHECKING:
    from array import array
    from typing import Any

const = int  # on a board the compiler itself reads const(...)

_WHO_AM_I = const(0x75)
_PWR_MGMT_1 = const(0x6B)
_DEVICE_RESET = const(0x80)
_RESET_MS = const(100)

FRESH = const(0)  # a sample
VERIFIED = const(1)  # a sample, and the configuration was read back right just before it
RESTARTED = const(2)  # no sample: the configuration was lost and has been written again
SUSPECT = const(3)  # no measurement can look like this frame: do not learn from it


class MPU6050(Registers):
    """A chip at address on i2c, configured and awake when the constructor returns.

    full_scale_dps is 250, 500, 1000 or 2000; full_scale_g 2, 4, 8 or 16; odr_hz the output data
    rate; dlpf_hz the gyro's low-pass bandwidth (None: the widest below half of odr_hz). The
    values taken are attributes: odr_hz, dlpf_hz, gyro_lsb_per_dps, accel_lsb_per_g,
    temp_lsb_per_degc, temp_offset_degc (these five together: scales), fifo_bytes, part, who_am_i.
    kept_power: whether the chip had this very configuration already, from a program before.

    The configuration is read back every check_every samples; a transfer is tried 1 + retries
    times. Raises ValueError for a value no part can take, OSError where no part, an unknown part
    or one that does not keep its configuration answers. part names the part where its WHO_AM_I
    is of no genuine one, for example part="MPU-6500". clock has the functions of clock.py.

    Counters: bus_errors, read_backs (of the configuration, right), restarts, suspects (frames that
    are no measurement), repeats (samples read before), torn (read again and found different).
    """

    # set by settings.py, which is let go behind the constructor
    part: str
    temp_lsb_per_degc: float
    temp_offset_degc: float
    fifo_bytes: int
    start_up_ms: int
    kind: int
    dlpf_hz: float
    odr_hz: float
    period_us: int
    full_scale_dps: int
    gyro_lsb_per_dps: float
    accel_lsb_per_g: float
    scales: "tuple[float, float, float, float, float]"
    binding: bytes
    _data: "Any" = None

    def __init__(
        self,
        i2c: "Any",
        address: int = 0x68,
        full_scale_dps: int = 250,
        full_scale_g: int = 2,
        odr_hz: float = 100,
        dlpf_hz: "float | None" = None,
        part: "str | None" = None,
        check_every: int = 100,
        retries: int = 2,
        clock: "Any" = None,
    ) -> None:
        super().__init__(i2c, address, retries)
        self.clock = clock or system_clock
        self.restarts = 0
        self.read_backs = 0
        self.suspects = 0
        self.repeats = 0
        self.torn = 0
        self._check_every = check_every
        self._until_check = check_every
        self._errors_seen = 0
        self._frozen = False
        # loaded here and let go: who has an object of it needs no more than its registers
        from .identity import identify

        self.who_am_i, row = identify(self, part)
        unload("identity")
        from .settings import settle

        self._settings = settle(self, row, full_scale_dps, full_scale_g, odr_hz, dlpf_hz)
        unload("settings")
        unload("parts")
        self.kept_power = self._is_configured()
        self.configure()

    def read(self, sample: "array[int]") -> int:
        """Fill sample, array('i') of ax ay az temp gx gy gz in raw LSB, from one burst.

        Returns FRESH, VERIFIED, RESTARTED or SUSPECT. What was learned from samples since the
        last VERIFIED is in doubt after RESTARTED and after OSError, which passes when the bus
        fails 1 + retries times or another part answers. A sample that leaps is read twice, in
        case a clone tore it (counted in torn). Allocates nothing behind the first while all is
        well.
        """
        status = self.verify(1)
        if status != RESTARTED and not self._data_registers().read(sample):
            return SUSPECT
        return status

    def read_sample(self, sample: "array[int]") -> None:
        """Fill sample from one burst, unexamined."""
        self._data_registers().read_sample(sample)

    def _data_registers(self):
        if self._data is None:  # loaded here: who reads a FIFO has no memory taken by it
            from .data_registers import DataRegisters

            self._data = DataRegisters(self)
        return self._data

    def verify(self, samples: int) -> int:
        """Read the configuration back if it is time to, samples more being taken on trust.

        Returns FRESH when it was not time, VERIFIED, or RESTARTED after configuring again.
        """
        if self._until_check > 0 and self.bus_errors == self._errors_seen:
            self._until_check -= samples
            return FRESH
        if self._frozen or not self.check():
            self.restart()
            return RESTARTED
        self._until_check -= samples
        return VERIFIED

    def doubt(self, frozen: bool) -> None:
        """Count a frame that is no measurement: verify before the next; frozen needs a restart."""
        self.suspects += 1
        self._until_check = 0
        self._frozen = frozen

    def check(self) -> bool:
        """True when every register set still reads back as it was written.

        Raises OSError when the id read is no longer the one of the constructor.
        """
        self._until_check = 0
        now = self.read_register(_WHO_AM_I)
        if now != self.who_am_i:
            raise _wrong_device(self, now, f"was 0x{self.who_am_i:02x}")
        if not self._is_configured():
            return False
        self.read_backs += 1
        self._errors_seen = self.bus_errors
        self._until_check = self._check_every
        return True

    def configure(self) -> None:
        """Reset the chip, write its configuration and wait until it measures."""
        self._frozen = False
        self.write_register(_PWR_MGMT_1, _DEVICE_RESET)
        self.clock.sleep_ms(_RESET_MS)
        settings = self._settings
        for i in range(0, len(settings), 2):
            self.write_register(settings[i], settings[i + 1])
        if not self.check():
            self._until_check = 0
            raise _wrong_device(self, self.who_am_i, "does not keep what is written")
        self.clock.sleep_ms(self.start_up_ms)
        self.changed_us = self.clock.ticks_us()

    def restart(self) -> None:
        """Reset the chip and write its configuration again; OSError when it does not keep it."""
        self.restarts += 1
        self.configure()

    def keep_setting(self, register: int, value: int) -> None:
        """Write a register now and after every restart, and read it back with the others."""
        settings = self._settings
        for i in range(0, len(settings), 2):
            if settings[i] == register:
                settings[i + 1] = value
                break
        else:
            settings.extend(bytes([register, value]))
        self.write_register(register, value)

    def temperature_degc(self, raw: int) -> float:
        """Degrees Celsius of a raw temperature reading, by this part's formula."""
        return raw / self.temp_lsb_per_degc + self.temp_offset_degc

    def _is_configured(self):
        for i in range(0, len(self._settings), 2):
            if not self._is_kept(i):
                return False
        return True

    # small frames: one of more than eleven words would take heap at every call
    def _is_kept(self, i):
        return self.read_register(self._settings[i]) == self._settings[i + 1]


def _wrong_device(registers, who_am_i, rest):
    from .identity import wrong_device

    return wrong_device(registers, who_am_i, rest)
