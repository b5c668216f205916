"""The simulated device: true world in, integer readings and the truth behind them out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from ..errors import BadDescription
from ..recordings import Recording, Scales, recording_from_columns
from .channels import flicker, outliers, power_law, random_walk, stream, telegraph
from .description import load_description
from .effects import EFFECTS, RATE_EFFECTS, lagged
from .schema import Description, Sensor, Table, Wrong, axes, read_from
from .world import World, build


@dataclass
class Truth:
    """What no recording tells: per sample of the recording, in its order.

    bias_lsb (n, 3): true zero-rate output, raw LSB (everything but the rate, what is proportional
    to it, white noise and rounding); still (n,) bool: nothing turned; attitude (n, 4): unit
    quaternion w x y z, body to world; rate_dps (n, 3): true rate; temp_degc (n,): of the die;
    effects_dps: per effect of the description its (3,) coefficients.
    """

    t_us: np.ndarray
    bias_lsb: np.ndarray
    still: np.ndarray
    attitude: np.ndarray
    rate_dps: np.ndarray
    temp_degc: np.ndarray
    effects_dps: list[np.ndarray]


def simulate(
    description: str | PathLike[str] | Table | Description,
    *,
    session: int = 1,
    seed: int | None = None,
) -> tuple[Recording, Truth]:
    """One power-on (1-based `session`) of a described device: its recording, and the truth.

    description: .toml, .yaml, the name of a bundled scenario, or a dict of the same entries.
    seed: instead of the description's. The same seed gives the same recording, bit for bit.
    Raises BadDescription.
    """
    described = load_description(description)
    if not 1 <= session <= len(described.sessions):
        do = f"choose of 1 to {len(described.sessions)}"
        raise BadDescription(described.path, f"there is no session {session}", do=do)
    return next(_sessions(described, [session], seed))


def simulate_sessions(
    description: str | PathLike[str] | Table | Description, *, seed: int | None = None
) -> Iterator[tuple[Recording, Truth]]:
    """Every power-on of a described device in turn: what it recorded, and the truth behind it.

    description: .toml, .yaml, a bundled scenario's name, or a dict; seed: instead of its own. The
    Truth has t_us (n,), bias_lsb (n, 3), rate_dps (n, 3), attitude (n, 4) wxyz, temp_degc (n,) and
    still (n,). Raises BadDescription.
    """
    described = load_description(description)
    return _sessions(described, range(1, len(described.sessions) + 1), seed)


def _sessions(
    described: Description, numbers: Iterable[int], seed: int | None
) -> Iterator[tuple[Recording, Truth]]:
    seed = described.seed if seed is None else seed
    everyone = (build(described, n + 1, seed) for n in range(len(described.sessions)))
    with read_from(described.path):
        per_unit = coefficients(described, everyone, seed)
        for number in numbers:
            yield _measured(described, build(described, number, seed), per_unit, seed)


def _measured(
    described: Description, world: World, per_unit: list[np.ndarray], seed: int
) -> tuple[Recording, Truth]:
    sensor, number = described.sensor, world.number
    zero_rate = zero_rate_dps(described, world, seed)
    rate = world.rate_dps.copy()
    for effect, coefficient in zip(described.effects, per_unit):
        if effect["kind"] == "timing":
            continue
        added = waveform(world, effect) * coefficient
        if effect["kind"] in RATE_EFFECTS:
            rate += added
        else:
            zero_rate += added
    t_us, rate = _timed(described, world, rate, seed)
    readings = rate + zero_rate + white_dps(described, world, seed)
    columns = {"t_us": t_us, **counts("g", readings * sensor.gyro_lsb_per_dps)}
    columns |= _surroundings(sensor, world, stream(seed, number, "accelerometer"))
    columns |= _channel_columns(world, seed)
    name = described.name if len(described.sessions) == 1 else f"{described.name}-{number}"
    recording = recording_from_columns(columns, _scales(described), name)
    truth = Truth(
        t_us=recording.columns["t_us"],
        bias_lsb=zero_rate * sensor.gyro_lsb_per_dps,
        still=world.still,
        attitude=world.attitude,
        rate_dps=world.rate_dps,
        temp_degc=world.temp_degc,
        effects_dps=per_unit,
    )
    return recording, truth


def _timed(
    described: Description, world: World, rate_dps: np.ndarray, seed: int
) -> tuple[np.ndarray, np.ndarray]:
    t_s, stamps = world.t_s, world.t_s
    for effect in described.effects:
        if effect["kind"] != "timing":
            continue
        delay_s = effect.get("delay_ms", 0.0) / 1000
        # a straight line between samples would dampen quick motion, which is another error
        rate_dps = CubicSpline(t_s, rate_dps)(np.maximum(t_s - delay_s, 0.0))
        jitter = stream(seed, world.number, "jitter").standard_normal(len(t_s))
        stamps = t_s * (1 + effect.get("clock_ppm", 0.0) * 1e-6)
        stamps = stamps + jitter * effect.get("jitter_us", 0.0) * 1e-6
        stamps = np.maximum.accumulate(np.maximum(stamps, 0.0))
    return np.rint(stamps * 1e6).astype(np.int64), rate_dps


def counts(letter: str, values_lsb: np.ndarray) -> dict[str, np.ndarray]:
    """The columns of three axes, as words of 16 bits."""
    words = np.clip(np.rint(values_lsb), -32768, 32767).astype(np.int32)
    return {letter + axis: words[:, i] for i, axis in enumerate("xyz")}


def _surroundings(sensor: Sensor, world: World, rng: np.random.Generator) -> dict[str, np.ndarray]:
    n, quieter = len(world.t_s), averaging(sensor)
    columns: dict[str, np.ndarray] = {}
    if sensor.accel:
        shaken = rng.standard_normal((n, 3)) * (sensor.accel_noise_g * quieter)
        force = world.accel_g + shaken + axes(sensor.accel_bias_g)
        columns |= counts("a", force * sensor.accel_lsb_per_g)
    if sensor.temp:
        read = lagged(world.temp_degc, sensor.temp_lag_s, world.dt_s)
        read = read + rng.standard_normal(n) * (sensor.temp_noise_degc * quieter)
        raw = (read - sensor.temp_offset_degc) * sensor.temp_lsb_per_degc
        stepped = np.rint(np.rint(raw / sensor.temp_step_lsb) * sensor.temp_step_lsb)
        columns["temp"] = np.clip(stepped, -32768, 32767).astype(np.int32)
    return columns


def _channel_columns(world: World, seed: int) -> dict[str, np.ndarray]:
    columns: dict[str, np.ndarray] = {}
    for name, channel in world.channels.items():
        if channel.recorded:
            rng = stream(seed, world.number, f"reading {name}")
            read = channel.values + rng.standard_normal(len(world.t_s)) * channel.noise
            columns[name] = np.rint(read / channel.lsb).astype(np.int32)
    return columns


def _scales(described: Description) -> Scales:
    sensor = described.sensor
    where = {} if described.latitude_deg is None else {"latitude_deg": described.latitude_deg}
    return Scales(
        sensor=sensor.name,
        odr_hz=sensor.odr_hz,
        gyro_lsb_per_dps=sensor.gyro_lsb_per_dps,
        accel_lsb_per_g=sensor.accel_lsb_per_g if sensor.accel else None,
        temp_lsb_per_degc=sensor.temp_lsb_per_degc if sensor.temp else None,
        temp_offset_degc=sensor.temp_offset_degc if sensor.temp else None,
        more=where,
    )


def zero_rate_dps(described: Description, world: World, seed: int) -> np.ndarray:
    """(n, 3) bias before any effect, dps, slow noise included."""
    bias = described.bias
    warm = world.temp_degc[:, None] - 25
    b = [axes(of) for of in (bias.b0, bias.b1, bias.b2, bias.b3)]
    total = b[0] + warm * (b[1] + warm * (b[2] + warm * b[3]))
    total += axes(bias.turn_on_dps) * stream(seed, world.number, "turn-on").standard_normal(3)
    return total + _coloured(described, world, seed)


def _coloured(described: Description, world: World, seed: int) -> np.ndarray:
    n, dt_s, given = len(world.t_s), world.dt_s, described.noise
    louder = described.sessions[world.number - 1].noise_scale
    total = np.zeros((n, 3))
    for purpose, dps, noise, more in (
        ("flicker", given.bias_instability_dps, flicker, ()),
        ("walk", given.random_walk_dps, random_walk, ()),
        ("telegraph", given.telegraph_dps, telegraph, (given.telegraph_mean_s,)),
        ("coloured", given.coloured_dps, power_law, (given.coloured_exponent,)),
    ):
        size = louder * axes(dps)
        if size.any():
            total += noise(stream(seed, world.number, purpose), n, dt_s, size, *more)
    return total


def white_dps(described: Description, world: World, seed: int) -> np.ndarray:
    """(n, 3) white noise of the readings, with outliers, dps."""
    sensor, given, n = described.sensor, described.noise, len(world.t_s)
    louder = described.sessions[world.number - 1].noise_scale
    rng = stream(seed, world.number, "white")
    rms_dps = sensor.gyro_noise_dps * averaging(sensor)
    if sensor.gyro_noise_dps_rt_hz is not None:
        rms_dps = sensor.gyro_noise_dps_rt_hz * np.sqrt(sensor.odr_hz / 2)
    white = rng.standard_normal((n, 3)) * (rms_dps * louder)
    if given.outlier_dps and given.outlier_per_hour:
        far = stream(seed, world.number, "outliers")
        white += outliers(far, n, world.dt_s, given.outlier_dps, given.outlier_per_hour)
    return white


def averaging(sensor: Sensor) -> float:
    """What is left of noise: below the rate it was given at, a reading is the mean of a block."""
    return np.sqrt(sensor.odr_hz / (sensor.gyro_noise_at_hz or sensor.odr_hz))


_ALWAYS = ("kind", "dps", "rms_dps", "beyond_temperature", "session")
_ROWS = 4000
_NOTHING = 1e-12


@np.errstate(over="ignore", invalid="ignore")
def waveform(world: World, effect: Mapping[str, Any]) -> np.ndarray:
    """(n, 3) an effect's waveform per unit of coefficient. Raises Wrong."""
    options = {k: v for k, v in effect.items() if k not in _ALWAYS}
    kind = effect["kind"]
    if effect.get("session", world.number) != world.number:
        return np.zeros((len(world.t_s), 3))
    try:
        shape = EFFECTS[kind](world, **options)
        if not np.isfinite(shape).all():
            raise ValueError("what it follows or how is not finite")
    except KeyError as error:
        do = f"add [channels.{error.args[0]}]"
        raise Wrong(f"effect {kind}: there is no channel {error}", do) from error
    except (TypeError, ValueError, ArithmeticError) as error:
        raise Wrong(f"effect {kind}: {error}", "correct it") from error
    return shape if shape.ndim == 2 else np.repeat(shape[:, None], 3, axis=1)


