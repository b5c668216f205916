"""Extra channels: supply, load, humidity, or one that nobody records."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .noise import gauss_markov
from .paths import durations, path

Table = Mapping[str, Any]


@dataclass
class Channel:
    """values (n,) in the channel's unit; its column, if recorded, counts `lsb` of that unit."""

    values: np.ndarray
    recorded: bool = True
    lsb: float = 1.0
    noise: float = 0.0


@dataclass
class Clock:
    """A session's random stream for one channel and its sample times (n,) s, dt_s apart."""

    rng: np.random.Generator
    t_s: np.ndarray
    dt_s: float


def wander(
    clock: Clock, *, mean: float = 0.0, std: float = 1.0, tau_s: float = 600.0
) -> np.ndarray:
    """First-order random about a mean."""
    n = len(clock.t_s)
    return mean + gauss_markov(clock.rng, n, clock.dt_s, tau_s, np.array([std]))[:, 0]


def levels(
    clock: Clock, *, low: float = 0.0, high: float = 1.0, mean_s: float = 300.0
) -> np.ndarray:
    """Random levels between low and high, each held mean_s on average."""
    change = np.cumsum(clock.rng.random(len(clock.t_s)) < clock.dt_s / mean_s)
    return clock.rng.uniform(low, high, change[-1] + 1)[change]


def square(
    clock: Clock, *, low: float = 0.0, high: float = 1.0, period_s: float, share: float = 0.5
) -> np.ndarray:
    """On and off: high for this share of each period."""
    return np.where((clock.t_s / period_s) % 1.0 < share, high, low)


def along(clock: Clock, *, start: float, path: list[Table]) -> np.ndarray:
    """A path of ramps, holds and exponentials, as temperature's."""
    return _path(clock.t_s, start, path)


def constant(clock: Clock, *, value: float) -> np.ndarray:
    """One value."""
    return np.full(len(clock.t_s), float(value))


def _path(t_s: np.ndarray, start: float, segments: list[Table]) -> np.ndarray:
    return path(t_s, start, segments, durations(start, segments))


CHANNELS: dict[str, Callable[..., np.ndarray]] = {
    "wander": wander,
    "levels": levels,
    "square": square,
    "path": along,
    "constant": constant,
}
