"""What the device does: rests, returns, turns away, is driven."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

_EDGE_S = 1.0
_G_MPS2 = 9.80665
FACES = {s + n: np.eye(3)[i] * f for i, n in enumerate("xyz") for s, f in (("+", 1), ("-", -1))}
_AXES = {name: np.eye(3)[i] for i, name in enumerate("xyz")}


@dataclass
class Bout:
    """One stretch of motion in the body frame: rate (n, 3) dps, push (n, 3) g beyond gravity."""

    rate_dps: np.ndarray
    push_g: np.ndarray | None = None


@dataclass
class Start:
    """A bout's beginning: its random stream, sample times (n,) s, and where up is in the body."""

    rng: np.random.Generator
    t_s: np.ndarray
    dt_s: float
    up: np.ndarray


def rest(start: Start) -> Bout:
    """Nothing turns."""
    return Bout(np.zeros((len(start.t_s), 3)))


def swing(start: Start, *, dps: float = 60.0, hz: float = 0.7, axis: object = "random") -> Bout:
    """Back and forth about one axis, dps at its fastest; it ends where it began."""
    angle = dps / (2 * np.pi * hz) * np.sin(2 * np.pi * hz * start.t_s)
    return Bout(_rates(start, angle[:, None] * body_axis(axis, start)))


def wave(start: Start, *, dps: float = 60.0, hz: float = 0.8) -> Bout:
    """A hand waving: z at hz and x at 0.6 of it, each dps at its fastest; it ends as it began."""
    w = 2 * np.pi * hz * start.t_s
    x, z = np.sin(0.6 * w) / 0.6, np.sin(w)
    angles = np.stack([x, np.zeros_like(w), z], axis=1) * dps / (2 * np.pi * hz)
    return Bout(_rates(start, angles), _envelope(start)[:, None] * 0.05 * np.sin(angles))


def stride(start: Start, *, dps: float = 100.0, hz: float = 0.9, push_g: float = 0.25) -> Bout:
    """A leg walking: mostly about y with a second harmonic, the body rising twice a stride."""
    w = 2 * np.pi * hz * start.t_s + start.rng.uniform(0, 2 * np.pi)
    y = np.sin(w) + 0.15 * np.sin(2 * w + 1.0)
    angles = np.stack([0.3 * np.sin(w + 0.7), y, 0.2 * np.sin(w + 2.0)], axis=1)
    forward = body_axis("level", start)
    push = np.sin(2 * w)[:, None] * start.up + 0.6 * np.sin(w + 0.4)[:, None] * forward
    rate = _rates(start, angles * dps / (2 * np.pi * hz))
    return Bout(rate, push * push_g * _envelope(start)[:, None])


def hand(start: Start, *, dps: float = 60.0, push_g: float = 0.1) -> Bout:
    """Handled about all three axes, 0.3-2 Hz; dps is the rms of each axis."""
    hz = start.rng.uniform(0.3, 2.0, (4, 1, 3))
    phase = start.rng.uniform(0, 2 * np.pi, (4, 1, 3))
    rate = _rates(start, (np.sin(2 * np.pi * hz * start.t_s[:, None] + phase) / hz).sum(axis=0))
    rate *= dps / np.maximum(rate.std(axis=0), 1e-12)
    push = np.sin(2 * np.pi * hz[:1] * start.t_s[:, None] + phase[1:2])[0]
    return Bout(rate, push * push_g * _envelope(start)[:, None])


def tremble(start: Start, *, dps: float = 1.0, aim_deg: float = 5.0) -> Bout:
    """A hand that holds still as well as it can: 3-8 Hz, dps is the rms of each axis; its slow
    re-aiming, some aim_deg wide and half a minute long, comes back."""
    shiver = _sum_of_sines(start, (3.0, 8.0), 12)
    shiver *= dps / np.maximum(np.gradient(shiver, start.dt_s, axis=0).std(axis=0), 1e-12)
    aim = _sum_of_sines(start, (0.02, 0.06), 4)
    return Bout(_rates(start, shiver + aim * aim_deg / np.maximum(aim.std(axis=0), 1e-12)))


def tilt(start: Start, *, dps: float = 3.0, hz: float = 0.2) -> Bout:
    """A boat at anchor, a crane: slow about all axes, near hz; each up to about dps."""
    angle = _sum_of_sines(start, (0.75 * hz, 1.25 * hz), 3)
    rate = np.gradient(angle, start.dt_s, axis=0)
    return Bout(_rates(start, angle * dps / np.maximum(np.abs(rate).max(axis=0), 1e-12)))


