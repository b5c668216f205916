"""What the samples are."""


def _within(name, value, least, most, absent=""):
    if not least <= value <= most:
        raise ValueError("%s must be %s%s..%s, not %s" % (name, absent, least, most, value))
    return value


class Sensor:
    """What one LSB is and how often it comes.

    odr_hz: output data rate; gyro_lsb_per_dps, accel_lsb_per_g, temp_lsb_per_degc: scales, 0 for
    a channel that is absent (its words are 0 in every sample). odr_hz is 0.01..8000,
    gyro_lsb_per_dps 1..8000, accel_lsb_per_g 0 or 1..32768, temp_lsb_per_degc 0 or 1..2000; outside
    of these it raises ValueError.
    """

    def __init__(
        self,
        odr_hz: float = 100.0,
        gyro_lsb_per_dps: float = 131.0,
        accel_lsb_per_g: float = 16384.0,
        temp_lsb_per_degc: float = 340.0,
        temp_offset_degc: float = 36.53,
    ) -> None:
        self.odr_hz = _within("odr_hz", odr_hz, 0.01, 8000)
        self.gyro_lsb_per_dps = _within("gyro_lsb_per_dps", gyro_lsb_per_dps, 1, 8000)
        self.accel_lsb_per_g = accel_lsb_per_g and _within(
            "accel_lsb_per_g", accel_lsb_per_g, 1, 32768, "0 or "
        )
        self.temp_lsb_per_degc = temp_lsb_per_degc and _within(
            "temp_lsb_per_degc", temp_lsb_per_degc, 1, 2000, "0 or "
        )
        self.temp_offset_degc = temp_offset_degc
