"""How often the firmware is sure of a wrong bias in worlds whose turns look like one.

zerorate bench deceived --seeds 50 --out docs/deceived-figures.md
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any
from zlib import crc32

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.peers import given
from zerorate_tools.recordings import Recording, Scales
from zerorate_tools.simulate.attitude import facing, integrate, into_body
from zerorate_tools.simulate.device import counts
from zerorate_tools.simulate.motion import Bout, Start, hand

from .deceived_worlds import WORLDS, aircraft, begun_in_a_turn, pieces, tremor
from .peers import Decision
from .tables import number, table

Array = NDArray[np.float64]
KNOWN, COLD = "known", "cold"
SURE_S = 60.0
SIGMAS = 3.0
OFF_DPS = 0.02
_WORLD_S = 600.0
_REST_S = (90.0, 200.0)
_HANDLED_S = 5.0
_KNOCKED_S = 300.0
_FAULT_S = (100.0, 251.0)
_FOLLOWED_S = 90.0
_SCALES: dict[str, Any] = {"gyro_lsb_per_dps": 131.0, "accel_lsb_per_g": 16384.0}
_TEMP: dict[str, Any] = {"temp_lsb_per_degc": 340.0, "temp_offset_degc": 36.53}
_KNOCK = "a knock"
_STEPS = 2 * len(WORLDS) + 1
#: What was known before -> most runs sure of a wrong bias, %, and the worst error while sure, mdps.
LIMITS = {KNOWN: (2.0, 100.0), COLD: (10.0, float("inf"))}
_LEAST_HONEST, _LEAST_FOLLOWED = 90.0, 95.0
_INTRODUCTION = """\
# Certain of a wrong bias, measured

`zerorate bench deceived --seeds {seeds}` wrote this page.

Each row has {seeds} runs: ten minutes of turns that look like a bias, at 25, 50 or 100 Hz, with
0.03 to 0.1 dps of noise (`tools/zerorate_bench/deceived_worlds.py`). An axis is certain of a wrong
bias while its error exceeds both 20 mdps and three of its own sigmas.

| column | what it is |
| --- | --- |
| wrong for 60 s | runs in which an axis is certain of a wrong bias for more than 60 s in all |
| worst, mdps | largest such error, however briefly |
| within 2 sigma | share of the time in which the truth lies within two sigma |
"""
_HEAD = ["turns", "wrong for 60 s", "worst, mdps", "within 2 sigma", "must be", "met"]
_TITLES = {KNOWN: "After 90 to 200 s of rest and 5 s in the hand", COLD: "Nothing known before"}
_FOLLOWED = """\
After 90 s or more of rest a knock moves the bias by 0.2 to 3 dps on every axis. True rests of 15 to
60 s follow. The jump is followed if every axis is within 20 mdps after 90 s of rest.
"""


@dataclass(frozen=True)
class Run:
    """A recording, and the truth: bias_dps and still, (n, 3) and (n,); judged from that sample."""

    recording: Recording
    bias_dps: Array
    still: NDArray[np.bool_]
    first: int


def made(name: str, seed: int, known: bool) -> Run:
    """The run of that world and seed, or of a knock; the same at every call."""
    rng = np.random.default_rng([seed, crc32(name.encode()), known])
    hz = float(rng.choice([25.0, 50.0, 100.0]))
    lean = rng.standard_normal(3) * 0.1 + [0, 0, 1]
    up = lean / np.linalg.norm(lean)
    parts = [*(_resting(rng, hz, up) if known else ()), _world(name, rng, hz, up)]
    rate, accel = (np.concatenate(both) for both in zip(*parts))
    first = len(rate) - len(parts[-1][0])
    bias = np.tile(rng.normal(0, 1.0, 3), (len(rate), 1))
    if name == _KNOCK:
        bias[first:] += rng.choice([-1, 1], 3) * rng.uniform(0.2, 3.0, 3)
    recording = _recorded(rng, hz, rate + bias, accel, name)
    return Run(recording, bias, np.logical_not(rate.any(axis=1)), first)


def _start(rng: np.random.Generator, hz: float, up: Array, seconds: float) -> Start:
    return Start(rng, np.arange(1, round(seconds * hz) + 1) / hz, 1 / hz, up)


def _felt(start: Start, bout: Bout) -> tuple[Array, Array]:
    """Rates and specific force, g, in the body."""
    turned = integrate(bout.rate_dps, start.dt_s, facing(start.up))
    gravity = into_body(turned, np.array([0.0, 0.0, 1.0]))
    return bout.rate_dps, gravity if bout.push_g is None else gravity + bout.push_g


def _resting(rng: np.random.Generator, hz: float, up: Array) -> Iterator[tuple[Array, Array]]:
    still = _start(rng, hz, up, rng.uniform(*_REST_S))
    yield _felt(still, Bout(np.zeros((len(still.t_s), 3))))
    held = _start(rng, hz, up, _HANDLED_S)
    yield _felt(held, hand(held))


def _world(name: str, rng: np.random.Generator, hz: float, up: Array) -> tuple[Array, Array]:
    start = _start(rng, hz, up, _KNOCKED_S if name == _KNOCK else _WORLD_S)
    bout = _rests(start) if name == _KNOCK else WORLDS[name](start)
    if name != _KNOCK and WORLDS[name] is aircraft and bout.push_g is not None:
        return bout.rate_dps, bout.push_g  # the seat's
    return _felt(start, bout)


def _rests(start: Start) -> Bout:
    """True rests of 15 to 60 s, two seconds in the hand between."""
    number_of = pieces(start, 15.0, 60.0, float)
    changed = np.convolve(np.diff(number_of, prepend=0) != 0, np.ones(round(2 / start.dt_s)))
    return Bout(hand(start).rate_dps * (changed[: len(number_of)] > 0)[:, None])


def _recorded(
    rng: np.random.Generator, hz: float, rate: Array, accel: Array, name: str
) -> Recording:
    """What a part with white noise, warming by 2 degC, says."""
    n = len(rate)
    gyro = rate + rng.standard_normal((n, 3)) * rng.uniform(0.03, 0.1)
    force = accel + rng.standard_normal((n, 3)) * 0.003
    warm = 25.0 + 2.0 * np.arange(n) / n + rng.standard_normal(n) * 0.02
    if WORLDS.get(name) is tremor:
        stuck = slice(
            n + round((_FAULT_S[0] - _WORLD_S) * hz), n + round((_FAULT_S[1] - _WORLD_S) * hz)
        )
        gyro[stuck] = rng.uniform(-6, 6, 3)
        if rng.integers(2):  # else the gyroscope alone stands still
            force[stuck] = force[stuck.start]
    columns = {"t_us": np.round(np.arange(n) * 1e6 / hz).astype(np.int64)}
    columns |= counts("g", gyro * _SCALES["gyro_lsb_per_dps"])
    columns |= counts("a", force * _SCALES["accel_lsb_per_g"])
    columns["temp"] = np.round((warm - 36.53) * 340.0).astype(np.int64)
    return Recording(columns, Scales("MPU-6050", hz, **_SCALES, **_TEMP), name)


def judged(run: Run) -> dict[str, Any]:
    """sure_s: longest of the axes' times sure of a wrong bias; worst_mdps; honest: a share."""
    bias, sigma, source = Decision().states(given(run.recording))
    part = slice(run.first, None)
    error, sigma = np.abs(bias - run.bias_dps)[part], sigma[part]
    known = source[part] > 0
    wrong = known & (error > SIGMAS * sigma) & (error > OFF_DPS)
    inside = (error < 2 * sigma)[known]
    return {
        "sure_s": float(wrong.sum(axis=0).max() / run.recording.scales.odr_hz),
        "worst_mdps": float(1000 * error[wrong].max()) if wrong.any() else 0.0,
        "honest": float(inside.mean()) if inside.size else 1.0,
    }


