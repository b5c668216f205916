"""Physical units to register values: ranges, filter and sample rate of the MPU-6050 family.

Register map and descriptions: RM-MPU-6000A-00 rev 4.2, registers 25-28; RM-MPU-9250A-00 rev 1.4.
"""

from .parts import ICM20689_KIND, ICM20690_KIND, MPU6050_KIND

const = int  # on a board the compiler itself reads const(...)

_SMPLRT_DIV = const(0x19)
_CONFIG = const(0x1A)
_GYRO_CONFIG = const(0x1B)
_ACCEL_CONFIG = const(0x1C)
_ACCEL_CONFIG2 = const(0x1D)
_PWR_MGMT_1 = const(0x6B)
_PWR_MGMT_2 = const(0x6C)
_CLKSEL_GYRO_PLL = const(0x01)
_FIFO_SIZE_MAX = const(0xC0)

GYRO_RANGES_DPS = (250, 500, 1000, 2000)
ACCEL_RANGES_G = (2, 4, 8, 16)
GYRO_LSB_PER_DPS = (131.0, 65.5, 32.8, 16.4)
ACCEL_LSB_PER_G = (16384.0, 8192.0, 4096.0, 2048.0)
_DLPF_HZ_6050 = (256, 188, 98, 42, 20, 10, 5)
_DLPF_HZ_6500 = (250, 184, 92, 41, 20, 10, 5)


def index_of(value, allowed, what):
    """Position of value in allowed; ValueError names what was asked and what there is."""
    for i in range(len(allowed)):
        if allowed[i] == value:
            return i
    raise ValueError(f"{what} is one of {allowed}, not {value}")


def choose_filter(kind, odr_hz, dlpf_hz):
    """(DLPF_CFG, its bandwidth in Hz): the widest filter not wider than dlpf_hz.

    dlpf_hz None asks for half of odr_hz. DLPF_CFG 0 runs at 8 kHz and takes a divider on the
    MPU-6050 only, so the other kinds begin at 1.
    """
    table = _DLPF_HZ_6050 if kind == MPU6050_KIND else _DLPF_HZ_6500
    first = 0 if dlpf_hz is not None and kind == MPU6050_KIND else 1
    wanted = odr_hz / 2 if dlpf_hz is None else dlpf_hz
    for code in range(first, len(table)):
        if table[code] <= wanted:
            return code, table[code]
    if dlpf_hz is None:
        return len(table) - 1, table[-1]
    raise ValueError(f"dlpf_hz is one of {table}, not {dlpf_hz}")


def choose_divider(dlpf_code, odr_hz):
    """(SMPLRT_DIV, the output data rate in Hz that it gives); ValueError outside its range."""
    base_hz = 1000 if dlpf_code else 8000
    if odr_hz <= 0 or odr_hz > base_hz or round(base_hz / odr_hz) > 256:
        raise ValueError(f"odr_hz is {base_hz / 256} to {base_hz} with this filter, not {odr_hz}")
    divisor = round(base_hz / odr_hz)
    return divisor - 1, base_hz / divisor


def settle(imu, row, full_scale_dps, full_scale_g, odr_hz, dlpf_hz):
    """Give imu, an MPU6050 whose row of parts.PARTS this is, its attributes; its registers.

    Returns register_settings(...). Raises ValueError for a value that the part cannot take.
    """
    gyro_code = index_of(full_scale_dps, GYRO_RANGES_DPS, "full_scale_dps")
    accel_code = index_of(full_scale_g, ACCEL_RANGES_G, "full_scale_g")
    imu.part = row[1]
    imu.temp_lsb_per_degc = row[2]
    imu.temp_offset_degc = row[3]
    imu.fifo_bytes = row[4]
    imu.start_up_ms = row[5]
    imu.kind = row[6]
    dlpf_code, imu.dlpf_hz = choose_filter(imu.kind, odr_hz, dlpf_hz)
    divider, imu.odr_hz = choose_divider(dlpf_code, odr_hz)
    imu.period_us = round(1000000 / imu.odr_hz)
    imu.full_scale_dps = full_scale_dps
    imu.gyro_lsb_per_dps = GYRO_LSB_PER_DPS[gyro_code]
    imu.accel_lsb_per_g = ACCEL_LSB_PER_G[accel_code]
    imu.scales = (imu.odr_hz, imu.gyro_lsb_per_dps, imu.accel_lsb_per_g) + row[2:4]
    imu.binding = bytes([imu.who_am_i, gyro_code, accel_code, dlpf_code])
    return register_settings(imu.kind, gyro_code, accel_code, dlpf_code, divider)


def register_settings(kind, gyro_code, accel_code, dlpf_code, divider):
    """bytearray of (register, value) pairs, in the order in which they are written."""
    gyro_shift = 2 if kind == ICM20690_KIND else 3
    pairs = bytearray(
        [
            _PWR_MGMT_1,
            _CLKSEL_GYRO_PLL,
            _PWR_MGMT_2,
            0,
            _SMPLRT_DIV,
            divider,
            _CONFIG,
            dlpf_code,
            _GYRO_CONFIG,
            gyro_code << gyro_shift,
            _ACCEL_CONFIG,
            accel_code << 3,
        ]
    )
    if kind != MPU6050_KIND:
        large = _FIFO_SIZE_MAX if kind in (ICM20689_KIND, ICM20690_KIND) else 0
        pairs.extend(bytes([_ACCEL_CONFIG2, dlpf_code | large]))
    return pairs
