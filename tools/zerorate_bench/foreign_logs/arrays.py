"""Arrays and tables in binary files: MATLAB, HDF5, NumPy, Feather, Parquet, databases."""

import json
import sqlite3
from pathlib import Path

import numpy as np

from .clocks import _plain
from .world import World, log, table


def _arrays(world: World) -> dict[str, np.ndarray]:
    return {"t_s": world.t_s, "gyro_dps": world.dps, "accel_g": world.g, "temp_c": world.degc}


@log("MATLAB, version 5")
def matlab(folder: Path, world: World) -> Path:
    import scipy.io

    scipy.io.savemat(folder / "in.mat", _arrays(world))
    return folder / "in.mat"


@log("MATLAB, a folder with a file a sensor")
def matlab_folder(folder: Path, world: World) -> Path:
    from scipy.io import savemat

    for name, values in (("AngularVelocity", world.rad), ("Acceleration", world.mps2)):
        (folder / "in").mkdir(exist_ok=True)
        savemat(folder / "in" / f"{name}.mat", {"Timestamp": world.t_s, name: values})
    return folder / "in"


def _hdf5(path: Path, arrays: dict[str, np.ndarray], group: str = "") -> Path:
    import h5py

    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[f"{group}{name}"] = values
    return path


@log("MATLAB, version 7.3: an array's axes change places")
def matlab73(folder: Path, world: World) -> Path:
    turned = {name: np.atleast_2d(values.T) for name, values in _arrays(world).items()}
    path = _hdf5(folder / "body.h5", turned)
    head = b"MATLAB 7.3 MAT-file".ljust(512)
    import h5py

    with h5py.File(folder / "in.mat", "w", userblock_size=512) as out, h5py.File(path) as file:
        for name in turned:
            out[name] = file[name][()]
    with open(folder / "in.mat", "r+b") as out:
        out.write(head)
    return folder / "in.mat"


@log("HDF5, arrays in a group")
def hdf5(folder: Path, world: World) -> Path:
    return _hdf5(folder / "in.h5", _arrays(world), "synced/")


@log("HDF5, a table of fields")
def hdf5_table(folder: Path, world: World) -> Path:
    return _hdf5(folder / "in.hdf5", {"imu": _plain(world).to_records(index=False)})


@log("NumPy, .npz")
def npz(folder: Path, world: World) -> Path:
    np.savez_compressed(folder / "in.npz", **_arrays(world))  # type: ignore[arg-type]
    return folder / "in.npz"


@log("NumPy, .npy with named fields")
def npy(folder: Path, world: World) -> Path:
    np.save(folder / "in.npy", _plain(world).to_records(index=False))
    return folder / "in.npy"


@log("NumPy, .npz of pickled objects")
def pickled(folder: Path, world: World) -> Path:
    held = np.array([{"gyro": world.dps}], dtype=object)
    np.savez(folder / "in.npz", log=held)
    return folder / "in.npz"


@log("Feather")
def feather(folder: Path, world: World) -> Path:
    _plain(world).to_feather(folder / "in.feather")
    return folder / "in.feather"


@log("Parquet of pandas")
def parquet(folder: Path, world: World) -> Path:
    _plain(world).to_parquet(folder / "in.parquet")
    return folder / "in.parquet"


@log("Parquet that was cut off")
def parquet_cut(folder: Path, world: World) -> Path:
    path = parquet(folder, world)
    path.write_bytes(path.read_bytes()[:-200])
    return path


@log("JSON of pandas, a dictionary of columns")
def json_columns(folder: Path, world: World) -> Path:
    (folder / "in.json").write_text(_plain(world).to_json())
    return folder / "in.json"


@log("JSON, a list of records")
def json_records(folder: Path, world: World) -> Path:
    (folder / "in.json").write_text(_plain(world).to_json(orient="records", indent=1))
    return folder / "in.json"


@log("JSON, an object of lists")
def json_lists(folder: Path, world: World) -> Path:
    lists = {name: values.tolist() for name, values in _plain(world).items()}
    (folder / "in.json").write_text(json.dumps({"device": "A", **lists}))
    return folder / "in.json"


@log("a database of SQLite")
def database(folder: Path, world: World) -> Path:
    with sqlite3.connect(folder / "in.sqlite") as base:
        _plain(world).to_sql("imu", base, index=False)
    base.close()
    return folder / "in.sqlite"


@log("a spreadsheet")
def spreadsheet(folder: Path, world: World) -> Path:
    import zipfile

    with zipfile.ZipFile(folder / "in.xlsx", "w") as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("xl/worksheets/sheet1.xml", "<worksheet/>")
    return folder / "in.xlsx"


@log("a zip without a table of rates")
def zip_of_pictures(folder: Path, world: World) -> Path:
    import zipfile

    with zipfile.ZipFile(folder / "in.zip", "w") as archive:
        archive.writestr("a.png", b"\x89PNG\r\n")
        archive.writestr("readme.txt", "nothing of rates\n")
    return folder / "in.zip"


@log("a zip of two runs with the same names of columns")
def zip_of_runs(folder: Path, world: World) -> Path:
    from .phones import zipped
    from .world import text

    half = len(world.t_s) // 2
    frame = table("t_s,gx_dps,gy_dps,gz_dps", world.t_s, world.dps)
    runs = [text(folder / "run1.csv", frame[:half]), text(folder / "run2.csv", frame[half:])]
    return zipped(folder / "in.zip", runs, folder)
