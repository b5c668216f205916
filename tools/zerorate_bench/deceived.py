"""How often the firmware is sure of a wrong bias in worlds whose turns look like one."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any
from zlib import crc32

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.peers import given
from zerorate_tools.recordings import Recording, Scales
from zerorate_tools.simulate.device import counts
from zerorate_tools.simulate.motion import Bout, Start, body_axis, hand, rest, tremble

from .heading_simulated import felt
from .peers import Decision
from .tables import measured, number, table

Array = NDArray[np.float64]
_G_MPS2 = 9.80665
_EDGE_S = 0.5


# A world takes a `Start` and returns a `Bout`, ten minutes of what truly turns and pushes. Every
# world is drawn anew for each seed.


def pieces(
    start: Start, shortest_s: float, longest_s: float, draw: Callable[[int], float]
) -> Array:
    """(n,) a value that `draw` gives for each piece by its number; pieces of random length."""
    n = len(start.t_s)
    lengths = start.rng.uniform(shortest_s, longest_s, int(start.t_s[-1] / shortest_s) + 2)
    ends = np.ceil(np.cumsum(lengths) / start.dt_s).astype(int)
    number = np.searchsorted(ends, np.arange(n), side="right")
    return np.array([draw(k) for k in range(number[-1] + 1)])[number]


def smooth(start: Start, values: Array, edge_s: float = _EDGE_S) -> Array:
    """(n,) the same, each step of it as long as `edge_s`."""
    width = max(round(edge_s / start.dt_s), 1)
    padded = np.pad(values, (width - 1, 0), mode="edge")
    sums = np.cumsum(np.insert(padded, 0, 0.0))
    return np.asarray((sums[width:] - sums[:-width]) / width)


def about_vertical(start: Start, turn_dps: Array) -> Array:
    """(n, 3) rates of a turn about the vertical, which gravity never shows."""
    return np.asarray(turn_dps[:, None] * start.up)


def kicks(start: Start, turn_dps: Array, long_s: float, dps: float) -> Array:
    """(n, 3) shakes of so long a time wherever the turn changes; they come back."""
    changed = np.diff(turn_dps, prepend=turn_dps[0]) != 0
    width = max(round(long_s / start.dt_s), 2)
    at = np.convolve(changed, np.ones(width))[: len(changed)] > 0
    angle = start.rng.standard_normal((len(at), 3)) * dps * start.dt_s * at[:, None]
    return np.diff(angle, axis=0, prepend=np.zeros((1, 3))) / start.dt_s


def pans(start: Start) -> Bout:
    """About the vertical in pieces of 0.8 to 6 s, kicks of 0.3 s between; one sign or two."""
    sign, fast = start.rng.integers(2), start.rng.uniform(0.5, 14.0)
    draw = lambda k: fast * start.rng.uniform(0.7, 1.0) * (-1) ** (k * sign)  # noqa: E731
    turn = pieces(start, 0.8, 6.0, draw)
    return Bout(about_vertical(start, turn) + kicks(start, turn, 0.3, 20.0))


def pan_head(start: Start) -> Bout:
    """A motor's pan head: 0.4 to 4 dps, left and right, a tremor of a second between."""
    fast = start.rng.uniform(0.4, 4.0)
    turn = pieces(start, 8.0, 40.0, lambda k: fast * (-1) ** k)
    return Bout(about_vertical(start, smooth(start, turn)) + kicks(start, turn, 1.0, 2.0))


def vacuum(start: Start) -> Bout:
    """A robot vacuum: turns of 40 dps on the spot, arcs, straight runs, stops."""
    turn = pieces(start, 2.0, 12.0, lambda k: start.rng.choice([-40.0, 40.0, -8.0, 8.0, 0.0, 0.0]))
    runs = pieces(start, 5.0, 20.0, lambda k: start.rng.choice([0.0, 1.0]))
    hum = start.rng.standard_normal((len(turn), 3)) * 0.004 * runs[:, None]
    return Bout(about_vertical(start, smooth(start, turn)), hum)


def aircraft(start: Start) -> Bout:
    """Coordinated turns of 1.5 or 3 dps: gravity stays in the seat, and is more than 1 g."""
    fast, speed_mps = start.rng.choice([1.5, 3.0]), start.rng.uniform(40.0, 80.0)
    turn = pieces(start, 30.0, 120.0, lambda k: fast * start.rng.choice([-1.0, 0.0, 1.0]))
    turn = smooth(start, turn, 4.0)
    bank = np.arctan(np.radians(turn) * speed_mps / _G_MPS2)
    roll = np.degrees(np.gradient(bank, start.dt_s))
    along, aside = body_axis("level", start), np.cross(start.up, body_axis("level", start))
    rate = turn[:, None] * (np.cos(bank)[:, None] * start.up + np.sin(bank)[:, None] * aside)
    rate = rate + roll[:, None] * along
    return Bout(rate, (1 / np.cos(bank))[:, None] * start.up)


