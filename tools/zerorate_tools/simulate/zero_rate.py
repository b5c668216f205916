"""The zero-rate output itself: polynomial over temperature, turn-on offset, noise by its colour."""

import numpy as np

from . import noise
from .entries import axes
from .noise import stream
from .schema import Description, Sensor
from .world import World


def zero_rate_dps(described: Description, world: World, seed: int) -> np.ndarray:
    """(n, 3) bias before any effect, dps, slow noise included. Raises BadDescription."""
    bias, path = described.bias, described.path
    warm = world.temp_degc[:, None] - 25
    b = [axes(getattr(bias, f"b{i}"), f"bias.b{i}", path) for i in range(4)]
    total = b[0] + warm * (b[1] + warm * (b[2] + warm * b[3]))
    turn_on = axes(bias.turn_on_dps, "bias.turn_on_dps", path)
    total += turn_on * stream(seed, world.number, "turn-on").standard_normal(3)
    return total + _coloured(described, world, seed)


def _coloured(described: Description, world: World, seed: int) -> np.ndarray:
    n, dt_s, given = len(world.t_s), world.dt_s, described.noise
    louder = described.sessions[world.number - 1].noise_scale
    total = np.zeros((n, 3))

    def size(key: str) -> np.ndarray:
        return louder * axes(getattr(given, key), f"noise.{key}", described.path)

    def rng(purpose: str) -> np.random.Generator:
        return stream(seed, world.number, purpose)

    if size("bias_instability_dps").any():
        total += noise.flicker(rng("flicker"), n, dt_s, size("bias_instability_dps"))
    if size("random_walk_dps").any():
        total += noise.random_walk(rng("walk"), n, dt_s, size("random_walk_dps"))
    if size("telegraph_dps").any():
        jumps = size("telegraph_dps")
        total += noise.telegraph(rng("telegraph"), n, dt_s, jumps, given.telegraph_mean_s)
    if size("coloured_dps").any():
        rms = size("coloured_dps")
        total += noise.power_law(rng("coloured"), n, dt_s, rms, given.coloured_exponent)
    return total


def white_dps(described: Description, world: World, seed: int) -> np.ndarray:
    """(n, 3) white noise of the readings, with outliers, dps."""
    sensor, given, n = described.sensor, described.noise, len(world.t_s)
    louder = described.sessions[world.number - 1].noise_scale
    rng = stream(seed, world.number, "white")
    white = rng.standard_normal((n, 3)) * (_white_rms_dps(sensor) * louder)
    if given.outlier_dps and given.outlier_per_hour:
        far = stream(seed, world.number, "outliers")
        white += noise.outliers(far, n, world.dt_s, given.outlier_dps, given.outlier_per_hour)
    return white


def _white_rms_dps(sensor: Sensor) -> float:
    if sensor.gyro_noise_dps_rt_hz is not None:
        return sensor.gyro_noise_dps_rt_hz * np.sqrt(sensor.odr_hz / 2)
    return sensor.gyro_noise_dps * averaging(sensor)


def averaging(sensor: Sensor) -> float:
    """What is left of noise: below the rate it was given at, a reading is the mean of a block."""
    return np.sqrt(sensor.odr_hz / (sensor.gyro_noise_at_hz or sensor.odr_hz))
