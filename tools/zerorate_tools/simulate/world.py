"""What truly happens around the sensor in one session, before any of it is measured."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .attitude import facing, integrate, into_body, multiply, rotation
from .channels import CHANNELS, Channel, Clock, course, durations, seconds, stream
from .motion import FACES, MOTIONS, Bout, Start
from .schema import Description, Session, Wrong, is_pair

_EARTH_DPS = 360 / 86164.0905
_MOST_SAMPLES = 10**8
UP = np.array([0.0, 0.0, 1.0])


@dataclass
class World:
    """One session's truth: (n,) times s, die temperature degC and still flag; (n, 3) rate dps and
    specific force g in the body; (n, 4) attitude; channels by name; number is 1-based."""

    number: int
    t_s: np.ndarray
    dt_s: float
    temp_degc: np.ndarray
    rate_dps: np.ndarray
    accel_g: np.ndarray
    attitude: np.ndarray
    still: np.ndarray
    channels: dict[str, Channel]


@np.errstate(over="ignore", invalid="ignore")  # it is looked at what came of it
def build(description: Description, number: int, seed: int) -> World:
    """The world of session `number` (1-based). Raises Wrong."""
    session = description.sessions[number - 1]
    dt_s = 1.0 / description.sensor.odr_hz
    session, lengths = _varied(session, stream(seed, number, "temperature"))
    duration_s = session.s + 60 * session.minutes + 3600 * session.hours or sum(lengths)
    if duration_s > _MOST_SAMPLES * dt_s:
        do = "make it shorter, or odr_hz smaller"
        raise Wrong(f"session {number} has over {_MOST_SAMPLES:,} samples", do)
    n = max(int(round(duration_s / dt_s)), 1)
    t_s = np.arange(n) * dt_s
    temp = course(t_s, session.start_degc, session.temperature, lengths)
    rate, attitude, accel = _moved(description, session, t_s, stream(seed, number, "motion"))
    still = np.logical_not(rate.any(axis=1))
    if description.latitude_deg is not None:
        rate = rate + into_body(attitude, earth_rate_dps(description.latitude_deg))
    world = World(number, t_s, dt_s, temp, rate, accel, attitude, still, {})
    for name, table in description.channels.items():
        rng = stream(seed, number, f"channel {name}")
        world.channels[name] = _channel(world, name, table, rng)
    return world


def earth_rate_dps(latitude_deg: float) -> np.ndarray:
    """(3,) Earth's rotation in the world frame: x east, y north, z up."""
    latitude = np.radians(latitude_deg)
    return _EARTH_DPS * np.array([0.0, np.cos(latitude), np.sin(latitude)])


def _varied(session: Session, rng: np.random.Generator) -> tuple[Session, list[float]]:
    spread = session.vary_degc
    start = session.start_degc + spread * rng.standard_normal()
    segments = [
        {**s, "to": s["to"] + spread * rng.standard_normal()} if "to" in s else s
        for s in session.temperature
    ]
    lengths = durations(session.start_degc, session.temperature)
    factors = np.exp(session.vary_time * rng.standard_normal(len(lengths)))
    varied = replace(session, start_degc=start, temperature=segments)
    return varied, [length * factor for length, factor in zip(lengths, factors)]


def _moved(
    description: Description, session: Session, t_s: np.ndarray, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    n, dt_s = len(t_s), 1.0 / description.sensor.odr_hz
    rate, push, attitude = np.zeros((n, 3)), np.zeros((n, 3)), np.empty((n, 4))
    now, first, turn = _first_attitude(session, rng), 0, 0
    schedule = session.motion or [{"kind": "rest", "s": session.duration_s * 10}]
    while first < n:
        bout = {
            key: rng.uniform(*value) if is_pair(value) else value
            for key, value in schedule[turn % len(schedule)].items()
        }
        last = min(first + max(int(round((seconds(bout) or 0.0) / dt_s)), 1), n)
        start = Start(rng, np.arange(1, last - first + 1) * dt_s, dt_s, into_body(now, UP))
        moved = _bout(bout, start)
        rate[first:last] = moved.rate_dps
        if moved.push_g is not None:
            push[first:last] = moved.push_g
        turns = moved.rate_dps.any()
        attitude[first:last] = integrate(moved.rate_dps, dt_s, now) if turns else now
        now, first, turn = attitude[last - 1], last, turn + 1
    return rate, attitude, into_body(attitude, UP) + push


def _first_attitude(session: Session, rng: np.random.Generator) -> np.ndarray:
    lean = rng.standard_normal(3) * session.tilt_deg
    heading = rotation(np.array([0.0, 0.0, session.heading_deg]))
    return multiply(heading, multiply(facing(FACES[session.face]), rotation(lean)))


def _bout(bout: dict[str, Any], start: Start) -> Bout:
    options = {k: v for k, v in bout.items() if k not in ("kind", "s", "minutes", "hours")}
    try:
        moved = MOTIONS[bout["kind"]](start, **options)
        if moved.rate_dps.shape != (len(start.t_s), 3) or not np.isfinite(moved.rate_dps).all():
            raise ValueError("its rates are not three finite numbers a sample")
        return moved
    except (TypeError, KeyError, ValueError, ArithmeticError) as error:
        raise Wrong(f"motion {bout['kind']}: {error}", "correct it") from error


def _channel(
    world: World, name: str, table: Mapping[str, Any], rng: np.random.Generator
) -> Channel:
    options = dict(table)
    how = {key: options.pop(key) for key in ("recorded", "lsb", "noise") if key in options}
    kind = options.pop("kind", None)
    try:
        if kind == "copy":
            return Channel(world.channels[options["of"]].values, **how)
        values = CHANNELS[kind](Clock(rng, world.t_s, world.dt_s), **options)
        if values.shape != world.t_s.shape or not np.isfinite(values).all():
            raise ValueError("it is not one finite number a sample")
        return Channel(values, **how)
    except (TypeError, KeyError, ValueError, ArithmeticError) as error:
        do = f"choose kind of {', '.join(CHANNELS)}, copy, and its options"
        raise Wrong(f"channel {name}: {error}", do) from error
