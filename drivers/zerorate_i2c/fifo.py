"""The chip's FIFO as a stream of samples, each with the time since the one before it."""

from array import array

from .mpu6050 import RESTARTED, SUSPECT
from .registers import decode

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .mpu6050 import MPU6050

const = int  # on a board the compiler itself reads const(...)

_FIFO_EN = const(0x23)
_INT_STATUS = const(0x3A)
_USER_CTRL = const(0x6A)
_FIFO_COUNT_H = const(0x72)
_FIFO_R_W = const(0x74)
_ALL_SENSORS = const(0xF8)
_FIFO_ON = const(0x40)
_FIFO_RESET = const(0x04)
_FIFO_OFLOW = const(0x10)
_FRAME = const(14)
_SAME_LIMIT = const(8)
_SILENT_PERIODS = const(16)
_TEMP_JUMP_LSB = const(400)

EMPTY = const(4)  # no sample is waiting


class Fifo:
    """Samples of imu, an MPU6050, out of its FIFO, up to batch frames a transfer.

    After read() dt_us is the time in microseconds from the sample before to this one, over any
    loss, and 0 for RESTARTED; newest_us is when this one was taken, by the clock. Counters: frames
    delivered, lost samples (of overflow, lost alignment, bus errors and restarts; estimated from
    time), overflows, misalignments. Raises ValueError for a batch that the bus cannot transfer.
    """

    def __init__(self, imu: "MPU6050", batch: int = 8) -> None:
        limit = getattr(imu.i2c, "max_burst", 0)
        if limit:
            batch = min(batch, limit // _FRAME)
        if batch < 1:
            raise ValueError("a batch is of at least one frame of 14 bytes")
        self.imu = imu
        self.dt_us = 0
        self.frames = 0
        self.lost = 0
        self.overflows = 0
        self.misalignments = 0
        self._byte = bytearray(1)
        self._pair = bytearray(2)
        self._block = bytearray(batch * _FRAME)
        self._views = [memoryview(self._block)[: n * _FRAME] for n in range(1, batch + 1)]
        self._view = self._views[0]
        self._status = 0
        self._step_us = imu.period_us
        self._gap_us = 0
        self._same = 0
        self._before = array("i", [0] * 7)
        imu.keep_setting(_FIFO_EN, _ALL_SENSORS)
        imu.keep_setting(_USER_CTRL, _FIFO_ON)
        self._begin(imu.clock.ticks_us())

    def read(self, sample: "array[int]") -> int:
        """Fill sample, array('i') of 7, with the oldest frame, and set dt_us.

        Returns FRESH, VERIFIED, RESTARTED, SUSPECT (see MPU6050.read) or EMPTY; sample is filled
        for FRESH, VERIFIED and SUSPECT. OSError passes when the bus fails for good.
        """
        status = 0
        if self._next == self._loaded:
            status = self._load()
            if status >= RESTARTED:
                return status
        return self._deliver(sample, status)

    def stop(self) -> None:
        """Leave the chip without its FIFO."""
        self.imu.keep_setting(_USER_CTRL, 0)
        self.imu.keep_setting(_FIFO_EN, 0)

    def _load(self):
        """Fill the block with the oldest frames; EMPTY, RESTARTED, or what verify said."""
        status = self.imu.verify(len(self._views))
        now_us = self.imu.clock.ticks_us()
        if status == RESTARTED or self._dirty:
            self._lose(now_us)
            self.dt_us = 0  # the next sample's has it all
            return RESTARTED if status == RESTARTED else EMPTY
        self._status |= status
        count = self._count(now_us)
        if count == 0 or not self._take(count, now_us):
            return EMPTY
        status = self._status
        self._status = 0
        return status

    def _count(self, now_us):
        """Frames waiting; 0 also after the FIFO had to be emptied."""
        self.imu.read_into(_INT_STATUS, self._byte)
        size = self._count_bytes()
        if self._byte[0] & _FIFO_OFLOW or size > self.imu.fifo_bytes - _FRAME:
            self.overflows += 1
            self._lose(now_us)
            return 0
        # A frame may be half written when the count is read; a moment later it is whole.
        if size % _FRAME and self._count_bytes() % _FRAME:
            self._misaligned(now_us)
            return 0
        if size < _FRAME:
            self._mind_silence(now_us)
        return size // _FRAME

    def _count_bytes(self):
        self.imu.read_into(_FIFO_COUNT_H, self._pair)
        return self._pair[0] << 8 | self._pair[1]

    def _take(self, count, now_us):
        self._align(count, now_us)
        taken = min(count, len(self._views))
        self._view = self._views[taken - 1]
        if not self._transfer():
            self._lose(now_us)
            return False
        self._next = 0
        self._loaded = taken
        return True

    def _transfer(self):
        """Never tried again: what was read before the bus failed is gone from the FIFO."""
        try:
            self.imu.i2c.readfrom_mem_into(self.imu.address, _FIFO_R_W, self._view)
        except OSError:
            self.imu.bus_errors += 1
            self._dirty = True
        return not self._dirty

    def _align(self, count, now_us):
        """Choose the time step so that the newest of count frames is at most a period old."""
        period_us = self.imu.period_us
        age_us = self.imu.clock.ticks_diff(now_us, self.newest_us) - count * period_us
        if age_us < 0:
            self._step_us = period_us - (-age_us + count - 1) // count
        elif age_us > period_us:
            self._step_us = period_us + (age_us - period_us) // count
        else:
            self._step_us = period_us

    def _deliver(self, sample, status):
        decode(self._block, _FRAME * self._next, sample)
        self._next += 1
        self.newest_us = self.imu.clock.ticks_add(self.newest_us, self._step_us)
        self._gap_us += self._step_us
        if self._jumped(sample):
            self.lost += 1
            self.dt_us = 0
            self._misaligned(self.imu.clock.ticks_us())
            return SUSPECT
        self.dt_us = self._gap_us
        self._gap_us = 0
        self.frames += 1
        if self._is_doubtful(sample):
            self.imu.doubt(self._same >= _SAME_LIMIT)
            return SUSPECT
        return status

    def _jumped(self, sample):
        """Lost alignment that the count does not show: temperature leaps as only it can make it."""
        jump = sample[3] - self._before[3]
        known = self._temp_known
        self._temp_known = True
        return known and (jump >= _TEMP_JUMP_LSB or jump <= -_TEMP_JUMP_LSB)

    def _is_doubtful(self, sample):
        """Several frames all alike, or one whose words are all alike."""
        before = self._before
        alike = True
        flat = True
        for i in range(7):
            if sample[i] != before[i]:
                alike = False
            if sample[i] != sample[0]:
                flat = False
            before[i] = sample[i]
        self._same = self._same + 1 if alike else 0
        return flat or self._same >= _SAME_LIMIT

    def _mind_silence(self, now_us):
        """No frame for long: the chip sleeps or has stopped."""
        silent_us = self.imu.clock.ticks_diff(now_us, self.newest_us)
        if silent_us > _SILENT_PERIODS * self.imu.period_us:
            self.imu.doubt(True)

    def _misaligned(self, now_us):
        self.misalignments += 1
        self._lose(now_us)

    def _lose(self, now_us):
        """Empty the FIFO at now_us, count what is gone and carry its time to the next sample."""
        self._dirty = True
        self.imu.write_register(_USER_CTRL, _FIFO_RESET)
        self.imu.write_register(_USER_CTRL, _FIFO_ON)
        gone_us = self.imu.clock.ticks_diff(now_us, self.newest_us)
        if gone_us < 0:  # more than 9 minutes by a board's clock, which wraps after 18
            gone_us &= 0x3FFFFFFF
        self.lost += gone_us // self.imu.period_us
        self._gap_us += gone_us
        self._begin(now_us)
        self._gap_us -= self.imu.clock.ticks_diff(now_us, self.newest_us)

    def _begin(self, now_us):
        """The FIFO is empty now: the sample before its first was taken half a period ago."""
        self.newest_us = self.imu.clock.ticks_add(now_us, -self.imu.period_us // 2)
        self._loaded = 0
        self._next = 0
        self._same = 0
        self._temp_known = False
        self._dirty = False
