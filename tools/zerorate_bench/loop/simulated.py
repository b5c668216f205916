"""A fast simulated device at block level, for the loop's tests and its table of false alarms.

Noise, temperature path and channels are drawn from a seed; `added_effects` adds effects.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from scipy.fft import irfft, rfft
from zerorate_tools.loop.read.blocks import dequantise
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.model.term import first_order_lag, play

from ..public_data import LONG_RESTS
from .added_effects import add_effect, add_parts

BLOCK_S = 20.0
TICKS = 4
#: The folder of block means is handed to worker processes by the environment.
FOLDER = "ZERORATE_QUIET_BLOCKS"
_GYRO = ("gx_lsb", "gy_lsb", "gz_lsb")
_DPS_PER_LSB = 0.05


@dataclass
class Device:
    """Sessions with what the loop must not see: the noise alone (n, 3) of each session and the
    floor per axis.
    """

    sessions: list[Session]
    noise_dps: list[np.ndarray]
    floor_dps: np.ndarray


def flicker(rng: np.random.Generator, n: int, sigma: float, exponent: float = 1.0) -> np.ndarray:
    """(n,) noise of spectrum sigma^2 / f^exponent (Kasdin 1995, Proc. IEEE 83(5), fractional
    differences).
    """
    k = np.arange(1, 2 * n)
    h = np.concatenate([[1.0], np.cumprod((exponent / 2 + k - 1) / k)])
    white = rng.normal(0, sigma, 2 * n)
    return irfft(rfft(h, 4 * n) * rfft(white, 4 * n))[n : 2 * n]


def temperature_path(rng: np.random.Generator, ticks: int, tick_s: float) -> np.ndarray:
    """(ticks,) degC: chamber-like ramps up and down at three rates with holds, and the part's own
    heating.
    """
    stretch = max(1.0, ticks * tick_s / 3600.0 / 4)
    t, level = 0.0, rng.uniform(17, 20)
    points, high = [(t, level)], True
    while t < ticks * tick_s:
        to = rng.uniform(33, 36) if high else rng.choice([rng.uniform(17, 20), rng.uniform(23, 29)])
        t += abs(to - level) / rng.choice([0.015, 0.025, 0.05]) * stretch
        points.append((t, to))
        t += rng.uniform(60, 400) * stretch
        points.append((t, to))
        level, high = to, not high
    at = (np.arange(ticks) + 0.5) * tick_s
    ambient = np.interp(at, *np.array(points).T)
    return first_order_lag(ambient, 60.0, tick_s) + 8.0 * (1 - np.exp(-at / rng.uniform(300, 600)))


def _levels(
    rng: np.random.Generator, ticks: int, tick_s: float, every_s: float, low: float, high: float
) -> np.ndarray:
    out, i = np.empty(ticks), 0
    while i < ticks:
        step = max(1, int(rng.exponential(every_s) / tick_s))
        out[i : i + step] = rng.uniform(low, high)
        i += step
    return out


def _wander(rng: np.random.Generator, ticks: int, tick_s: float, tau_s: float) -> np.ndarray:
    walk = np.cumsum(rng.normal(size=ticks + 4000))
    slow = first_order_lag(walk - first_order_lag(walk, tau_s, tick_s), tau_s / 3, tick_s)[4000:]
    return (slow - slow.mean()) / (slow.std() + 1e-12)


def channels(rng: np.random.Generator, ticks: int, tick_s: float) -> dict[str, np.ndarray]:
    """Ticks of temperature, orientation, vibration, supply, and channels outside the catalogue."""
    faces = np.vstack([np.eye(3), -np.eye(3)])
    turn = np.repeat(rng.integers(0, 6, ticks), max(1, int(400 / tick_s)))[:ticks]
    acc = faces[turn] + rng.normal(0, 0.02, (ticks, 3))
    return {
        "temp": temperature_path(rng, ticks, tick_s),
        **{f"acc_{a}": acc[:, i] for i, a in enumerate("xyz")},
        "vib": 0.01 + _levels(rng, ticks, tick_s, 500.0, 0.0, 0.2) ** 2,
        "vdd_mv": (3300 + 40 * _wander(rng, ticks, tick_s, 900.0))
        + _levels(rng, ticks, tick_s, 600.0, -60.0, 60.0),
        "load": _levels(rng, ticks, tick_s, 400.0, 0.0, 1.0),
        "humidity": 45 + 10 * _wander(rng, ticks, tick_s, 1800.0),
    }


def motion(rng: np.random.Generator, ticks: int, tick_s: float) -> dict[str, np.ndarray]:
    """Rates of turn in dps with a reference beside them (a table), at rest in between."""
    out = {}
    for axis in "xyz":
        moving = _levels(rng, ticks, tick_s, 120.0, 0.0, 1.0) > 0.6
        out[f"rate_{axis}"] = moving * _levels(rng, ticks, tick_s, 120.0, -90.0, 90.0)
    return out


def noise(rng: np.random.Generator, n: int, kind: str, level: np.ndarray) -> np.ndarray:
    """(n, 3) dps. level: rows white, flicker, walk per axis; kind: see `HOSTILE`."""
    out = np.empty((n, 3))
    for a in range(3):
        white, pink, walk = level[:, a]
        x = rng.normal(0, white, n) + flicker(rng, n, pink) + np.cumsum(rng.normal(0, walk, n))
        if kind == "walk4":
            x += np.cumsum(rng.normal(0, walk * np.sqrt(15), n))
        elif kind == "steep":
            x += flicker(rng, n, 0.5 * walk * np.sqrt(60.0 / n), 3.0)
        elif kind == "telegraph":
            x += 2.0 * white * (np.cumsum(rng.random(n) < 0.02) % 2)
        elif kind == "outliers":
            x += (rng.random(n) < 0.02) * rng.normal(0, 15 * white, n)
        out[:, a] = x
    return out


HOSTILE = ("walk4", "steep", "telegraph", "outliers", "unequal")


def _hidden(rng: np.random.Generator, n: int) -> np.ndarray:
    """(n,) a slow cause nobody recorded: a different smooth wander in every session."""
    slow = _wander(rng, n * TICKS, BLOCK_S / TICKS, rng.uniform(400, 1800))
    return slow.reshape(n, TICKS).mean(1)


def simulate(
    seed: int,
    effects: Sequence[tuple[str, float]] = (),
    sessions: int = 4,
    hours: float = 1.0,
    noise_kind: str = "plain",
    hidden: float = 0.0,
    bare: bool = False,
) -> Device:
    """A device. effects: (name in `added_effects`, size in floors); hidden: size of a cause that is
    not recorded; bare: temperature only, no further channels.
    """
    rng = np.random.default_rng(seed)
    n = int(hours * 3600 / BLOCK_S)
    floor, level = noise_level(rng)
    made, noises = [], []
    turning = any(name in ("scale-factor", "cross-axis") for name, _ in effects)
    for i in range(sessions):
        sources = channels(rng, n * TICKS, BLOCK_S / TICKS)
        if turning:
            sources.update(motion(rng, n * TICKS, BLOCK_S / TICKS))
        if bare:
            sources = {"temp": sources["temp"]}
        scale = [1.0, 3.0, 0.5, 2.0][i % 4] if noise_kind == "unequal" else 1.0
        noises.append(noise(rng, n, noise_kind, level * scale))
        rate, name = noises[-1].copy(), f"session-{i + 1}"
        made.append(Session(name, BLOCK_S, TICKS, rate, np.ones(n), sources))
    line = rng.normal(0, 0.02, 3)
    for s in made:
        t = s.block_mean(s.sources["temp"]) - 25.0
        s.rate_dps += rng.normal(0, 0.5) + np.outer(t, line) + rng.normal(0, 0.02, 3)
    for name, size in effects:
        add_effect(rng, made, name, size * floor)
    if hidden:
        add_parts(rng, made, [_hidden(rng, n) for _ in made], hidden * floor)
    return Device(made, noises, floor)


def noise_level(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """(3,) floor in dps, and rows of white, flicker and walk of three axes."""
    white = rng.uniform(0.5e-3, 1.0e-3, 3)
    pink = rng.uniform(0.5e-3, 0.9e-3, 3)
    walk = rng.uniform(0.02e-3, 0.07e-3, 3)
    m = np.arange(1, 400)[:, None]
    floor = np.sqrt((white**2 / m + 0.441 * pink**2 + walk**2 * m / 3).min(axis=0))
    return floor, np.array([white, pink, walk])


def write_blocks(data: Path, folder: Path) -> list[str]:
    """Write the block means of the long recordings at rest as .npy, and return their names."""
    names = []
    for pattern, hz in LONG_RESTS.items():
        for path in sorted(data.glob(pattern)):
            table = pq.read_table(path, columns=list(_GYRO))
            rate = np.column_stack([c.to_numpy() for c in table.columns]) * _DPS_PER_LSB
            for seconds in (10, 20):
                per = int(seconds * hz)
                n = len(rate) // per
                names.append(f"{path.stem}-{seconds}s.npy")
                np.save(folder / names[-1], rate[: n * per].reshape(n, per, 3).mean(axis=1))
    return names


def cut_into_sessions(name: str, seed: int) -> tuple[list[Session], list[np.ndarray]]:
    """Four sessions of a quiet recording with simulated channels that mean nothing, and their
    noise. The cuts, their order, the axes' signs and the direction of time are drawn from the seed.
    """
    rng = np.random.default_rng(seed)
    blocks = np.load(Path(os.environ[FOLDER]) / name)
    length = int(rng.uniform(0.18, 0.245) * len(blocks))
    slack = len(blocks) - 4 * length
    starts = np.sort(rng.integers(0, slack + 1, 4)) + length * np.arange(4)
    sign = rng.choice([-1.0, 1.0], 3)
    backwards = rng.random() < 0.5
    out = []
    for i, s in enumerate(starts[rng.permutation(4)]):
        rate = blocks[s : s + length] * sign
        rate = rate[::-1].copy() if backwards else rate.copy()
        sources = channels(rng, length * TICKS, BLOCK_S / TICKS)
        out.append(Session(f"cut-{i + 1}", BLOCK_S, TICKS, rate, np.ones(length), sources))
    return out, [s.rate_dps for s in out]


#: Of recordings whose temperature turns sharply. The part warms later than its thermometer or
#: earlier, and its board slower than either, which bends it with play. So the bias changes abruptly
#: at every corner of the temperature. None is a step.
CORNER_TICKS, _BLOCKS = 20, 180
_TICK_S = BLOCK_S / CORNER_TICKS
#: Readings of a thermometer, degC: of common parts.
_READINGS_DEGC = (1 / 326.8, 1 / 16, 1 / 2)


def simulate_corners(seed: int) -> Device:
    """One recording of a device with a bias that bends over its own temperature and no step."""
    rng = np.random.default_rng(seed)
    around = (_charger, _freezer, _door)[seed % 3](rng, _BLOCKS * CORNER_TICKS)
    shown = first_order_lag(around, _log_uniform(rng, 3.0, 90.0), _TICK_S)
    own = first_order_lag(shown, _log_uniform(rng, 2.0, 120.0), _TICK_S)
    board = first_order_lag(shown, _log_uniform(rng, 150.0, 900.0), _TICK_S)
    if rng.random() < 0.5:  # the thermometer is the late one
        own, shown = shown, own
    floor, level = noise_level(rng)
    made = noise(rng, _BLOCKS, "plain", level)
    curve = np.outer(own - 25.0, rng.normal(0, 0.015, 3))
    curve += np.outer((own - 25.0) ** 2, rng.normal(0, 2e-4, 3))
    bent = play(board, rng.uniform(0.5, 4.0)) if rng.random() < 0.5 else board
    curve += np.outer(bent, rng.normal(0, 0.003, 3))
    step = float(rng.choice(_READINGS_DEGC))
    shown = step * dequantise(np.round((shown + rng.normal(0, 0.02, len(shown))) / step))
    session = Session(
        "corners",
        *(BLOCK_S, CORNER_TICKS),
        made + curve.reshape(_BLOCKS, CORNER_TICKS, 3).mean(axis=1) + rng.normal(0, 0.5, 3),
        np.ones(_BLOCKS),
        {"temp": shown},
        temp_step_degc=step,
    )
    return Device([session], [made], floor)


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _charger(rng: np.random.Generator, ticks: int) -> np.ndarray:
    """Heat of a constant current, which is switched on, turned down and off again, in a room."""
    level = np.zeros(ticks)
    at = int(rng.uniform(0.1, 0.3) * ticks)
    down, off = at + int(rng.uniform(0.1, 0.3) * ticks), at + int(rng.uniform(0.35, 0.55) * ticks)
    power = rng.uniform(6.0, 25.0)
    level[at:down], level[down:off] = power, rng.uniform(0.3, 0.7) * power
    return rng.uniform(18.0, 26.0) + first_order_lag(level, _log_uniform(rng, 40, 900), _TICK_S)


def _freezer(rng: np.random.Generator, ticks: int) -> np.ndarray:
    """A room, then the freezer, whose compressor runs and rests in turn, and out again."""
    at = (np.arange(ticks) * _TICK_S) % (period := rng.uniform(500.0, 1400.0))
    runs = rng.uniform(0.3, 0.6) * period
    saw = np.interp(at, [0.0, runs, period], [1.0, -1.0, 1.0]) * rng.uniform(1.0, 3.0)
    inside = np.zeros(ticks, bool)
    inside[int(rng.uniform(0.05, 0.25) * ticks) : int(rng.uniform(0.7, 0.95) * ticks)] = True
    room, cold = rng.uniform(18.0, 26.0), rng.uniform(-22.0, -5.0)
    return first_order_lag(np.where(inside, cold + saw, room), rng.uniform(40.0, 500.0), _TICK_S)


def _door(rng: np.random.Generator, ticks: int) -> np.ndarray:
    """A warm room, in which doors let the cold in for some minutes, several times."""
    draught = np.zeros(ticks)
    for start in rng.uniform(0.05, 0.9, int(rng.integers(2, 6))):
        first, long = int(start * ticks), int(rng.uniform(60.0, 400.0) / _TICK_S)
        draught[first : first + long] = rng.uniform(4.0, 15.0)
    return rng.uniform(20.0, 30.0) - first_order_lag(draught, rng.uniform(20.0, 120.0), _TICK_S)
