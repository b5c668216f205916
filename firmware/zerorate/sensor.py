"""What the samples are."""


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
        if not 0.01 <= odr_hz <= 8000:
            raise ValueError("odr_hz must be 0.01..8000, not %s" % odr_hz)
        if not 1 <= gyro_lsb_per_dps <= 8000:
            raise ValueError("gyro_lsb_per_dps must be 1..8000, not %s" % gyro_lsb_per_dps)
        if accel_lsb_per_g and not 1 <= accel_lsb_per_g <= 32768:
            raise ValueError("accel_lsb_per_g must be 0 or 1..32768, not %s" % accel_lsb_per_g)
        if temp_lsb_per_degc and not 1 <= temp_lsb_per_degc <= 2000:
            raise ValueError("temp_lsb_per_degc must be 0 or 1..2000, not %s" % temp_lsb_per_degc)
        self.odr_hz = odr_hz
        self.gyro_lsb_per_dps = gyro_lsb_per_dps
        self.accel_lsb_per_g = accel_lsb_per_g
        self.temp_lsb_per_degc = temp_lsb_per_degc
        self.temp_offset_degc = temp_offset_degc
