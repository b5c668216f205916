"""What a service says, publishes and stores while its bus, chip, disk and power come and go."""

import math
from tempfile import TemporaryDirectory
from unittest import mock

import pytest
from zerorate.storage.places import FileStorage
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.errors import ZerorateError
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales
from zerorate_tools.service import Service, System


class _Disk(FileStorage):
    """A file that can be full, and notes when it is written."""

    is_full = False

    def write_pieces(self, offset, pieces):
        self.note("full" if self.is_full else f"written at {offset}")
        if self.is_full:
            raise OSError(28, "No space left on device")
        super().write_pieces(offset, pieces)


class _Reader:
    """A sink that ends the service at its last line but one."""

    def __init__(self, note, last):
        self.lost, self.lines, self._note, self._last = 0, [], note, last

    def put(self, line):
        self.lines.append(line.decode().strip())
        if len(self.lines) > self._last:
            raise KeyboardInterrupt

    def close(self):
        self._note("closed")


class _Device:
    """Two chips to choose from, their bus and clock, and a file; all that happens is noted."""

    def __init__(self, folder):
        self.events, self.odr_hz, self.ago_s, self.shifted_dps = [], 25, 0.0, 0.0
        self.systemd_is_gone = False
        felt = Physical(self._gyro_dps, (0.1, -0.25, 0.96), lambda t: 24 + t / 20)
        self.chips = [FakeMPU6050(felt, part) for part in ("MPU-6050", "MPU-6500")]
        self.clock = FakeClock()
        self.bus = FakeI2C({}, self.clock)
        self.put_in(0)
        self.disk = _Disk(f"{folder}/learned.bin")
        self.disk.note = self.note
        self.system = System(
            *(self._open, self.disk, self.clock, self.note, self._told), lambda: self.ago_s
        )
        self.begin()

    def _gyro_dps(self, now_s):
        beyond = 3 <= now_s < 7 and now_s % 1 < 0.26 - 0.04 * (now_s // 1)  # 4 samples, 3, 2 and 1
        return 400 if beyond else 0.31 + self.shifted_dps, -0.19, 0.08

    def note(self, text):
        self.events.append(f"{self.clock.now_us / 1000:.1f} {text}")

    def _told(self, text):
        self.note(text)
        if self.systemd_is_gone:
            raise OSError(111, "Connection refused")

    def _open(self):
        return MPU6050(self.bus, odr_hz=self.odr_hz, clock=self.clock)

    def put_in(self, number):
        """Put a chip in the place of the other, which the bus loses meanwhile."""
        self.clock.devices = [self.chips[number]]
        self.bus.devices[0x68] = self.chips[number]
        self.bus.fault("hang", times=3)

    def begin(self, model=b"", last=math.inf, readers=1):
        self.clock.now_us += 70_000_000  # switched off
        self.readers = [_Reader(self.note, last) for _ in range(readers)]
        self.service = Service(self.system, self.readers, model)

    def live(self, seconds):
        """Some lines of that long: the first, every 50th, and any behind a gap."""
        end_us, before = self.clock.now_us + seconds * 1e6, len(self.readers[0].lines)
        while self.clock.now_us < end_us:
            self.service.step()
        return self._told_of(self.readers[0].lines[before:])

    def end(self):
        """Lines of a life that ends itself."""
        self.service.run()
        return self._told_of(self.readers[0].lines)

    @staticmethod
    def _told_of(lines):
        return [line for at, line in enumerate(lines) if at % 50 == 0 or "gap" in line]


def _lives(device):
    """The lines of one life after the other."""
    device.disk.is_full = True
    yield device.live(12)
    device.bus.fault("hang", times=39)
    yield device.live(52)
    device.disk.is_full = False
    yield device.live(12)
    for number in (1, 0):
        device.put_in(number)
        yield device.live(5 + 4 * number)
    for ago_s, shifted_dps, last in ((3598, 0.1, 120), (-1, 0.2, 80), (0, 0.3, 80), (9e9, 0.3, 9)):
        device.ago_s, device.shifted_dps = ago_s, shifted_dps
        device.begin(last=last)
        yield device.end()
    device.disk.is_full = True
    device.begin(last=9)
    yield device.end()
    device.odr_hz, device.systemd_is_gone = 500, True
    device.begin(_model(500), last=300, readers=2)
    device.readers[1].lost = 3
    yield device.end()


def _refused(device):
    """What is said where a model is not of the device, or a service ends before it began."""
    device.odr_hz, device.systemd_is_gone = 25, False
    for model in (_model(25, temp_lsb_per_degc=326.8), _model(25, channel="vdd_mv"), b"none"):
        device.begin(model)
        with pytest.raises(ZerorateError) as refused:
            device.end()
        yield str(refused.value)
    with mock.patch.object(device.system, "open_imu", mock.Mock(side_effect=KeyboardInterrupt)):
        device.begin()
        yield from device.end()


def _model(odr_hz, temp_lsb_per_degc=340, channel="temp"):
    """A model that says 0.01 dps a degC on x."""
    slot = Slot(Term(channel, 0.0, 50.0, 5.0), (0.01, 0.0, 0.0))
    scales = Scales("MPU-6050", odr_hz, 131, 16384, temp_lsb_per_degc, 36.53)
    return encoded(build_model([slot], scales))


def served():
    """All that is published, said and stored."""
    with TemporaryDirectory() as folder:
        device = _Device(folder)
        lives = [*_lives(device)]
        refused = [*_refused(device)]
        events = [event.replace(folder, "FOLDER") for event in device.events]
    return {"lives": sum(lives, []), "refused": refused, "events": events}