def coefficients(description: Description, worlds: Iterable[World], seed: int) -> list[np.ndarray]:
    """(3,) dps per unit of each effect's waveform: its `dps`, or what gives it its `rms_dps`.

    rms_dps: deviation of what the effect adds about each session's mean over the still samples
    (the moving ones for scale effects); with beyond_temperature, of what a straight line and a
    parabola over temperature, common to the sessions, leave of it. Three numbers are each axis's
    own. One is the rms over the axes, shared out at random; where the axes have waveforms of their
    own (a matrix), they keep their proportion. worlds: every session's, gone through once and only
    if a size is wanted.
    """
    sized = [i for i, effect in enumerate(description.effects) if "rms_dps" in effect]
    sizes = dict(zip(sized, _sizes(description, sized, worlds))) if sized else {}
    return [
        _from_size(effect, i, sizes[i], seed)
        if i in sizes
        else axes(effect.get("dps", 0.0), f"effect {effect.get('kind')}.dps")
        for i, effect in enumerate(description.effects)
    ]


def _from_size(effect: Mapping[str, Any], number: int, size: _Size, seed: int) -> np.ndarray:
    where = f"effect {effect['kind']}"
    wanted, rms = axes(effect["rms_dps"], f"{where}.rms_dps"), size.rms
    if not isinstance(effect["rms_dps"], (list, tuple)):
        if not size.shared:
            rms = np.full(3, np.sqrt((rms**2).mean()))
        else:
            direction = stream(seed, 0, f"effect {number}").standard_normal(3)
            wanted = wanted * direction / np.sqrt((direction**2).mean())
    shows = rms > _NOTHING
    if (wanted[~shows] != 0).any():
        raise Wrong(f"{where} does not show in these sessions", "vary what it follows")
    return np.where(shows, wanted / np.where(shows, rms, 1.0), 0.0)