def followed(run: Run) -> bool:
    """Whether the bias is within 20 mdps after 90 s of rest."""
    bias = Decision().states(given(run.recording))[0]
    rested_s = np.cumsum(run.still[run.first :]) / run.recording.scales.odr_hz
    at = run.first + int(np.searchsorted(rested_s, _FOLLOWED_S))
    return bool(np.all(np.abs(bias - run.bias_dps)[at] < OFF_DPS))


def steps(seeds: int) -> int:
    """How many steps `run` tells of."""
    return _STEPS * seeds


def run(seeds: int, advance: Callable[[float], None] = lambda n: None) -> dict[str, Any]:
    """known, cold: world -> each seed's figures; followed: each seed's; seeds."""
    found: dict[str, Any] = {"seeds": seeds, KNOWN: {}, COLD: {}}
    for name, world in WORLDS.items():
        for before in (KNOWN, COLD):
            if world is begun_in_a_turn and before == KNOWN:
                continue
            rows = found[before][name] = []
            for seed in range(seeds):
                rows.append(judged(made(name, seed, before == KNOWN)))
                advance(1)
    found["followed"] = [followed(made(_KNOCK, seed, True)) for seed in range(seeds)]
    return found


def in_markdown(found: Mapping[str, Any]) -> str:
    """The page: a table for each that was known before, and the knock."""
    parts = [_INTRODUCTION.format(seeds=found["seeds"])]
    for before, title in _TITLES.items():
        parts += [f"## {title}\n", table(_HEAD, list(_rows(found[before], before)))]
    share = 100 * float(np.mean(found["followed"]))
    met = "yes" if share >= _LEAST_FOLLOWED else "**NO**"
    row = [_KNOCK, f"{share:.0f} %", f"at least {_LEAST_FOLLOWED:.0f} %", met]
    parts += ["## A jump\n", _FOLLOWED, table(["", "followed", "must be", "met"], [row])]
    return "\n".join(parts)


def _rows(worlds: Mapping[str, list[dict]], before: str) -> Iterator[list[str]]:
    every = [row for rows in worlds.values() for row in rows]
    for name, rows in (*worlds.items(), ("**all**", every)):
        yield [name, *_row(rows, before)]


def _row(rows: list[dict], before: str) -> list[str]:
    count = sum(row["sure_s"] > SURE_S for row in rows)
    worst = max(row["worst_mdps"] for row in rows)
    honest = 100 * float(np.mean([row["honest"] for row in rows]))
    most, most_mdps = LIMITS[before]
    met = 100 * count <= most * len(rows) and worst <= most_mdps
    wanted = f"at most {most:.0f} %"
    if before == COLD:
        met, wanted = met and honest >= _LEAST_HONEST, wanted + ", 90 % within 2 sigma"
    else:
        wanted += f", {most_mdps:.0f} mdps"
    shown = [f"{count} of {len(rows)}", number(worst), f"{honest:.0f} %", wanted]
    return [*shown, "yes" if met else "**NO**"]
