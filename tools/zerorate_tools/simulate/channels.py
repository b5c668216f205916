"""What goes its way over time: noise by its colour, a path of temperature, extra channels."""

import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.signal import lfilter

_OCTAVES_TO_S = 4e4


def stream(seed: int, session: int, purpose: str) -> np.random.Generator:
    """A generator for one purpose of one session.

    Noise stays the same sample for sample when an effect is added, so two runs differ by it alone.
    """
    return np.random.default_rng([seed, session, zlib.crc32(purpose.encode())])


def flicker(rng: np.random.Generator, n: int, dt_s: float, floor: np.ndarray) -> np.ndarray:
    """(n, axes) flicker noise whose Allan deviation is flat at `floor` (axes,), same unit.

    A sum of first-order Gauss-Markov processes, one per octave of time constant from dt to 4e4 s,
    all of one variance s2: one-sided density h/f with h = s2/ln 2, Allan variance 2 ln2 h
    (IEEE Std 952, annex C; the factor 0.664 of some data sheets is this over the bias instability).
    """
    std = np.asarray(floor, float) / np.sqrt(2.0)
    total = np.zeros((n, len(std)))
    octaves = np.arange(max(int(np.ceil(np.log2(_OCTAVES_TO_S / dt_s))), 1))
    for tau_s in dt_s * 2.0**octaves:
        total += gauss_markov(rng, n, dt_s, tau_s, std)
    return total


def gauss_markov(
    rng: np.random.Generator, n: int, dt_s: float, tau_s: float, std: np.ndarray
) -> np.ndarray:
    """(n, axes) stationary first-order process of correlation time tau_s and deviation `std`."""
    keep = np.exp(-dt_s / tau_s)
    drive = rng.standard_normal((n, len(std))) * (std * np.sqrt(1 - keep**2))
    first = rng.standard_normal((1, len(std))) * std
    return lfilter([1.0], [1.0, -keep], drive, axis=0, zi=keep * first)[0]


def random_walk(rng: np.random.Generator, n: int, dt_s: float, step: np.ndarray) -> np.ndarray:
    """(n, axes) walk from zero; step (axes,) is its deviation after one second."""
    steps = rng.standard_normal((n, len(step))) * (np.asarray(step) * np.sqrt(dt_s))
    steps[:1] = 0.0
    return np.cumsum(steps, axis=0)


def telegraph(
    rng: np.random.Generator, n: int, dt_s: float, size: np.ndarray, mean_s: float
) -> np.ndarray:
    """(n, axes) jumps between -size/2 and +size/2, each level held mean_s on average."""
    flips = rng.random((n, len(size))) < dt_s / mean_s
    flips[0] = rng.random(len(size)) < 0.5
    return (np.cumsum(flips, axis=0) % 2 - 0.5) * size


def power_law(
    rng: np.random.Generator, n: int, dt_s: float, std: np.ndarray, exponent: float
) -> np.ndarray:
    """(n, axes) noise with density f**-exponent and deviation `std` over these n samples."""
    frequency = np.fft.rfftfreq(n, dt_s)
    shape = np.zeros_like(frequency)
    shape[1:] = frequency[1:] ** (-exponent / 2)
    spectrum = np.fft.rfft(rng.standard_normal((n, len(std))), axis=0) * shape[:, None]
    coloured = np.fft.irfft(spectrum, n, axis=0)
    return coloured / np.maximum(coloured.std(axis=0), 1e-300) * std


def outliers(
    rng: np.random.Generator, n: int, dt_s: float, size: float, per_hour: float
) -> np.ndarray:
    """(n, 3) rare single readings off by a normal deviate of deviation `size`."""
    hit = rng.random(n) < per_hour * dt_s / 3600
    return np.where(hit[:, None], rng.standard_normal((n, 3)) * size, 0.0)


Table = Mapping[str, Any]
_SECONDS = {"s": 1.0, "minutes": 60.0, "hours": 3600.0}


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
    return course(clock.t_s, start, path, durations(start, path))


def constant(clock: Clock, *, value: float) -> np.ndarray:
    """One value."""
    return np.full(len(clock.t_s), float(value))


CHANNELS: dict[str, Callable[..., np.ndarray]] = {
    "wander": wander,
    "levels": levels,
    "square": square,
    "path": along,
    "constant": constant,
}


def seconds(table: Mapping[str, Any]) -> float | None:
    """The duration that a table gives as s, minutes or hours (their sum), or None."""
    given = [float(table[key]) * factor for key, factor in _SECONDS.items() if key in table]
    return sum(given) if given else None


def durations(start: float, segments: Sequence[Mapping[str, Any]]) -> list[float]:
    """Seconds of each segment; a ramp may give `degc_per_min` instead."""
    lengths, value = [], start
    for segment in segments:
        length = seconds(segment)
        if length is None:
            length = abs(segment["to"] - value) / abs(segment["degc_per_min"]) * 60
        lengths.append(length)
        value = float(segment.get("to", value))
    return lengths


def course(
    t_s: np.ndarray, start: float, segments: Sequence[Mapping[str, Any]], lengths: Sequence[float]
) -> np.ndarray:
    """(n,) values at t_s; after the last segment the last value holds.

    Segment: `to` alone is a ramp; `to` with tau_s an exponential that arrives there at its end;
    `cycle` with period_minutes a sine of that amplitude about the value reached; neither a hold.
    """
    out, value, begin = np.full(len(t_s), float(start)), float(start), 0.0
    for segment, length in zip(segments, lengths):
        here = t_s >= begin
        u = np.minimum(t_s[here] - begin, length)
        out[here] = _segment(u, value, segment, length)
        value = float(_segment(np.array([length]), value, segment, length)[0])
        begin += length
    return out


def _segment(u: np.ndarray, value: float, segment: Mapping[str, Any], length: float) -> np.ndarray:
    if "cycle" in segment:
        return value + segment["cycle"] * np.sin(2 * np.pi * u / (segment["period_minutes"] * 60))
    if "tau_s" in segment:
        tau_s = segment["tau_s"]
        return value + (segment["to"] - value) * np.expm1(-u / tau_s) / np.expm1(-length / tau_s)
    return value + (segment.get("to", value) - value) * u / length
