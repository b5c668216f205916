"""What an import makes of whole logs drawn by a seed, with an oddity now and then."""

from pathlib import Path

import numpy as np
from zerorate_tools.importers import Options, importing
from zerorate_tools.importers.columns import plan
from zerorate_tools.importers.columns.mapping import Mapped, parsed_mapping
from zerorate_tools.importers.samples import conversion
from zerorate_tools.importers.tables.sensors import told_apart
from zerorate_tools.importers.tables.table import Chunk, Table
from zerorate_tools.recordings.reading import whole
from zerorate_tools.recordings.recording import ACCEL, COLUMNS, GYRO

from .import_texts import attempt, mostly, told

_PATH = Path("log.csv")

_GYROS = ("g{}", "gyro_{} [rad/s]", "imu1.raw_gyro_{}", "imu2 gyro {} calibrated", "rot {} (deg/s)",
          "angular_velocity.{}", "{}", "w[{}]")  # fmt: skip
_FORCES = ("a{}", "acc_{}_mg", "imu1.acc_{}", "imu2 acc {}", "lin_acc_{}", "{} (m/s^2)",
           "a{} (ug/s)")  # fmt: skip
_TIMES_NAMED = ("t_s", "time", "uptime_ms", "Zeit (s)", "timestamp_sample", "frame", "TimeUS",
                "utc")  # fmt: skip
_OTHERS = ("temp", "cpu_temp", "die (K)", "temp_h", "humidity", "rtcTime", "seconds_elapsed", "id")

_MAPPINGS = (
    "gx gx= =a gx=a gx=a:dps gx=a:RAD/S gx=a:x2 gx=a:x0 gx=a:xinf gx=a:xnan gx=a:b:g ax=a:s "
    "t_us=a:ms t_us=a:x2 t_us=a:s+b:ns t_us=a+b:ns t_us=a:s+b t_us=a:s+b:g t_us=a:g+b:ns t_us=a+b "
    "gx=a:s+b:ns temp=a:x2 temp=a:k temp=none q=a:x1e3 q=a:2 q=a:dps q=a -gx=a"
)