def vibration(start: Start, *, g: float = 0.3, dps: float = 0.0) -> Bout:
    """Shaken far above the output data rate: g and dps are rms of each axis, sample by sample."""
    n, envelope = len(start.t_s), _envelope(start)[:, None]
    angle = start.rng.standard_normal((n, 3)) * dps * start.dt_s / np.sqrt(2)
    return Bout(_rates(start, angle), start.rng.standard_normal((n, 3)) * g * envelope)


def turn(start: Start, *, dps: float = 0.5, deg: float | None = None, axis: object = "z") -> Bout:
    """A turntable: a steady turn that stays turned; with deg, by that angle and whatever rate."""
    profile = _envelope(start)
    rate = profile * (dps if deg is None else deg / (profile.sum() * start.dt_s))
    return Bout(rate[:, None] * body_axis(axis, start))


def car(start: Start, *, dps: float = 2.0, mps: float = 12.0, rough_g: float = 0.02) -> Bout:
    """Driven: slow turns about the vertical, up to dps, with what the curve presses sideways."""
    n, rate, at = len(start.t_s), np.zeros(len(start.t_s)), 0
    while at < n:
        at += int(start.rng.uniform(4, 15) / start.dt_s)
        length = max(int(start.rng.uniform(8, 25) / start.dt_s), 1)
        bump = np.sin(np.pi * (np.arange(length) + 0.5) / length) ** 2
        here = rate[at : at + length]
        here += start.rng.choice([-1, 1]) * start.rng.uniform(0.4, 1) * dps * bump[: len(here)]
        at += length
    sideways = np.cross(start.up, body_axis("level", start))
    press = (np.radians(rate) * mps / _G_MPS2)[:, None] * sideways
    return Bout(rate[:, None] * start.up, press + start.rng.standard_normal((n, 3)) * rough_g)


def pose(start: Start, *, face: str = "+z") -> Bout:
    """Turned over until this face (+x -x +y -y +z -z) is up."""
    target = FACES[face]
    axis = np.cross(target, start.up)
    if np.linalg.norm(axis) < 1e-6:
        axis = np.cross(np.roll(np.abs(target), 1), start.up)
    angle = np.degrees(np.arccos(np.clip(target @ start.up, -1, 1)))
    profile = _envelope(start)
    axis = axis / np.linalg.norm(axis)
    return Bout(profile[:, None] * axis * angle / (profile.sum() * start.dt_s))


MOTIONS: dict[str, Callable[..., Bout]] = {
    f.__name__: f
    for f in (rest, swing, wave, stride, hand, tremble, tilt, vibration, turn, car, pose)
}


def body_axis(axis: object, start: Start) -> np.ndarray:
    """(3,) unit body axis: x y z, level, vertical, random, or a vector."""
    if isinstance(axis, str):
        if axis in _AXES:
            return _AXES[axis]
        ways: dict[str, Callable[[Start], np.ndarray]] = {
            "level": _level,
            "vertical": lambda start: start.up,
            "random": lambda start: start.rng.standard_normal(3),
        }
        vector = ways[axis](start)
    else:
        vector = np.asarray(axis, float)
    return vector / np.linalg.norm(vector)


def _level(start: Start) -> np.ndarray:
    along = _AXES["x"] if abs(start.up[0]) < 0.8 else _AXES["y"]
    return along - (along @ start.up) * start.up


def _envelope(start: Start) -> np.ndarray:
    n = len(start.t_s)
    edge = max(min(_EDGE_S, n * start.dt_s / 4) / start.dt_s, 0.5)
    k = np.arange(n) + 0.5
    nearest = np.minimum(np.minimum(k, n - k) / edge, 1.0)
    return np.sin(np.pi / 2 * nearest) ** 2


def _sum_of_sines(start: Start, hz: tuple[float, float], count: int) -> np.ndarray:
    f = start.rng.uniform(*hz, (count, 3))
    phase = start.rng.uniform(0, 2 * np.pi, (count, 3))
    w = 2 * np.pi * start.t_s
    return sum(np.sin(np.outer(w, f[k]) + phase[k]) / f[k] for k in range(count))


def _rates(start: Start, angle_deg: np.ndarray) -> np.ndarray:
    inside = angle_deg * _envelope(start)[:, None]
    inside[-1:] = 0.0
    return np.diff(inside, axis=0, prepend=0.0) / start.dt_s
