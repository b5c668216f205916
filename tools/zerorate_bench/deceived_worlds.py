"""Worlds in which a turn looks like a bias: what truly turns and pushes, ten minutes of each.

A world takes a `Start` and returns a `Bout`. Every world is drawn anew for each seed.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.simulate.motion import Bout, Start, body_axis, tremble

Array = NDArray[np.float64]
_G_MPS2 = 9.80665
_EDGE_S = 0.5


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


def car_pressed(start: Start) -> Bout:
    """The same at 12 m/s."""
    return car(start, 12.0)


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


def tremor(start: Start) -> Bout:
    """Held in the hand; what stands still in it is a fault of the bus (see deceived.py)."""
    return tremble(start, dps=5.0)


#: Its words in the table -> the world.
WORLDS: dict[str, Callable[[Start], Bout]] = {
    "pans in short pieces, kicks between": pans,
    "motorised pan head, tremor between": pan_head,
    "robot vacuum": vacuum,
    "aircraft in coordinated turns": aircraft,
    "car, long gentle curves, stops": car,
    "car, with lateral acceleration": car_pressed,
    "slow creep between handlings": creep,
    "boat, 0.05 to 0.5 degrees": boat,
    "coning, 1 to 5 dps": coning,
    "switched on in a turn": begun_in_a_turn,
    "level turns of 0.03 to 0.1 dps": level_turn,
    "bus fault: constant rates for 151 s": tremor,
}
