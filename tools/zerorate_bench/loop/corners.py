"""Recordings whose temperature turns sharply: chargers, freezers and doors.

The part warms later than its thermometer, or earlier, and its board slower than either, which bends
it with play. So the bias changes abruptly at every corner of the temperature. None is a step.
"""

import numpy as np
from zerorate_tools.loop.read.blocks import dequantise
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.model.term import first_order_lag, play

from .simulated import BLOCK_S, Device, noise, noise_level

KINDS = ("charger", "freezer", "door")
TICKS, _BLOCKS = 20, 180
_TICK_S = BLOCK_S / TICKS
#: Readings of a thermometer, degC: of common parts.
_READINGS_DEGC = (1 / 326.8, 1 / 16, 1 / 2)


def simulate_corners(seed: int) -> Device:
    """One recording of a device with a bias that bends over its own temperature and no step."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    around = {"charger": _charger, "freezer": _freezer, "door": _door}[kind](rng, _BLOCKS * TICKS)
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
        *(BLOCK_S, TICKS),
        made + curve.reshape(_BLOCKS, TICKS, 3).mean(axis=1) + rng.normal(0, 0.5, 3),
        np.ones(_BLOCKS),
        {"temp": shown},
        temp_step_degc=step,
    )
    return Device([session], [made], floor, [kind])


def _log_uniform(rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _charger(rng, ticks: int) -> np.ndarray:
    """Heat of a constant current, which is switched on, turned down and off again, in a room."""
    level = np.zeros(ticks)
    at = int(rng.uniform(0.1, 0.3) * ticks)
    down, off = at + int(rng.uniform(0.1, 0.3) * ticks), at + int(rng.uniform(0.35, 0.55) * ticks)
    power = rng.uniform(6.0, 25.0)
    level[at:down], level[down:off] = power, rng.uniform(0.3, 0.7) * power
    return rng.uniform(18.0, 26.0) + first_order_lag(level, _log_uniform(rng, 40, 900), _TICK_S)


def _freezer(rng, ticks: int) -> np.ndarray:
    """A room, then the freezer, whose compressor runs and rests in turn, and out again."""
    at = (np.arange(ticks) * _TICK_S) % (period := rng.uniform(500.0, 1400.0))
    runs = rng.uniform(0.3, 0.6) * period
    saw = np.interp(at, [0.0, runs, period], [1.0, -1.0, 1.0]) * rng.uniform(1.0, 3.0)
    inside = np.zeros(ticks, bool)
    inside[int(rng.uniform(0.05, 0.25) * ticks) : int(rng.uniform(0.7, 0.95) * ticks)] = True
    room, cold = rng.uniform(18.0, 26.0), rng.uniform(-22.0, -5.0)
    return first_order_lag(np.where(inside, cold + saw, room), rng.uniform(40.0, 500.0), _TICK_S)


def _door(rng, ticks: int) -> np.ndarray:
    """A warm room, in which doors let the cold in for some minutes, several times."""
    draught = np.zeros(ticks)
    for start in rng.uniform(0.05, 0.9, int(rng.integers(2, 6))):
        first, long = int(start * ticks), int(rng.uniform(60.0, 400.0) / _TICK_S)
        draught[first : first + long] = rng.uniform(4.0, 15.0)
    return rng.uniform(20.0, 30.0) - first_order_lag(draught, rng.uniform(20.0, 120.0), _TICK_S)
