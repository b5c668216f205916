"""Registers of the parts, and their FIFO."""

READ = 1
WRITE = 2

# first, last, access
_MAP_6050 = (
    (0x0D, 0x10, READ | WRITE),  # SELF_TEST_X .. SELF_TEST_A
    (0x13, 0x1C, READ | WRITE),  # XG_OFFS_USRH .. ACCEL_CONFIG
    (0x1F, 0x22, READ | WRITE),  # MOT_THR .. ZRMOT_DUR
    (0x23, 0x35, READ | WRITE),  # FIFO_EN .. I2C_SLV4_DI
    (0x36, 0x36, READ),  # I2C_MST_STATUS
    (0x37, 0x38, READ | WRITE),  # INT_PIN_CFG, INT_ENABLE
    (0x3A, 0x61, READ),  # INT_STATUS, data, EXT_SENS_DATA, MOT_DETECT_STATUS
    (0x63, 0x67, READ | WRITE),  # I2C_SLV0_DO .. I2C_MST_DELAY_CTRL
    (0x68, 0x68, READ | WRITE),  # SIGNAL_PATH_RESET
    (0x69, 0x6C, READ | WRITE),  # MOT_DETECT_CTRL .. PWR_MGMT_2
    (0x6D, 0x71, READ | WRITE),  # the DMP's bank, address, memory and start (its own manual)
    (0x72, 0x73, READ),  # FIFO_COUNT
    (0x74, 0x74, READ | WRITE),  # FIFO_R_W
    (0x75, 0x75, READ),  # WHO_AM_I
)
_MAP_6500 = (
    (0x00, 0x02, READ | WRITE),  # SELF_TEST_X_GYRO ..
    (0x0D, 0x0F, READ | WRITE),  # SELF_TEST_X_ACCEL ..
    (0x13, 0x1F, READ | WRITE),  # XG_OFFSET_H .. WOM_THR
    (0x23, 0x35, READ | WRITE),
    (0x36, 0x36, READ),
    (0x37, 0x38, READ | WRITE),
    (0x3A, 0x60, READ),
    (0x63, 0x6C, READ | WRITE),
    (0x6D, 0x71, READ | WRITE),
    (0x72, 0x73, READ),
    (0x74, 0x74, READ | WRITE),
    (0x75, 0x75, READ),
    (0x77, 0x78, READ | WRITE),  # XA_OFFSET
    (0x7A, 0x7B, READ | WRITE),
    (0x7D, 0x7E, READ | WRITE),
)

_TEMP_6050 = (340.0, 36.53)
_TEMP_6500 = (333.87, 21.0)
_TEMP_ICM = (326.8, 25.0)

# name: map, WHO_AM_I, PWR_MGMT_1 and CONFIG at reset, FIFO bytes, gyro start-up us, temperature in
# LSB a degC and degC at 0
PARTS = {
    "MPU-6050": (_MAP_6050, 0x68, 0x40, 0x00, 1024, 30000, _TEMP_6050),
    "MPU-6500": (_MAP_6500, 0x70, 0x01, 0x00, 512, 35000, _TEMP_6500),
    "MPU-9250": (_MAP_6500, 0x71, 0x01, 0x00, 512, 35000, _TEMP_6500),
    "MPU-9255": (_MAP_6500, 0x73, 0x01, 0x00, 512, 35000, _TEMP_6500),
    "MPU-6515": (_MAP_6500, 0x74, 0x01, 0x00, 512, 35000, _TEMP_6500),
    "MPU-6880": (_MAP_6500, 0x78, 0x01, 0x00, 512, 35000, _TEMP_6500),
    "ICM-20600": (_MAP_6500, 0x11, 0x41, 0x80, 1008, 35000, _TEMP_ICM),
    "ICM-20602": (_MAP_6500, 0x12, 0x41, 0x80, 1008, 35000, _TEMP_ICM),
    "ICM-20608": (_MAP_6500, 0xAF, 0x40, 0x80, 512, 35000, _TEMP_ICM),
    "ICM-20608D": (_MAP_6500, 0xAE, 0x40, 0x80, 512, 35000, _TEMP_ICM),
    "ICM-20609": (_MAP_6500, 0xA6, 0x40, 0x80, 512, 35000, _TEMP_ICM),
    "ICM-20689": (_MAP_6500, 0x98, 0x40, 0x80, 4096, 35000, _TEMP_ICM),
    "ICM-20690": (_MAP_6500, 0x20, 0x41, 0x80, 1024, 35000, _TEMP_ICM),
    "IAM-20680": (_MAP_6500, 0xA9, 0x41, 0x80, 512, 35000, _TEMP_ICM),
    "MPU-6886": (_MAP_6500, 0x19, 0x41, 0x80, 512, 35000, _TEMP_ICM),
}


def access_of(ranges: "tuple[tuple[int, int, int], ...]") -> bytearray:
    """bytearray of 256: READ, WRITE, both or 0 (unknown) for each address."""
    access = bytearray(256)
    for first, last, kinds in ranges:
        for register in range(first, last + 1):
            access[register] = kinds
    return access


class Fifo:
    """size bytes; keep_oldest is FIFO_MODE of the 6500 and later: full, it takes no more."""

    def __init__(self, size: int) -> None:
        self.size = size
        self.keep_oldest = False
        self.overflowed = False
        self._ring = bytearray(size)
        self.clear()

    def clear(self) -> None:
        """Empty, as FIFO_RESET does."""
        self._first = 0
        self.count = 0
        self._last_read = 0xFF

    def put(self, byte: int) -> None:
        """Append a byte; when full the oldest goes, or with keep_oldest the new one."""
        if self.count == self.size:
            self.overflowed = True
            if self.keep_oldest:
                return
            self._first = (self._first + 1) % self.size
            self.count -= 1
        self._ring[(self._first + self.count) % self.size] = byte
        self.count += 1

    def get(self) -> int:
        """Take the oldest byte; empty, the last one again."""
        if self.count:
            self._last_read = self._ring[self._first]
            self._first = (self._first + 1) % self.size
            self.count -= 1
        return self._last_read