def car(start: Start, mps: float = 0.0) -> Bout:
    """Long gentle curves and stops; what a curve presses sideways at that speed."""
    draw = lambda k: 0.0 if k % 3 == 2 else start.rng.uniform(-4.0, 4.0)  # noqa: E731
    turn = smooth(start, pieces(start, 15.0, 60.0, draw), 3.0)
    sideways = np.cross(start.up, body_axis("level", start))
    return Bout(about_vertical(start, turn), (np.radians(turn) * mps / _G_MPS2)[:, None] * sideways)


def creep(start: Start) -> Bout:
    """Slow turns about the vertical, 0.05 to 1.2 dps, a shake of the hand between."""
    fast = np.exp(start.rng.uniform(np.log(0.05), np.log(1.2)))
    turn = pieces(start, 20.0, 80.0, lambda k: fast * start.rng.uniform(0.8, 1.2))
    return Bout(about_vertical(start, turn) + kicks(start, turn, 2.0, 30.0))


def boat(start: Start) -> Bout:
    """At its mooring: 0.05 to 0.5 degrees about two level axes, every 4 to 12 s."""
    w = 2 * np.pi / start.rng.uniform(4.0, 12.0, 2)
    size = start.rng.uniform(0.05, 0.5, 2) * w
    along, aside = body_axis("level", start), np.cross(start.up, body_axis("level", start))
    wave = size * np.cos(np.outer(start.t_s, w) + start.rng.uniform(0, 2 * np.pi, 2))
    return Bout(wave @ np.stack([along, aside]))


def anchored(start: Start) -> Bout:
    """A ship at anchor on a flat sea: it yaws by 5 to 30 degrees every 3 to 12 minutes."""
    w = 2 * np.pi / start.rng.uniform(180.0, 720.0)
    yaw = start.rng.uniform(5.0, 30.0) * w
    return Bout(about_vertical(start, yaw * np.cos(w * start.t_s + start.rng.uniform(0.0, 7.0))))


def coning(start: Start) -> Bout:
    """A steady 1 to 5 dps about an axis 1 to 30 degrees off the vertical."""
    tilt = np.radians(start.rng.uniform(1.0, 30.0))
    axis = np.cos(tilt) * start.up + np.sin(tilt) * body_axis("level", start)
    return Bout(np.tile(start.rng.uniform(1.0, 5.0) * axis, (len(start.t_s), 1)))


def begun_in_a_turn(start: Start) -> Bout:
    """Switched on in a turn of 0.3 to 5 dps about the vertical that ends after 2 to 100 s."""
    ends_s = np.exp(start.rng.uniform(np.log(2.0), np.log(100.0)))
    turn = np.where(start.t_s < ends_s, start.rng.uniform(0.3, 5.0), 0.0)
    return Bout(about_vertical(start, turn))


def level_turn(start: Start) -> Bout:
    """A steady 0.03 to 0.1 dps about a level axis, which gravity shows within its noise."""
    axis = body_axis("level", start)
    return Bout(np.tile(start.rng.uniform(0.03, 0.1) * axis, (len(start.t_s), 1)))


#: Held in the hand; what stands still in it is a fault of the bus.
tremor = partial(tremble, dps=5.0)


