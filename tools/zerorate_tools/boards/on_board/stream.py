"""Runs on the board: streams samples to standard output as frames.py describes, until Ctrl-C."""

import json
import sys
import time
from array import array
from binascii import crc32

from zerorate_i2c.mpu6050 import RESTARTED

_SCALES_EVERY = 200
_SEEN_BEFORE = 0x80


class Streamer:
    """Frames of imu's samples written by write; seconds None is until interrupted."""

    def __init__(self, imu, write):
        self.imu = imu
        self.write = write
        self.sequence = 0
        self.frame = bytearray(4 + 21 + 4)
        self.frame[0:4] = b"\xa5\x5a\x01\x15"
        self.sample = array("i", [0] * 7)

    def send_sample(self, status, ticks_us):
        """The sample just read."""
        frame = self.frame
        _put(frame, 4, self.sequence, 2)
        _put(frame, 6, ticks_us & 0x3FFFFFFF, 4)
        frame[10] = status
        at = 11
        for word in self.sample:
            frame[at] = word >> 8 & 0xFF
            frame[at + 1] = word & 0xFF
            at += 2
        _put(frame, at, crc32(memoryview(frame)[:at]), 4)
        self.write(frame)
        self.sequence = (self.sequence + 1) & 0xFFFF

    def send_scales(self):
        """What the samples mean."""
        imu = self.imu
        self.send_text(
            2,
            json.dumps(
                {
                    "part": imu.part,
                    "odr_hz": imu.odr_hz,
                    "gyro_lsb_per_dps": imu.gyro_lsb_per_dps,
                    "accel_lsb_per_g": imu.accel_lsb_per_g,
                    "temp_lsb_per_degc": imu.temp_lsb_per_degc,
                    "temp_offset_degc": imu.temp_offset_degc,
                    "binding": list(imu.binding),
                }
            ),
        )

    def send_text(self, kind, text):
        """A frame of text, cut to what fits."""
        payload = text.encode()[:255]
        body = b"\xa5\x5a" + bytes([kind, len(payload)]) + payload
        check = bytearray(4)
        _put(check, 0, crc32(body), 4)
        self.write(body + check)

    def run(self, wait):
        """Send each sample that wait() announces."""
        imu = self.imu
        self.send_scales()
        while True:
            if self.sequence % _SCALES_EVERY == _SCALES_EVERY - 1:
                self.send_scales()
            wait()
            repeats = imu.repeats
            try:
                status = imu.read(self.sample)
            except OSError as error:
                self.send_text(3, "bus: " + str(error))
                imu.clock.sleep_ms(100)
                continue
            if status == RESTARTED:
                self.send_text(3, "restarted")
            elif imu.repeats == repeats:
                self.send_sample(status, imu.clock.ticks_us())
            elif status:
                self.send_sample(status | _SEEN_BEFORE, imu.clock.ticks_us())


def _put(buffer, at, value, count):
    for i in range(count):
        buffer[at + i] = value & 0xFF
        value >>= 8


def every(period_us):
    """A wait() for boards without the interrupt wired: twice as often as samples come."""
    pause_s = period_us / 2e6

    def wait():
        time.sleep(pause_s)

    return wait


def stream(imu):
    """Stream imu, an MPU6050, to standard output."""
    Streamer(imu, sys.stdout.buffer.write).run(every(imu.period_us))