def _named(luck, rows=60):
    """A table of columns that names tell more or less of, as readers hand it on."""
    at = np.arange(rows)
    columns = {"at.sec": at // 9 + 7.0, "at.nanosec": at % 9 * 1e8} if luck.random() < 0.1 else {}
    for name in luck.permutation(_TIMES_NAMED)[: mostly(luck, 1, 0, 2, 3)]:
        step = 10.0 if name[-2:] == "ms" else mostly(luck, 0.01, 10.0, 1e4, 1e7)
        columns[str(name)] = mostly(luck, 0.0, 1.7e9, 1.7e12) + at // mostly(luck, 1, 60) * step
    for names, size in ((_GYROS, 0.5), (_FORCES, 9.8), (_FORCES, 1000.0)):
        for name in luck.permutation(names)[: mostly(luck, 1, 0, 2)]:
            level = luck.normal(0, 1, 3)
            level *= mostly(luck, size, 1.0) / np.linalg.norm(level)
            three = level + luck.normal(0, size / 50, (rows, 3))
            columns |= dict(zip((name.format(axis) for axis in "xyz"), three.T))
    for name in luck.permutation(_OTHERS)[: luck.integers(0, 4)]:
        columns[str(name)] = at % 2.0 if name == "id" else luck.choice([25, 300]) + at * 0.01
    if luck.random() < 0.2:
        parts = np.cos(at / 9), np.sin(at / 9) * mostly(luck, 1.0, 1.2), 0 * at, 0 * at
        columns |= dict(zip(mostly(luck, ["qw", "qx", "qy", "qz"], ["W", "X", "Y", "Z"]), parts))
    columns = {
        name: columns[name] for name in mostly(luck, [*columns], luck.permutation([*columns]))
    }
    table = Table([*columns], lambda wanted: iter([Chunk(at, {n: columns[n] for n in wanted})]))
    table.said_hz, table.calendar = mostly(luck, None, 50.0), frozenset({*columns} & {"utc"})
    return table


def _planned(table, mapping, instance, without_time):
    """The plan of a table, and what is said of what it goes without."""
    path = Path("Gyroscope.csv" if len(table.names) % 2 else "run.csv")
    table, instance = told_apart(table, instance, path)
    how = {"units": {"time": "s"} if without_time else {}, "without_time": without_time}
    made = plan.planned(table, mapping, path, instance=instance, **how)
    columns = [f"{t}={one.column}:{one.unit or ''}" for t, one in made.wanted.items()]
    plus = [t for t, one in made.wanted.items() if one.plus]
    factors = [f"{factor:.4g} {offset:g}" for factor, offset in made.factors.values()]
    said = [*table.notes, *made.notes, *plan.left_aside(made, table)]
    said += conversion.absent(made, table.names, path)
    return " ".join([*columns, *factors, *sorted(made.raw), *plus, *told(" ".join(said))])


def plans():
    """Which columns of tables an import takes, in which units, or what it asks for."""
    luck, said = np.random.default_rng(10), []
    for _ in range(400):
        table = _named(luck)
        names = luck.permutation([*table.names, "none"])
        said_of = ("gx", "x2"), ("gy", "rad/s"), ("temp", "k"), ("t_us", "ms"), ("q", "x3")
        of = mostly(luck, (), *said_of)
        mapping = [Mapped(of[0], mostly(luck, "", "-") + str(names[0]), of[1])] if of else []
        how = table, mapping, mostly(luck, 0, 1, 2), luck.random() < 0.2
        said.append(attempt(_planned, *how))
    mappings = [attempt(parsed_mapping, words) for words in _MAPPINGS.split()]
    return {"plans": said, "mappings": mappings}


def _sensors(luck, rows):
    """Readings of every column, and whether they are counts."""
    counts = luck.random() < 0.3
    size = mostly(luck, 1.0, 249.0, 251.0, 1900.0, 2100.0) * mostly(luck, 1, 131) ** counts
    force = np.array([[0.0], [0.0], [1.0]]) + luck.normal(0, mostly(luck, 0.01, 0.6), (3, rows))
    force[2, rows // 3] *= mostly(luck, 1.0, 1.9, 2.1, 17.0)
    held = np.arange(rows) // 3 * 3 + mostly(luck, np.arange(rows) % 3, 0)
    rates = size * luck.uniform(-1, 1, (3, rows))[:, held]
    columns = dict(zip((*GYRO, *ACCEL), [*rates, *force * 8192**counts]))
    columns["temp"] = mostly(luck, 25.0, 20.0) + np.arange(rows) // 9 / mostly(luck, 7, 340, 326.8)
    columns["level"] = luck.integers(-9, 9, rows) * mostly(luck, 1.0, 3e8)
    columns = {n: np.rint(v) if counts or n == "level" else v for n, v in columns.items()}
    return {
        n: v % mostly(luck, 2.0**40, 2.0**16) if counts else v for n, v in columns.items()
    }, counts


def _log(luck):
    """Columns of a whole log with its oddities, and whether they are counts."""
    rows, hz = mostly(luck, 501, 3, 42, 1101), mostly(luck, 100.0, 0.6, 0.7, 1000.0)
    columns, counts = _sensors(luck, rows)
    shared, row = mostly(luck, 1, 7), np.arange(rows)
    columns["t_us"] = mostly(luck, 0.0, 1.7e9) + row // shared * shared / hz
    columns["t_us"][rows // 2 :] += mostly(luck, 0.0, 5.0, -1.0, -400.0)
    for names in (ACCEL, ("temp",), ("level",), ("gx",), GYRO, ("t_us",)):
        often, long = (0.6, 160) if names[0] in ("ax", "temp", "level") else (0.01, 3)
        lacks = luck.random(rows) < mostly(luck, 0.0, 0.1, often)
        lacks |= np.abs(row - rows // 2) < mostly(luck, 0, long)
        for name in names:
            columns[name][lacks] = np.nan
    for at in luck.integers(1, rows, mostly(luck, 0, 1, 5)):
        for name, column in columns.items():
            column[at] = mostly(luck, column[at] if name == "t_us" else 0.0, column[at - 1])
    without = mostly(luck, (), ("temp",), ACCEL, ("t_us",))
    return {n: v for n, v in columns.items() if n not in without}, counts


def _imported(table, how):
    """Of a log: how its columns change from row to row, times, scales and the report."""
    (one,) = importing._ready([importing._gathered(table, _PATH, how, None)])
    columns = whole(one.batches, one.names, _PATH)
    sums = [f"{name} {np.abs(np.diff(v)).mean():.5g}" for name, v in columns.items()]
    spans = columns["t_us"][[0, -1]].tolist()
    said = " ".join(map(str, (*sums, *spans, one.scales.to_json(), *one.report.lines())))
    return " ".join(told(said))


def logs():
    """What an import makes of logs."""
    luck, said = np.random.default_rng(7), []
    for _ in range(250):
        columns, counts = _log(luck)
        size = len(columns["gx"])
        bounds = [0, *sorted(luck.integers(1, size, luck.choice([0, 0, 2]))), size]

        def chunks(wanted, columns=columns, bounds=bounds):
            for a, b in zip(bounds, bounds[1:]):
                yield Chunk(np.arange(a, b), {n: columns[n][a:b].copy() for n in wanted})

        clock = mostly(luck, "s", "ms")
        if clock == "ms" and "t_us" in columns:
            columns["t_us"] = (columns["t_us"] * 1e3 + 2.0**32 - 2000) % 2.0**32
        rate, force = ("lsb", "lsb") if counts else ("dps", "g")
        units = dict(zip(COLUMNS, (clock, *[rate] * 3, *[force] * 3)))
        mapping = [Mapped(n, n, units.get(n, "degc" if n == "temp" else None)) for n in columns]
        scales = {"gyro_lsb_per_dps": mostly(luck, 131.0, 2185.0, None), "accel_lsb_per_g": 8192.0}
        options = Options(hz=mostly(luck, None, 50.0), **(scales if counts else {}))
        how = importing._How(options, mapping, None, 0)
        said.append(attempt(_imported, Table(list(columns), chunks), how))
    return {"logs": said}


LOGS = {f"imported {of.__name__}": of for of in (plans, logs)}
