"""Five kinds of motion, and one that deceives: what truly turns and pushes, one stretch of each.

A kind takes a `Start` and returns a `Bout`; its push is specific force in the body, gravity's part
left out. It starts and ends at rest. Every stretch is drawn anew.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from zerorate_tools.simulate.attitude import (
    IDENTITY,
    facing,
    integrate,
    into_body,
    multiply,
    rotation,
)
from zerorate_tools.simulate.motion import Bout, Start, stride, vibration

Array = NDArray[np.float64]
_G_MPS2 = 9.80665
_EDGE_S = 1.0


def hand(start: Start) -> Bout:
    """A phone in the hand: 20 to 80 dps about each axis, the hand sways by 2 to 15 cm."""
    rate = _smooth(start, 0.3, 0.8) * start.rng.uniform(20, 80, 3)
    return Bout(rate, _push(start, rate, _smooth(start, 0.4, 1.5) * start.rng.uniform(0.02, 0.15)))


def walking(start: Start) -> Bout:
    """In a pocket: strides, corners every few seconds, 1 to 1.6 m/s along the path. The leg swings
    about one pose and pushes along the path, so that a walker's speed stays that of a walker."""
    leg = stride(start, dps=start.rng.uniform(60, 140), hz=start.rng.uniform(0.8, 1.1))
    assert leg.push_g is not None
    swung = rotation(np.cumsum(leg.rate_dps, axis=0) * start.dt_s)
    before = np.vstack([IDENTITY, swung[:-1]]) * [1.0, -1.0, -1.0, -1.0]
    vector = multiply(before, swung)[:, 1:]
    swing = np.degrees(2.0 * vector) / start.dt_s
    yaw = _smooth(start, 1.5, 4.0)[:, 0] * 20.0
    speed = start.rng.uniform(1.0, 1.6) * _edges(start)
    rate = swing + _upright(start, swing, yaw)
    pushed = into_body(swung, leg.push_g)  # from the path's frame, which turns by the yaw alone
    return Bout(rate, pushed + _along(start, rate, yaw, speed))


def drone(start: Start) -> Bout:
    """It tilts to accelerate, yaws, and shakes at each sample by 0.1 to 0.4 g."""
    where = _smooth(start, 1.5, 3.0) * start.rng.uniform(0.5, 3.0)
    thrust = _second(where, start.dt_s) / _G_MPS2
    level = np.cross([0.0, 0.0, 1.0], thrust)
    rate = np.degrees(np.gradient(level, start.dt_s, axis=0))
    rate += _smooth(start, 0.2, 0.6) * [25.0, 25.0, 10.0]
    rate += _upright(start, rate, _smooth(start, 1.0, 3.0)[:, 2] * start.rng.uniform(20, 80))
    return Bout(rate, _push(start, rate, where) + _shaken(start, start.rng.uniform(0.1, 0.4)))


def robot(start: Start) -> Bout:
    """On a floor: turns about the vertical only, 0.3 to 1 m/s, a rough floor of 20 mg."""
    yaw = _smooth(start, 0.5, 2.0)[:, 0] * start.rng.uniform(20, 90)
    rate = yaw[:, None] * start.up
    speed = start.rng.uniform(0.3, 1.0) * _edges(start)
    return Bout(rate, _shaken(start, 0.02) + _along(start, rate, yaw, speed))


def headset(start: Start) -> Bout:
    """Looks about: most about the vertical, then up and down, least to the side; leans by 10 cm."""
    sizes = start.rng.uniform(0.6, 1.4, 3) * [12.0, 25.0, 50.0]
    rate = _smooth(start, 0.3, 1.2) * sizes
    return Bout(rate, _push(start, rate, _smooth(start, 0.8, 2.5) * start.rng.uniform(0.03, 0.1)))


def coherent(start: Start) -> Bout:
    """A hand that pushes each time it turns: one period of 2 to 10 s for both."""
    w = 2 * np.pi * start.t_s / start.rng.uniform(2.0, 10.0)
    phase = start.rng.uniform(0, 2 * np.pi, (2, 3))
    rate = np.sin(w[:, None] + phase[0]) * start.rng.uniform(20, 80, 3) * _edges(start)[:, None]
    where = np.sin(w[:, None] + phase[1]) * start.rng.uniform(0.02, 0.2, 3)
    return Bout(rate, _push(start, rate, where))


KINDS: dict[str, Callable[[Start], Bout]] = {
    f.__name__: f for f in (hand, walking, drone, robot, headset)
}


def _smooth(start: Start, least_s: float, most_s: float) -> Array:
    """(n, 3) random, of rms one and of a time drawn in between; nothing at both ends."""
    n, width = len(start.t_s), start.rng.uniform(least_s, most_s) / start.dt_s
    waves = gaussian_filter1d(start.rng.standard_normal((n, 3)), width, axis=0)
    return waves / np.maximum(waves.std(axis=0), 1e-12) * _edges(start)[:, None]


def _edges(start: Start) -> Array:
    at = np.minimum(start.t_s, start.t_s[-1] - start.t_s) / _EDGE_S
    return np.sin(np.pi / 2 * np.clip(at, 0.0, 1.0)) ** 2


def _shaken(start: Start, g: float) -> Array:
    push = vibration(start, g=g).push_g
    assert push is not None
    return push


def _second(where: Array, dt_s: float) -> Array:
    return np.gradient(np.gradient(where, dt_s, axis=0), dt_s, axis=0)


def _upright(start: Start, rate_dps: Array, yaw_dps: Array) -> Array:
    """(n, 3) turns about the vertical of a body that turns otherwise, too."""
    attitude = integrate(rate_dps, start.dt_s, facing(start.up))
    return yaw_dps[:, None] * into_body(attitude, np.array([0.0, 0.0, 1.0]))


def _push(start: Start, rate_dps: Array, where_m: Array) -> Array:
    """(n, 3) g in the body of a place (n, 3) in the world."""
    attitude = integrate(rate_dps, start.dt_s, facing(start.up))
    moved = where_m * _edges(start)[:, None]
    return into_body(attitude, _second(moved, start.dt_s) / _G_MPS2)


def _along(start: Start, rate_dps: Array, yaw_dps: Array, speed_mps: Array) -> Array:
    """(n, 3) g in the body of a path whose direction turns by yaw: corners press outwards."""
    heading = np.radians(np.cumsum(yaw_dps) * start.dt_s)
    ahead = np.stack([np.cos(heading), np.sin(heading), 0.0 * heading], axis=1)
    speeding = np.gradient(ahead * speed_mps[:, None], start.dt_s, axis=0)
    attitude = integrate(rate_dps, start.dt_s, facing(start.up))
    return into_body(attitude, speeding / _G_MPS2)
