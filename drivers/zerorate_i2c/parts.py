"""The parts of the MPU-6050 register family, one row each, chosen by WHO_AM_I.

Temperature is raw / lsb_per_degc + offset_degc. Ids, FIFO sizes and start-up times are those of
the data sheets and of Linux's inv_mpu6050; the FIFO size of MPU-6880 and MPU-6886 has no second
source, so the smallest of the family is assumed: the driver then only overflows earlier.
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

const = int  # on a board the compiler itself reads const(...)

MPU6050_KIND = const(0)  # packed self-test, one DLPF for both sensors
MPU6500_KIND = const(1)  # ACCEL_CONFIG2, self-test codes a byte each
ICM20689_KIND = const(2)  # as MPU6500_KIND, FIFO size chosen in ACCEL_CONFIG2
ICM20690_KIND = const(3)  # as ICM20689_KIND, FS_SEL one bit lower

# temp_lsb_per_degc, temp_offset_degc, FIFO bytes, gyro start-up ms, kind
_MPU6050 = (340.0, 36.53, 1024, 60, MPU6050_KIND)
_MPU6500 = (333.87, 21.0, 512, 70, MPU6500_KIND)
_ICM20600 = (326.8, 25.0, 1008, 100, MPU6500_KIND)
_ICM20608 = (326.8, 25.0, 512, 70, MPU6500_KIND)
# WHO_AM_I, name, and these five
PARTS = (
    (0x68, "MPU-6050") + _MPU6050,
    (0x68, "MPU-6000") + _MPU6050,
    (0x68, "MPU-9150") + _MPU6050,
    (0x70, "MPU-6500") + _MPU6500,
    (0x71, "MPU-9250") + _MPU6500,
    (0x73, "MPU-9255") + _MPU6500,
    (0x74, "MPU-6515") + _MPU6500,
    (0x78, "MPU-6880") + _MPU6500,
    (0x11, "ICM-20600") + _ICM20600,
    (0x12, "ICM-20602") + _ICM20600,
    (0xAF, "ICM-20608") + _ICM20608,
    (0xAE, "ICM-20608D") + _ICM20608,
    (0xA6, "ICM-20609") + _ICM20608,
    (0x98, "ICM-20689", 326.8, 25.0, 4096, 70, ICM20689_KIND),
    (0x20, "ICM-20690", 326.8, 25.0, 1024, 80, ICM20690_KIND),
    (0xA9, "IAM-20680") + _ICM20608,
    (0x19, "MPU-6886") + _ICM20608,
)


def part_by_id(who_am_i: int) -> "Any":
    """First row whose WHO_AM_I is who_am_i, or None: 0x72, 0x00 and 0xFF belong to no part."""
    for row in PARTS:
        if row[0] == who_am_i:
            return row
    return None


def part_by_name(name: str) -> "Any":
    """Row of the part called name ("MPU-6500", "mpu6500"); ValueError lists the names known."""
    wanted = name.upper().replace("-", "")
    for row in PARTS:
        if row[1].replace("-", "") == wanted:
            return row
    known = ", ".join([row[1] for row in PARTS])
    raise ValueError(f"no part is called {name}; known: {known}")
