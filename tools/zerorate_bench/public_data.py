"""The folder of real recordings: what is in it, and how each is imported, by its authors' notes."""

import math
import os
from pathlib import Path
from typing import Any

from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import Options, parsed_mapping

_MPU = {"sensor": "MPU-6050", "gyro_lsb_per_dps": 131.0, "accel_lsb_per_g": 16384.0}
_MPU_TEMP = {"temp_lsb_per_degc": 340.0, "temp_offset_degc": 36.53}
#: The optical attitude of BROAD, in a unit that holds it in 32 bits.
_QUATERNION_LSB = 2.0**-29
_ATTITUDE = [f"opt_q{n}=opt_quat[{i}]:x{1 / _QUATERNION_LSB:.0f}" for i, n in enumerate("wxyz")]
_BROAD_RAD_S_PER_LSB = 0.001065297
_BROAD_MORE = {
    "source": "BROAD, D. Laidig et al., CC BY 4.0",
    "channels": {n: {"role": "reference"} for n in (*(f"opt_q{n}" for n in "wxyz"), "moving")},
}

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
        " ".join(["moving=movement", *_ATTITUDE]),
        {"sensor": "aktos-t", "hz": 2000 / 7, "accel_lsb_per_g": 2048.0}
        | {"gyro_lsb_per_dps": math.radians(1) / _BROAD_RAD_S_PER_LSB, "more": _BROAD_MORE},
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


_ENDINGS = (".csv", ".csv.gz", ".parquet", ".mat")
#: Recordings whose loop is closed, each alone; and those of one device, which are closed together.
CLOSED_ALONE = (
    "lsm6ds3-hubs/RB.csv",
    "lsm6ds3-hubs/RX.csv",
    "lsm6ds3-hubs/TH.csv",
    "gy521-cooldown/cooldown.csv.gz",
    "vn200-flip/static_z-_z+_IMU0.csv.gz",
    "vn200-flip/static_z-_z+_IMU1.csv.gz",
    "mpu6050-unmoved/set-2_unmoved-with-x-pointing-forward-10min.csv.gz",
    "adis16405-static/adis_16405_imu1.parquet",
    "adis16405-static/adis_16405_imu2.parquet",
    "chamber-loop/imu_raw_data.tsv.gz",
)
CLOSED_TOGETHER = {"mpu6050-unmoved, set 2 together": "mpu6050-unmoved/set-2_*.csv.gz"}
#: Those at rest for so long that they can be cut into four, with their rate in Hz.
LONG_RESTS = {"adis16405-static/*.parquet": 100.0}


def data_folder() -> Path | None:
    """$ZERORATE_DATA, else shared/data beside the checkout, else None."""
    named = os.environ.get("ZERORATE_DATA")
    folder = Path(named) if named else Path(__file__).resolve().parents[3] / "shared" / "data"
    return folder if folder.is_dir() else None


def recordings_folder(named: Path | None) -> Path:
    """The folder that is named, or that of `data_folder`. Raises ZerorateError without one."""
    folder = named or data_folder()
    if folder is None or not folder.is_dir():
        raise ZerorateError("no real recordings; name their folder with --data DIR")
    return folder


def recordings(folder: Path) -> list[Path]:
    """Every recording in the folders of `folder`, sorted."""
    return [path for path in sorted(folder.glob("*/*")) if path.name.endswith(_ENDINGS)]


def told_of(path: Path) -> dict[str, Any]:
    """What to say to `read_foreign` or `import_recording` of a file of the data folder."""
    units, words, options = _DATA.get(path.parent.name, ({}, "", {}))
    words = f"{words} {_OF_ONE_FILE.get(path.name, '')}"
    mapping = [parsed_mapping(word) for word in words.split()]
    return {"options": Options(**options), "units": units, "mapping": mapping}
