"""How each measured recording of the data folder is imported: what its authors' notes say of it."""

import math
from pathlib import Path
from typing import Any

from ..importers import Options, parsed_mapping

_MPU = {"sensor": "MPU-6050", "gyro_lsb_per_dps": 131.0, "accel_lsb_per_g": 16384.0}
_MPU_TEMP = {"temp_lsb_per_degc": 340.0, "temp_offset_degc": 36.53}
#: The optical attitude of BROAD, in a unit that holds it in 32 bits.
_QUATERNION_LSB = 2.0**-29
_ATTITUDE = " ".join(
    f"opt_q{name}=opt_quat[{i}]:x{1 / _QUATERNION_LSB:.0f}" for i, name in enumerate("wxyz")
)
_BROAD_RAD_S_PER_LSB = 0.001065297

#: Folder -> units, words as of --map, options.
_DATA: dict[str, tuple[dict[str, str], str, dict[str, Any]]] = {
    "adis16405-static": (
        {"gyro": "lsb", "accel": "lsb"},
        "",
        {"sensor": "ADIS16405", "hz": 100.0, "gyro_lsb_per_dps": 20.0}
        | {"accel_lsb_per_g": 1000 / 3.33},
    ),
    "broad": (
        {"gyro": "rad/s", "accel": "m/s2"},
        "moving=movement "
        + " ".join(
            f"opt_q{n}=opt_quat[{i}]:x{1 / _QUATERNION_LSB:.0f}" for i, n in enumerate("wxyz")
        ),
        {"sensor": "aktos-t", "hz": 2000 / 7, "accel_lsb_per_g": 2048.0}
        | {"gyro_lsb_per_dps": math.radians(1) / _BROAD_RAD_S_PER_LSB}
        | {
            "more": {
                "source": "BROAD, D. Laidig et al., CC BY 4.0",
                "channels": {f"opt_q{n}": {"role": "reference"} for n in "wxyz"}
                | {"moving": {"role": "reference"}},
            }
        },
    ),
    "chamber-loop": ({"gyro": "rad/s"}, "", {"hz": 1.0}),
    "gy521-cooldown": (
        {"gyro": "dps"},
        "vdd_mv=volt humidity_mpct=AHT_hum:x1000 pressure_pa=BMP_pres "
        "aht_temp_mdegc=AHT_tmp[C]:x1000 bmp_temp_mdegc=BMP_temp[C]:x1000 "
        "mag_x_lsb=magx mag_y_lsb=magy mag_z_lsb=magz",
        _MPU | _MPU_TEMP,
    ),
    "lsm6ds3-hubs": (
        {},
        "gx=xaxis:dps gy=yaxis:dps gz=zaxis:dps",
        {"sensor": "LSM6DS3TR-C", "gyro_lsb_per_dps": 1000.0, "hz": 1 / 15},
    ),
    "mpu6050-unmoved": ({}, "", _MPU | _MPU_TEMP),
    "vn200-flip": (
        {},
        "ax=4:m/s2 ay=5:m/s2 az=6:m/s2 gx=7:rad/s gy=8:rad/s gz=9:rad/s temp=10:degc "
        "pressure_pa=11:x1000",
        {"sensor": "VN-200", "hz": 50.0, "gyro_lsb_per_dps": 131.0, "accel_lsb_per_g": 16384.0},
    ),
}
_OF_ONE_FILE = {"RB.csv": "heater_pct=dc"}


def told_of(path: Path) -> dict[str, Any]:
    """What to say to `read_foreign` or `import_recording` of a file of the data folder."""
    units, words, options = _DATA.get(path.parent.name, ({}, "", {}))
    words = f"{words} {_OF_ONE_FILE.get(path.name, '')}"
    return {
        "options": Options(**options),
        "units": units,
        "mapping": [parsed_mapping(word) for word in words.split()],
    }
