"""Logs of watches, straps and cameras, and a board's files in a zip."""

import json

import numpy as np
import pandas as pd

from .world import Logs, World, csv, table

log = Logs(samples=1000)
# fmt: off
_GYROFLOW = """\
GYROFLOW IMU LOG
version,1.3
id,custom_logger
orientation,YxZ
tscale,{}
gscale,0.00122173
ascale,0.000244140625
"""


def _gcsv(world: World, ticks_a_second: float) -> pd.DataFrame:
    counts = world.counts(gyro=1 / np.degrees(0.00122173), accel=4096)
    return table("t,g{xyz},a{xyz}", world.whole(ticks_a_second), *counts)


log.csv("Gyroflow, .gcsv: counts, whose scales stand above the table",
    lambda w: _gcsv(w, 1e3), _GYROFLOW.format(0.001), name="in.gcsv")
log.csv("Gyroflow, .gcsv: time in counts of a tenth of a millisecond",
    lambda w: _gcsv(w, 1e4), _GYROFLOW.format(0.0001), name="in.gcsv")


def _lists(world: World) -> list[np.ndarray]:
    """Of each axis: a list of 25 readings in each cell."""
    return [np.array([str(part.tolist()) for part in axis.reshape(-1, 25)]) for axis in world.dps.T]


log.csv("a watch's table: a list of 25 readings in each cell",
    lambda w: table("timestamp_s,gyro_{xyz}", w.t_s[::25], *_lists(w)), words="--gyro-unit dps")
log.csv("a watch's table: three rates in a cell, [x, y, z]",
    lambda w: table("timestamp_s,heart_rate,gyro", w.t_s, 70 + w.count % 9,
        [str(row.tolist()) for row in w.dps]), words="--gyro-unit dps")
log.csv("Garmin FIT's CSV: field, value and units take turns",
    lambda w: table("Type,Local Number,Message,Field 1,Value 1,Units 1,Field 2,Value 2,Units 2",
        *map(w.each, ("Data", 3, "gyroscope_data", "timestamp_ms")), w.whole(1e3), w.each("ms"),
        w.each("gyro_x"), [json.dumps(row.tolist()).replace(", ", "|") for row in w.dps],
        w.each("deg/s")))
log.csv("Axivity AX6, with names and a temperature",
    lambda w: table("Time,Accel-{XYZ} (g),Gyro-{XYZ} (d/s),Temp (C)",
        w.dates("%Y-%m-%d %H:%M:%S.%f", 3), w.g, w.dps, w.degc))


def _numbers(world: World) -> dict[str, str]:
    imu = table("t,{abcdefg}", at := world.whole(1e6), world.rad, world.mps2, world.degc)
    tables = {"IMU.txt": imu, "ATT.txt": table("t,{abc}", at, world.g)}
    return {name: csv(of, sep=" ", header=False) for name, of in tables.items()}


log.files("text without names in a zip: numbers of a board's files", "in.zip", _numbers)


def _of_25_samples(world: World) -> str:
    said = [dict(zip("xyz", row.tolist())) for row in world.dps]
    parts = [{"ts": 40 * n, "gyro": said[n : n + 25]} for n in range(0, world.samples, 25)]
    return "".join(json.dumps(part) + "\n" for part in parts)


def _mvnx(world: World) -> str:
    frames = (f'<frame time="{n}"><x>{row}</x></frame>' for n, row in enumerate(world.dps.tolist()))
    return f'<?xml version="1.0"?>\n<mvnx version="4">{"".join(frames)}</mvnx>\n'


log.text("a watch's JSON lines: a list of 25 samples in each", _of_25_samples, "in.jsonl")
log.text("Xsens MTw, .mvnx", _mvnx, "in.mvnx")
log.csv("a time by another name: Zeit;wx;wy;wz",
    lambda w: table("Zeit,w{xyz}", w.t_s, w.rad).round(5), words="--gyro-unit rad/s", sep=";",
    decimal=",")
