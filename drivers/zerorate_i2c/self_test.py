"""The chip's own test: its electrodes move the masses, and the answer is held to factory trim.

MPU-6050: RM-MPU-6000A-00 rev 4.2 registers 13-16, within 14 % of trim. Later parts: InvenSense
AN-MPU-6500/AN-000143: gyro above half of trim, accelerometer 0.5 to 1.5 of it. Floats: not hot.
"""

from array import array

from .parts import ICM20690_KIND, MPU6050_KIND
from .registers import unload
from .settings import GYRO_LSB_PER_DPS

unload("parts")
unload("settings")

TYPE_CHECKING = False
if TYPE_CHECKING:
    from .mpu6050 import MPU6050

const = int  # on a board the compiler itself reads const(...)

_SELF_TEST_GYRO_6500 = const(0x00)
_SELF_TEST = const(0x0D)
_CONFIG = const(0x1A)
_GYRO_CONFIG = const(0x1B)
_ACCEL_CONFIG = const(0x1C)
_ST_BITS = const(0xE0)
_AFS_8G = const(0x10)
_DLPF_98HZ = const(2)
_SETTLE_MS = const(50)


def self_test(imu: "MPU6050", samples: int = 50) -> "tuple[bool, list[float | None]]":
    """Test imu, an MPU6050, at rest; its configuration is written again afterwards.

    Returns (passed, [response / factory trim] * 6 for ax ay az gx gy gz); a ratio is None where
    the factory left no trim, and such an axis does not pass. Takes 0.5 s and more. OSError passes.
    """
    accel_range = _AFS_8G if imu.kind == MPU6050_KIND else 0
    try:
        imu.write_register(_CONFIG, _DLPF_98HZ)
        rest = _mean(imu, 0, accel_range, samples)
        moved = _mean(imu, _ST_BITS, _ST_BITS | accel_range, samples)
        trim = _trim_6050(imu) if imu.kind == MPU6050_KIND else _trim_6500(imu)
    finally:
        imu.configure()
    ratios = []
    for i in range(6):
        ratios.append((moved[i] - rest[i]) / trim[i] if trim[i] else None)
    return _passed(imu.kind, ratios), ratios


def _mean(imu, gyro_config, accel_config, samples):
    """Mean ax ay az gx gy gz in LSB with these range registers."""
    if imu.kind == ICM20690_KIND:
        gyro_config &= _ST_BITS
    imu.write_register(_GYRO_CONFIG, gyro_config)
    imu.write_register(_ACCEL_CONFIG, accel_config)
    imu.clock.sleep_ms(_SETTLE_MS)
    sample = array("i", [0] * 7)
    total = [0] * 6
    for _ in range(samples):
        imu.clock.sleep_ms(-(-imu.period_us // 1000))
        imu.read_sample(sample)
        for i in range(6):
            total[i] += sample[i if i < 3 else i + 1]
    return [value / samples for value in total]


def _trim_6050(imu):
    """Factory trim in LSB at +-8 g and +-250 dps from the packed codes of 5 bits."""
    codes = bytearray(4)
    imu.read_into(_SELF_TEST, codes)
    trim = []
    for i in range(3):
        code = codes[i] >> 5 << 2 | codes[3] >> (4 - 2 * i) & 3
        trim.append(4096 * 0.34 * (0.92 / 0.34) ** ((code - 1) / 30) if code else 0)
    for i in range(3):
        code = codes[i] & 0x1F
        sign = -1 if i == 1 else 1
        trim.append(sign * 25 * GYRO_LSB_PER_DPS[0] * 1.046 ** (code - 1) if code else 0)
    return trim


def _trim_6500(imu):
    """Factory trim in LSB at +-2 g and +-250 dps from codes of one byte."""
    codes = bytearray(3)
    trim = []
    for register in (_SELF_TEST, _SELF_TEST_GYRO_6500):
        imu.read_into(register, codes)
        for code in codes:
            trim.append(2620 * 1.01 ** (code - 1) if code else 0)
    return trim


def _passed(kind, ratios):
    for i in range(6):
        if ratios[i] is None:
            return False
        low, high = (0.5, 1.5) if i < 3 else (0.5, 1000)
        if kind == MPU6050_KIND:
            low, high = 0.86, 1.14
        if not low < ratios[i] < high:
            return False
    return True
