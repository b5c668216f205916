"""Turns settings in physical units into the integers that the kernels read, once."""

from array import array


def power_of_two(samples):
    """Return the shift of the power of two nearest to `samples`, 2..8."""
    shift = 2
    while shift < 8 and samples * 2 > 3 << shift:
        shift += 1
    return shift


def squared(value, most=1 << 28):
    """Return the square of `value`, at least 1."""
    return max(1, min(most, int(value * value)))


class Sensor:
    """What one LSB is and how often it comes.

    odr_hz: output data rate; gyro_lsb_per_dps, accel_lsb_per_g, temp_lsb_per_degc: scales, 0 for
    a channel that is absent (its words are 0 in every sample). Raises ValueError.
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
        if not 0 <= accel_lsb_per_g <= 32768:
            raise ValueError("accel_lsb_per_g must be 0..32768, not %s" % accel_lsb_per_g)
        if not 0 <= temp_lsb_per_degc <= 2000:
            raise ValueError("temp_lsb_per_degc must be 0..2000, not %s" % temp_lsb_per_degc)
        self.odr_hz = odr_hz
        self.gyro_lsb_per_dps = gyro_lsb_per_dps
        self.accel_lsb_per_g = accel_lsb_per_g
        self.temp_lsb_per_degc = temp_lsb_per_degc
        self.temp_offset_degc = temp_offset_degc


def settings(sensor, bins, short, long, document, every, ignore_outside, limits):
    """Return the kernels' settings, array('i') of 52 words; `limits` is as in `Corrector`."""
    c = array("i", [0] * 52)
    windows(c, sensor, limits)
    bins_of(c, sensor, bins, every, document, limits)
    c[22] = 1 if ignore_outside else 0
    c[46] = 1 if every else 0
    estimators_of(c, sensor, short, long, document, limits)
    recent_of(c, sensor, limits)
    c[0] = 95 + c[25]
    c[13] = 32 + c[25] * c[26]
    c[12] = 9 // c[3] + 1
    return c


def windows(c, sensor, limits):
    """Guard, window and stillness."""
    lsb = sensor.gyro_lsb_per_dps
    accel = sensor.accel_lsb_per_g
    c[4] = power_of_two(limits["window_s"] * sensor.odr_hz)
    c[3] = 1 << c[4]
    window_s = c[3] / sensor.odr_hz
    c[5] = max(1, min(4, int(limits["segment_s"] / window_s + 0.5)))
    c[1] = int(min(0x1FFFFFFF, max(0.1e6, 10e6 / sensor.odr_hz)))
    jump_degc = max(400 / 340, 0.5 / sensor.odr_hz)
    c[2] = int(jump_degc * sensor.temp_lsb_per_degc) or 0xFFFF
    c[7] = squared(limits["still_dps"] * lsb * 16)
    c[8] = squared(limits["still_g"] * accel * 16)
    seconds = max(1, c[5] - 1) * window_s
    c[9] = squared(limits["turn_dps"] * seconds * 0.0174533 * accel * 16)
    c[10] = squared(limits["change_dps"] * lsb * 16)
    c[11] = max(1, min(1 << 24, int(limits["slew_dps_per_s"] * lsb * 256 / sensor.odr_hz)))


def bins_of(c, sensor, bins, every, document, limits):
    """The histograms."""
    if not 4 <= bins < 20:
        raise ValueError("bins must be 4..19, not %d" % bins)
    half = min(32000, int(limits["range_dps"] * sensor.gyro_lsb_per_dps))
    narrow = max(4, int(limits["narrowest_dps"] * sensor.gyro_lsb_per_dps))
    c[16] = bins
    c[18] = max(1, 2 * half // bins) if every else narrow
    # the first reading stands in the middle of a bin, not on an edge
    c[17] = -(c[18] * bins) // 2 if every else -(bins // 2) * narrow - narrow // 2
    c[19] = 1 if document else narrow
    c[20] = 2 if document else 4
    c[21] = 1 if document else 0
    c[23] = max(1, int(limits["split_s"] * sensor.odr_hz)) if document else 64


def estimators_of(c, sensor, short, long, document, limits):
    """The estimators and the line through them."""
    if not 1 <= short <= 6 or not 1 <= long or short + long > 18:
        raise ValueError("short must be 1..6 and short + long at most 18")
    degree = sensor.temp_lsb_per_degc or 1000.0
    rate = sensor.odr_hz
    c[24] = short
    c[25] = 1 + short + long
    c[26] = 4 + 2 * c[16] + 1
    c[14] = 32 + c[26]
    c[47] = 32 + (1 + short) * c[26]
    c[15] = 32 + c[25] * c[26]
    c[27] = max(2, int(limits["step_degc"] * degree))
    c[28] = max(1, int(limits["margin_degc"] * degree))
    c[29] = max(2, int(limits["promote_s"] * rate))
    c[30] = max(16, min(1 << 28, int(limits["halve_after_s"] * rate)))
    c[31] = max(2, int(limits["fit_s"] * rate))
    c[32] = (
        0xFFFFF // (c[25] - 1) if document else max(16, min(8192, int(limits["counted_s"] * rate)))
    )
    c[42] = 0
    while (int(degree * 16) >> (c[42] + 1)) >= 8:
        c[42] += 1
    unit = degree * 16 / (1 << c[42])
    c[33] = 0 if document else squared(limits["local_degc"] * unit, 1 << 14)
    c[51] = c[33] * max(1, 2048 // c[32])
    c[34] = max(2, int(limits["stable_s"] * rate))
    c[35] = int(limits["share"] * 256)
    c[36] = int(limits["beyond_degc"] * degree * 16)
    c[43] = max(1, int(limits["refit_degc"] * degree))


def recent_of(c, sensor, limits):
    """The offset that follows what the curve does not explain."""
    lsb = sensor.gyro_lsb_per_dps
    segment_s = c[5] * c[3] / sensor.odr_hz
    c[37] = squared(limits["floor_dps"] * lsb * 16)
    c[38] = max(1, min(0x7FFF, int(limits["gate_dps"] * lsb * 16)))
    c[39] = max(3, int(limits["insist_s"] / segment_s + 0.5))
    c[40] = squared(limits["walk_least_dps"] * lsb * 256)
    c[41] = squared(limits["walk_most_dps"] * lsb * 256, 1 << 23)
    c[44] = max(1, int(limits["turn_dps"] * lsb * 256))
    c[45] = squared(limits["turn_on_dps"] * lsb * 16)
    slope = limits["slope_dps_per_degc"] * lsb / (sensor.temp_lsb_per_degc or 1000.0)
    c[50] = max(1, min(4095, int(slope * 65536)))
    c[48] = max(1, min(8191, int(limits["motion_most_dps"] * lsb * 64)))
    c[49] = int(min(1 << 29, 256 * squared(limits["motion_full_dps"] * lsb * 64)))
