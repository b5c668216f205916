"""Arrays and tables in binary files: MATLAB, HDF5, NumPy, Feather, Parquet, databases."""

import json
import sqlite3
import zipfile
from pathlib import Path

import h5py
import numpy as np
from scipy.io import savemat

from .world import Logs, World, csv, plain, table

log = Logs(samples=1000)
# fmt: off


def _arrays(world: World) -> dict[str, np.ndarray]:
    return {"t_s": world.t_s, "gyro_dps": world.dps, "accel_g": world.g, "temp_c": world.degc}


def _hdf5(path: Path, arrays: dict[str, np.ndarray], head: bytes = b"") -> None:
    """HDF5 behind so many bytes of another head."""
    with h5py.File(path, "w", userblock_size=len(head)) as file:
        for name, values in arrays.items():
            file[name] = values
    with open(path, "r+b") as file:
        file.write(head)


def _database(path: Path, world: World) -> None:
    with sqlite3.connect(path) as base:
        plain(world).to_sql("imu", base, index=False)
    base.close()


def _archive(path: Path, members: dict[str, str | bytes]) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)


matlab = log.file("MATLAB, version 5", "in.mat",
    lambda path, w: savemat(path, {**_arrays(w), "seen": np.zeros((12, 2 * len(w.t_s)))}))


def _matlab_folder(folder: Path, world: World) -> None:
    folder.mkdir()
    for name, values in (("AngularVelocity", world.rad), ("Acceleration", world.mps2)):
        savemat(folder / f"{name}.mat", {"Timestamp": world.t_s, name: values})


log.file("MATLAB, a folder with a file a sensor", "in", _matlab_folder)
matlab73 = log.file("MATLAB, version 7.3: an array's axes change places",
    "in.mat", lambda path, w: _hdf5(path,
        {name: np.atleast_2d(values.T) for name, values in _arrays(w).items()},
        b"MATLAB 7.3 MAT-file".ljust(512)))
hdf5 = log.file("HDF5, arrays in a group",
    "in.h5", lambda path, w: _hdf5(path, {f"synced/{n}": of for n, of in _arrays(w).items()}))
hdf5_table = log.file("HDF5, a table of fields",
    "in.hdf5", lambda path, w: _hdf5(path, {"imu": plain(w).to_records(index=False)}))
npz = log.file("NumPy, .npz", "in.npz",
    lambda path, w: np.savez_compressed(path, **_arrays(w)))  # type: ignore[arg-type]
npy = log.file("NumPy, .npy with named fields",
    "in.npy", lambda path, w: np.save(path, plain(w).to_records(index=False)))
log.file("NumPy, .npz of pickled objects",
    "in.npz", lambda path, w: np.savez(path, log=np.array([{"gyro": w.dps}], dtype=object)))
feather = log.file("Feather", "in.feather", lambda path, w: plain(w).to_feather(path))
parquet = log.file("Parquet of pandas", "in.parquet", lambda path, w: plain(w).to_parquet(path))


def _cut(path: Path, world: World) -> None:
    path.write_bytes(parquet(path.parent, world).read_bytes()[:-200])


log.file("Parquet that was cut off", "in.parquet", _cut)
json_columns = log.text("JSON of pandas, a dictionary of columns",
    lambda w: plain(w).to_json(), "in.json")
json_records = log.text("JSON, a list of records",
    lambda w: plain(w).to_json(orient="records", indent=1), "in.json")
json_lists = log.text("JSON, an object of lists",
    lambda w: json.dumps({"device": "A", **{n: of.tolist() for n, of in plain(w).items()}}),
    "in.json")
log.file("a database of SQLite", "in.sqlite", _database)
log.file("a spreadsheet",
    "in.xlsx", lambda path, w: _archive(path,
        {"[Content_Types].xml": "<Types/>", "xl/worksheets/sheet1.xml": "<worksheet/>"}))
log.file("a zip without a table of rates",
    "in.zip", lambda path, w: _archive(path,
        {"a.png": b"\x89PNG\r\n", "readme.txt": "nothing of rates\n"}))


def _two_runs(world: World) -> dict[str, str]:
    half, frame = len(world.t_s) // 2, table("t_s,g{xyz}_dps", world.t_s, world.dps)
    return {"run1.csv": csv(frame[:half]), "run2.csv": csv(frame[half:])}


log.files("a zip of two runs with the same names of columns", "in.zip", _two_runs)