#: Its words in the table -> the world.
WORLDS: dict[str, Callable[[Start], Bout]] = {
    "pans in short pieces, kicks between": pans,
    "motorised pan head, tremor between": pan_head,
    "robot vacuum": vacuum,
    "aircraft in coordinated turns": aircraft,
    "car, long gentle curves, stops": car,
    "car, with lateral acceleration": partial(car, mps=12.0),
    "slow creep between handlings": creep,
    "boat, 0.05 to 0.5 degrees": boat,
    "ship at anchor, yaws for minutes": anchored,
    "coning, 1 to 5 dps": coning,
    "switched on in a turn": begun_in_a_turn,
    "level turns of 0.03 to 0.1 dps": level_turn,
    "bus fault: constant rates for 151 s": tremor,
}


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
_KNOCK = "a knock"
#: What was known before -> most runs sure of a wrong bias, %, and the worst error while sure, mdps.
LIMITS = {KNOWN: (2.0, 100.0), COLD: (10.0, float("inf"))}
_LEAST_HONEST, _LEAST_FOLLOWED = 90.0, 95.0
_INTRODUCTION = """\
# Certain of a wrong bias, measured

`zerorate bench deceived --seeds {seeds}` wrote this page.

Each row has {seeds} runs: ten minutes of turns that look like a bias, in any pose, at 25, 50 or
100 Hz, with 0.03 to 0.1 dps of noise (`tools/zerorate_bench/deceived.py`). An axis is certain of a
wrong bias while its error exceeds both 20 mdps and three of its own sigmas.

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


#: A recording, and the truth: bias in dps and rest, (n, 3) and (n,); judged from that sample on.
Run = tuple[Recording, Array, NDArray[np.bool_], int]


def made(name: str, seed: int, known: bool) -> Run:
    """The run of that world and seed, or of a knock; the same at every call."""
    rng = np.random.default_rng([seed, crc32(name.encode()), known])
    hz = float(rng.choice([25.0, 50.0, 100.0]))
    pose = rng.standard_normal(3)
    up = pose / np.linalg.norm(pose)
    acts: list[tuple[Callable[[Start], Bout], float]] = []
    acts += [(rest, rng.uniform(*_REST_S)), (hand, _HANDLED_S)] if known else []
    acts.append((_rests, _KNOCKED_S) if name == _KNOCK else (WORLDS[name], _WORLD_S))
    parts = []
    for act, seconds in acts:
        start = Start(rng, np.arange(1, round(seconds * hz) + 1) / hz, 1 / hz, up)
        bout = act(start)
        seat = np.asarray(bout.push_g)  # all that is felt in an aircraft
        parts.append((bout.rate_dps, seat) if act is aircraft else felt(start, bout)[:2])
    rate, accel = (np.concatenate(both) for both in zip(*parts))
    first = len(rate) - len(parts[-1][0])
    bias = np.tile(rng.normal(0, 1.0, 3), (len(rate), 1))
    if name == _KNOCK:
        bias[first:] += rng.choice([-1, 1], 3) * rng.uniform(0.2, 3.0, 3)
    recording = _recorded(rng, hz, rate + bias, accel, name)
    return recording, bias, np.logical_not(rate.any(axis=1)), first


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
        stuck = slice(*(n + round((at_s - _WORLD_S) * hz) for at_s in _FAULT_S))
        gyro[stuck] = rng.uniform(-6, 6, 3)
        if rng.integers(2):  # else the gyroscope alone stands still
            force[stuck] = force[stuck.start]
    columns = {"t_us": np.round(np.arange(n) * 1e6 / hz).astype(np.int64)}
    columns |= counts("g", gyro * 131.0) | counts("a", force * 16384.0)
    columns["temp"] = np.round((warm - 36.53) * 340.0).astype(np.int64)
    return Recording(columns, Scales("MPU-6050", hz, 131.0, 16384.0, 340.0, 36.53), name)


def judged(run: Run) -> dict[str, Any]:
    """sure_s: longest of the axes' times sure of a wrong bias; worst_mdps; honest: a share."""
    recording, truth_dps, _, first = run
    bias, sigma, source = (of[first:] for of in Decision().states(given(recording)))
    error, known = np.abs(bias - truth_dps[first:]), source > 0
    wrong = known & (error > SIGMAS * sigma) & (error > OFF_DPS)
    inside = (error < 2 * sigma)[known]
    return {
        "sure_s": float(wrong.sum(axis=0).max() / recording.scales.odr_hz),
        "worst_mdps": float(1000 * error[wrong].max()) if wrong.any() else 0.0,
        "honest": float(inside.mean()) if inside.size else 1.0,
    }


def followed(run: Run) -> bool:
    """Whether the bias is within 20 mdps after 90 s of rest."""
    recording, truth_dps, still, first = run
    bias = Decision().states(given(recording))[0]
    rested_s = np.cumsum(still[first:]) / recording.scales.odr_hz
    at = first + int(np.searchsorted(rested_s, _FOLLOWED_S))
    return bool(np.all(np.abs(bias - truth_dps)[at] < OFF_DPS))


def run(seeds: int) -> dict[str, Any]:
    """known, cold: world -> each seed's figures; followed: each seed's; seeds."""
    found: dict[str, Any] = {"seeds": seeds, KNOWN: {}, COLD: {}}
    for name, world in measured(WORLDS.items()):
        for before in (KNOWN, COLD):
            if world is not begun_in_a_turn or before == COLD:
                runs = (made(name, seed, before == KNOWN) for seed in range(seeds))
                found[before][name] = [*map(judged, runs)]
    found["followed"] = [followed(made(_KNOCK, seed, True)) for seed in range(seeds)]
    return found


def in_markdown(found: Mapping[str, Any]) -> str:
    """The page: a table for each that was known before, and the knock."""
    parts = [_INTRODUCTION.format(seeds=found["seeds"])]
    for before, title in _TITLES.items():
        every = [row for rows in found[before].values() for row in rows]
        worlds = {**found[before], "**all**": every}
        rows = [[name, *_row(rows, before)] for name, rows in worlds.items()]
        parts += [f"## {title}\n", table(_HEAD, rows)]
    share = 100 * float(np.mean(found["followed"]))
    met = "yes" if share >= _LEAST_FOLLOWED else "**NO**"
    row = [_KNOCK, f"{share:.0f} %", f"at least {_LEAST_FOLLOWED:.0f} %", met]
    parts += ["## A jump\n", _FOLLOWED, table(["", "followed", "must be", "met"], [row])]
    return "\n".join(parts)


def _row(rows: list[dict[str, Any]], before: str) -> list[str]:
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
