"""Every log of the corpus, imported in this process as a user does who knows nothing of it.

And what single steps of an import compute of rows drawn by a seed.
"""

import re
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np
from zerorate_bench.foreign_logs import CORPUS, World
from zerorate_bench.resampled import digits, drawn, on_lines, timed
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.logs import apart
from zerorate_tools.importers.samples import bursts, clock, lines, one_device, resampled
from zerorate_tools.importers.samples.spool import Spool

from host_tests.hostile.many_logs import in_this_process

#: What a user is told to type, and figures: the words about them are free.
_TOLD = re.compile(r"--[a-z-]+(?: [^\s,;()]+)?|-?\d+\.?\d*")
_SCALES = ("odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc", "temp_offset_degc")


def _told(said):
    return _TOLD.findall(re.sub(r"/\S+", "", said))


def _figures(recording, report):
    """[samples, scales and each column's mean and root mean square], and what is said of them."""
    columns = [np.asarray(of, float) for of in recording.columns.values()]
    sizes = [size for of in columns for size in (of.mean(), np.sqrt((of**2).mean()))]
    scales = [getattr(recording.scales, name) or 0.0 for name in _SCALES]
    numbers = [float(f"{v:.6g}") for v in (len(recording), *scales, *sizes)]
    return numbers, _told(" ".join(report.lines()))


def _imported(log, folder):
    path = log.write(folder, World(1000))
    try:
        return _figures(*read_foreign(path))
    except ZerorateError as error:
        return [], _told(str(error))


def imported(module):
    """{log: [numbers], log and told: [what is said]} of the logs that a module writes."""
    found = {}
    here = mock.patch.object(apart, "table_apart", in_this_process)
    with here, mock.patch("resource.setrlimit"):  # no limit of a child's for this process
        for log in CORPUS:
            if log.write.__module__.endswith(f".{module}"):
                with TemporaryDirectory() as folder:
                    found[log.what], told = _imported(log, Path(folder))
                found[f"{log.what}: told"] = [" ".join(told)]
    return found


def _spooled(pieces):
    spool = Spool(list(pieces[0]))
    for piece in pieces:
        spool.append(piece)
    spool.finish()
    return spool


def _times(spool):
    return np.concatenate([columns["t_us"] for columns in spool]) * 1e-4


def _of_lines(luck):
    """Evidence for lines between rows at some ratios, and how far rows are off them."""
    for kind, ratio in (("white noise", 0), ("in motion", 1.3), ("coarse", 1.7)):
        rates = drawn(kind, luck, 1800)
        frame = timed(on_lines(rates, ratio) if ratio else rates)
        frame[0, 900:] += 4.0  # a gap
        yield f"evidence {kind}", list(resampled.evidence(frame, digits(kind)))
        off, moves = lines._off_line(frame[:, ::2], digits(kind))
        yield f"off {kind}", [float(np.log1p(off[1:-1]).mean()), int(moves.sum())]
    frame = timed(on_lines(drawn("white noise", luck, 1000), 4.2))
    yield "period", [resampled.base_period(frame, digits(""))]


def _of_devices(luck):
    """How far the levels of rows are apart that three devices write in turn."""
    levels = np.resize([[0.0, 3.0, 1.0], [0.5, 0.0, 1.0], [0.2, 2.0, 0.0]], (120, 3))
    block = levels + luck.normal(0, 0.5, (120, 3)) + np.arange(120)[:, None] / 30
    yield "apart", [one_device._apart(block, devices) for devices in range(2, 9)]


def _of_clocks(luck):
    """Stamps of bursts, and of rows that share coarse ones, spread as time went on."""
    taken = 1e4 * np.arange(1200)
    late = np.maximum.accumulate(taken + 3e4 * luck.random(1200) * (np.arange(1200) % 25 > 4))
    rates = np.sin(taken * 4e-6 + np.arange(3)[:, None]) + luck.normal(0, 0.01, (3, 1200))
    some = slice(1, -1), np.arange(1198) % 25 < 2
    weight = np.diff(late)[1:] / np.maximum(late[2:] - late[:-2], 1.0)
    yield "misfit", [bursts._misfit(rates, of, some[1]) for of in (weight, 0 * weight + 0.5)]
    parts = [{"t_us": part} for part in np.split(late, [500, 640])]
    yield "evened", _times(bursts.evened(_spooled(parts), 1e4, None))[::60].tolist()
    counts = [4, *[10, 9, 11, 10] * 6, 3, 7, *[10] * 12, 12, 6, *[10, 11] * 6, 5]
    stamps = 1e6 * np.cumsum([0, *[1] * 24, 1, 6, *[1] * 26, 4])[: len(counts)]
    t_us = np.repeat(stamps, counts)
    rows = {"t_us": t_us, "place": np.arange(len(t_us)) + 0.0}
    rows["gx"] = np.where(luck.random(len(t_us)) < 0.04, np.nan, 1.0)
    parts = [{n: v[a:b] for n, v in rows.items()} for a, b in ((0, 150), (150, 260), (260, 9999))]
    spread, said = clock.evenly(_spooled(parts), clock.Ticks(t_us), Path("log"), None)
    yield "spread", _times(spread)[::20].tolist()
    yield "said", [said]


def parts():
    """What single steps compute of drawn rows."""
    luck = np.random.default_rng(4)
    steps = (_of_lines, _of_devices, _of_clocks)
    return {name: figures for step in steps for name, figures in step(luck)}


MODULES = sorted({log.write.__module__.rpartition(".")[2] for log in CORPUS})
IMPORTED = {f"imported {module}": partial(imported, module) for module in MODULES}
IMPORTED["imported parts"] = parts
