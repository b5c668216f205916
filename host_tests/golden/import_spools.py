"""What single steps of an import compute of rows in a spool, drawn by a seed."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers.samples import clock, lines
from zerorate_tools.importers.samples.spool import Spool

from .import_steps import mostly


def _spooled(pieces):
    spool = Spool(list(pieces[0]))
    for piece in pieces:
        spool.append(piece)
    spool.finish()
    return spool


def _of_lines(luck):
    """How far rows are off the lines through their neighbours, at some ratios of rows to readings,
    and whether these lie on rows."""
    for ratio in (1.0, 1.3, 3.3):
        rates, at = luck.standard_normal((3, 1800)), np.arange(0.3, 1799, 1 / ratio)
        rates = np.array([np.interp(at, np.arange(1800), axis) for axis in rates])
        frame = np.vstack([np.arange(len(at)), rates])
        frame[0, 900:] += 4.0  # a gap
        off, moves = lines._off_line(frame, np.full(3, 1e-4))
        seen = lines._Seen()
        seen.add(off, moves)
        told = [int(moves.sum()), seen.lines, seen.stretches, seen.even, seen.odd]
        yield f"off {ratio:g}", [float(np.log1p(off[1:-1]).mean()), *told]


def _misfit(luck):
    """How far rates are off the lines between their neighbours, by late stamps and by even ones."""
    taken = 1e4 * np.arange(1200)
    late = np.maximum.accumulate(taken + 3e4 * luck.random(1200) * (np.arange(1200) % 25 > 4))
    rates = np.sin(taken * 4e-6 + np.arange(3)[:, None]) + luck.normal(0, 0.01, (3, 1200))
    weight = np.diff(late)[1:] / np.maximum(late[2:] - late[:-2], 1.0)
    some = np.arange(1198) % 25 < 2
    return [clock._misfit(rates, of, some) for of in (weight, 0 * weight + 0.5)]


def parts():
    """What single steps compute of drawn rows."""
    luck = np.random.default_rng(4)
    return {**dict(_of_lines(luck)), "misfit": _misfit(luck)}


def _cut(luck, columns):
    """The same columns in pieces, as a spool has them."""
    size = len(columns["t_us"])
    bounds = pairwise([0, *sorted(luck.integers(0, size, luck.choice([0, 1, 3]))), size])
    return _spooled([{n: v[a:b] for n, v in columns.items()} for a, b in bounds])


def _sizes(spool):
    """Of its rows: the mean time, and times and places that tell their order."""
    rows = {n: np.concatenate([one[n] for one in spool]) for n in spool.names}
    weights = np.cos(np.arange(len(rows["t_us"])))
    return [rows["t_us"].mean(), *(float(weights @ rows[n]) for n in ("t_us", "place"))]


def _evenly(luck):
    """Rows that share coarse stamps."""
    usual = luck.choice([2, 7, 10])
    odd, rare = luck.choice([-9, -3, -2, -1, 1, 2, 3, 9], 40), luck.choice([0.02, 0.1, 0.3])
    counts = np.maximum(usual + np.where(luck.random(40) < rare, odd, 0), 0)
    ticks = np.where(luck.random(40) < rare, luck.choice([1, 2, 3, 4, 9], 40), 1)
    t_us = np.repeat(mostly(luck, 1e6, 2e4) * np.cumsum(ticks), counts)
    rows = {"t_us": t_us, "place": np.arange(len(t_us)) + 0.0}
    rows["gx"] = np.where(luck.random(len(t_us)) < mostly(luck, 0.0, 0.1), np.nan, 1.0)
    out, said = clock.evenly(_cut(luck, rows), clock.Ticks(t_us), Path("log"))
    return [*_sizes(out), *map(float, re.findall(r"[\d.]*\d", said))]


def _bursts(luck):
    """Samples that come several at a time, of a logger that paused or of none."""
    size, every = mostly(luck, 400, 2, 3, 150), mostly(luck, 1e4, 4e5)
    row, of = np.arange(size), luck.choice([1, 3, 8, 25])
    taken = row * every
    late = taken[row // of * of] + row % of * mostly(luck, 100.0, 0.6 * every)
    late[size // 2 :] += mostly(luck, 0.0, 1.5e6)
    of_rates = luck.choice([1.0, 0.0]) * taken + luck.choice([1.0, 0.0]) * late
    rates = np.sin(of_rates / every * 0.06 + np.arange(3)[:, None])
    rates += luck.normal(0, mostly(luck, 0.001, 1.0), (3, size))
    rates[:, luck.integers(size)] *= mostly(luck, 1.0, np.nan)
    columns = {"t_us": late, "place": np.arange(size) + 0.0, **dict(zip(("gx", "gy", "gz"), rates))}
    told = clock.arrive_in_bursts(columns, every)
    spool = _cut(luck, columns)
    return [float(told), *_sizes(spool.remade(clock.evened(spool, every)))]


def _lined(luck):
    """Readings, some of which lie on lines between those around them."""
    size, share = mostly(luck, 300, 1, 2, 3, 40), luck.choice([0.0, 0.01, 0.02, 0.5, 0.9])
    t_us = np.cumsum(mostly(luck, 1e4, 1e4 * (1 + luck.random(size))) * np.ones(size))
    rates = np.rint(luck.normal(0, mostly(luck, 99, 3), (3, size))) * mostly(luck, 0.01, 1.0)
    some = np.sort(np.append(luck.random(size - 1) > share, True).nonzero()[0])
    if luck.random() < 0.2 and size > 40:
        some = some[(some < 20) | (some > 20 + luck.choice([3, 5, 6, 7]))]
    along = mostly(luck, t_us, np.arange(size) + 0.0)
    rates = np.array([np.interp(along, along[some], axis[some]) for axis in rates])
    rates += luck.normal(0, 1, (3, size)) * mostly(luck, 0.0, 0.01, 0.04, 0.1)
    columns = {"t_us": t_us, "place": np.arange(size) + 0.0, **dict(zip(("gx", "gy", "gz"), rates))}
    columns["gx"][luck.random(size) < mostly(luck, 0.0, 0.1)] = np.nan
    out, lost = lines.without_lines(_cut(luck, columns), Path("log"))
    return [*_sizes(out), lost]


def spools():
    """What is made of the rows of a spool."""
    luck, found = np.random.default_rng(11), {}
    for step in (_evenly, _bursts, _lined):
        made = found[step.__name__.strip("_")] = []
        for _ in range(80):
            try:
                made += step(luck)
            except BadRecording as error:
                made += map(float, re.findall(r"\d+", str(error)))
    return found


SPOOLS = {"imported spools": spools}