@dataclass
class _Size:
    """rms (3,) of an effect's waveform, and whether the axes share one waveform."""

    rms: np.ndarray
    shared: bool


def _sizes(description: Description, sized: list[int], worlds: Iterable[World]) -> list[_Size]:
    effects = [description.effects[i] for i in sized]
    shapes: list[list[np.ndarray]] = [[] for _ in effects]
    temps: list[list[np.ndarray]] = [[] for _ in effects]
    for world in worlds:
        for effect, shape, temp in zip(effects, shapes, temps):
            at = _scored(world, effect)
            warm = world.temp_degc[at, None]
            shape.append(_about_mean(waveform(world, effect)[at]))
            temp.append(_about_mean(np.hstack([warm, warm**2])))
    return [
        _size(effect, *map(np.concatenate, both)) for effect, *both in zip(effects, shapes, temps)
    ]


def _size(effect: Mapping[str, Any], shape: np.ndarray, temp: np.ndarray) -> _Size:
    shared = bool((shape == shape[:, :1]).all())
    if effect.get("beyond_temperature"):
        shape = shape - temp @ np.linalg.lstsq(temp, shape, rcond=None)[0]
    return _Size(np.sqrt((shape**2).mean(axis=0)), shared)


def _scored(world: World, effect: Mapping[str, Any]) -> np.ndarray:
    use = ~world.still if effect["kind"] in RATE_EFFECTS else world.still
    at = np.flatnonzero(use if use.any() else ~use)
    return at[:: max(len(at) // _ROWS, 1)]


def _about_mean(values: np.ndarray) -> np.ndarray:
    return values - values.mean(axis=0)
