"""Logs of watches, straps and cameras, and a board's files in a zip."""

import json
from pathlib import Path

import numpy as np

from .phones import zipped
from .tools import _at, _axes
from .world import World, log, table, text


def _gcsv(folder: Path, world: World, tscale: float) -> Path:
    before = "GYROFLOW IMU LOG\nversion,1.3\nid,custom_logger\norientation,YxZ\n"
    before += f"tscale,{tscale!r}\ngscale,0.00122173\nascale,0.000244140625\n"
    rates, force = world.counts(gyro=1 / np.degrees(0.00122173), accel=4096)
    at = np.rint(world.t_s / tscale).astype(int)
    return text(folder / "in.gcsv", table("t,gx,gy,gz,ax,ay,az", at, rates, force), before)


@log("Gyroflow, .gcsv: counts, whose scales stand above the table")
def gyroflow(folder: Path, world: World) -> Path:
    return _gcsv(folder, world, 0.001)


@log("Gyroflow, .gcsv: time in counts of a tenth of a millisecond")
def gyroflow_tenths(folder: Path, world: World) -> Path:
    return _gcsv(folder, world, 0.0001)


@log("a watch's table: a list of 25 readings in each cell", "--gyro-unit dps")
def lists_in_cells(folder: Path, world: World) -> Path:
    rows = world.samples // 25
    lists = [[str(part.tolist()) for part in axis.reshape(rows, 25)] for axis in world.dps.T]
    names = ["timestamp_s", *_axes("gyro_{}")]
    return text(folder / "in.csv", table(names, world.t_s[::25], *map(np.array, lists)))


@log("a watch's table: three rates in a cell, [x, y, z]", "--gyro-unit dps")
def vectors_in_cells(folder: Path, world: World) -> Path:
    cells = np.array([str(row.tolist()) for row in world.dps])
    return text(folder / "in.csv", table("timestamp_s,heart_rate,gyro", world.t_s,
                                         70 + np.arange(world.samples) % 9, cells))  # fmt: skip


@log("Garmin FIT's CSV: field, value and units take turns")
def garmin_fit(folder: Path, world: World) -> Path:
    names = "Type,Local Number,Message,Field 1,Value 1,Units 1,Field 2,Value 2,Units 2"
    lists = [json.dumps(row.tolist()).replace(", ", "|") for row in world.dps]
    full = np.full(world.samples, "Data")
    frame = table(names, full, np.full(world.samples, 3), np.full(world.samples, "gyroscope_data"),
                  np.full(world.samples, "timestamp_ms"), np.rint(world.t_s * 1e3).astype(int),
                  np.full(world.samples, "ms"), np.full(world.samples, "gyro_x"),
                  np.array(lists), np.full(world.samples, "deg/s"))  # fmt: skip
    return text(folder / "in.csv", frame)


@log("Axivity AX6, with names and a temperature")
def axivity_named(folder: Path, world: World) -> Path:
    said = _at(world).strftime("%Y-%m-%d %H:%M:%S.%f").str[:-3]
    names = ["Time", *_axes("Accel-{} (g)", "XYZ"), *_axes("Gyro-{} (d/s)", "XYZ"), "Temp (C)"]
    return text(folder / "in.csv", table(names, said, world.g, world.dps, world.degc))


@log("text without names in a zip: numbers of a board's files")
def numbers_in_zip(folder: Path, world: World) -> Path:
    at = np.rint(world.t_s * 1e6).astype(int)
    imu = table("t,a,b,c,d,e,f,g", at, world.rad, world.mps2, world.degc)
    att = table("t,a,b,c", at, world.g)
    files = [
        text(folder / "in" / "IMU.txt", imu, sep=" ", header=False),
        text(folder / "in" / "ATT.txt", att, sep=" ", header=False),
    ]
    return zipped(folder / "in.zip", files, folder / "in")


@log("a watch's JSON lines: a list of 25 samples in each")
def samples_in_messages(folder: Path, world: World) -> Path:
    said = [dict(zip("xyz", row.tolist())) for row in world.dps]
    parts = [{"ts": 40 * n, "gyro": said[n : n + 25]} for n in range(0, world.samples, 25)]
    (folder / "in.jsonl").write_text("".join(json.dumps(part) + "\n" for part in parts))
    return folder / "in.jsonl"


@log("Xsens MTw, .mvnx")
def mvnx(folder: Path, world: World) -> Path:
    frames = (f'<frame time="{n}"><x>{row}</x></frame>' for n, row in enumerate(world.dps.tolist()))
    content = f'<?xml version="1.0"?>\n<mvnx version="4">{"".join(frames)}</mvnx>\n'
    (folder / "in.mvnx").write_text(content)
    return folder / "in.mvnx"


@log("a time by another name: Zeit;wx;wy;wz", "--gyro-unit rad/s")
def time_of_another_name(folder: Path, world: World) -> Path:
    frame = table("Zeit,wx,wy,wz", world.t_s, world.rad).round(5)
    return text(folder / "in.csv", frame, sep=";", decimal=",")
