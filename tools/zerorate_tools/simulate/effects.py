"""Effects on the zero-rate output: each a waveform of the world, times a coefficient an axis.

`dps` is per unit of the waveform. What each follows: reference tables in docs, effects.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.signal import lfilter

from ..model.effects import curve_of
from ..model.term import delayed, play
from .world import World


def hysteresis(world: World, *, width_degc: float = 4.0) -> np.ndarray:
    """Backlash of temperature, play operator over width/2: -1 as it rises, +1 as it falls."""
    return (play(world.temp_degc, width_degc) - world.temp_degc) / (width_degc / 2)


def prandtl_ishlinskii(
    world: World,
    *,
    widths_degc: list[Any] | None = None,
    weights: list[Any] | None = None,
    lopsided: float = 0.0,
    kept_off_degc: float | list[float] = 0.0,
) -> np.ndarray:
    """A weighted sum of backlashes, degC, as real parts have: widths 2, 6 and 15 alike by default.

    lopsided: of each operator's square about 25 degC beside itself; kept_off_degc: how far from its
    first temperature the device was before power-on, of every session or one each in turn: where
    the operators then stand no firmware can know.
    """
    widths = [2.0, 6.0, 15.0] if widths_degc is None else widths_degc
    shares = np.ones(len(widths)) / len(widths) if weights is None else np.asarray(weights, float)
    off = np.atleast_1d(kept_off_degc)
    history = np.r_[world.temp_degc[0] + off[(world.number - 1) % len(off)], world.temp_degc]
    total = np.zeros(len(world.temp_degc))
    for width, share in zip(widths, shares, strict=True):
        stands = play(history, width)[1:]
        total += share * (stands - world.temp_degc + lopsided * (stands - 25.0) ** 2)
    return total


def thermal_rate(world: World, *, lag_s: float = 0.0) -> np.ndarray:
    """Rate of temperature change, degC a minute, smoothed by an optional first-order lag."""
    return lagged(np.gradient(world.temp_degc, world.dt_s) * 60, lag_s, world.dt_s)


def sensor_lag(world: World, *, tau_s: float = 60.0) -> np.ndarray:
    """Lagged minus present die temperature, degC: a place in the package follows slowly."""
    return lagged(world.temp_degc, tau_s, world.dt_s) - world.temp_degc


def power_on(world: World, *, tau_s: float = 600.0) -> np.ndarray:
    """Self-heating's exp(-t/tau) since power-on."""
    return np.exp(-world.t_s / tau_s)


def drift(world: World) -> np.ndarray:
    """Hours since power-on."""
    return world.t_s / 3600


def kink(world: World, *, knee_degc: float = 35.0) -> np.ndarray:
    """Degrees above a knee."""
    return np.maximum(world.temp_degc - knee_degc, 0.0)


def peak_temperature(world: World) -> np.ndarray:
    """Memory of the highest temperature since power-on, degC above the present one."""
    return np.maximum.accumulate(world.temp_degc) - world.temp_degc


def linear_g(world: World, *, matrix: list[Any] | None = None) -> np.ndarray:
    """(n, 3) specific force in g, mixed by a 3x3 matrix (a row a gyro axis; default: identity)."""
    return world.accel_g @ np.asarray(np.eye(3) if matrix is None else matrix, float).T


def squared_g(world: World) -> np.ndarray:
    """(n, 3) each axis's own specific force squared, g^2."""
    return world.accel_g**2


def vibration(world: World, *, tau_s: float = 1.0) -> np.ndarray:
    """Vibration rectification: mean square of acceleration above 1/tau, all axes, g^2."""
    quick = world.accel_g - lagged(world.accel_g, tau_s, world.dt_s)
    return lagged((quick**2).sum(axis=1), tau_s, world.dt_s)


def supply(world: World, *, at_mv: float = 3300.0) -> np.ndarray:
    """Volts above at_mv; needs channel vdd_mv."""
    return (world.channels["vdd_mv"].values - at_mv) / 1000


def supply_temperature(world: World, *, at_mv: float = 3300.0) -> np.ndarray:
    """Volts above at_mv times degrees above 25; needs channel vdd_mv."""
    return supply(world, at_mv=at_mv) * (world.temp_degc - 25)


def scale(world: World, *, matrix: list[Any] | None = None) -> np.ndarray:
    """(n, 3) rate in dps mixed by a 3x3 matrix (scale factor, cross-axis; default: identity)."""
    return world.rate_dps @ np.asarray(np.eye(3) if matrix is None else matrix, float).T


def periodic(world: World, *, hz: float, phase_deg: float = 0.0) -> np.ndarray:
    """A line in the spectrum, sampled as it is (above half the data rate it shows as an alias)."""
    return np.sin(2 * np.pi * hz * world.t_s + np.radians(phase_deg))


def step(world: World, *, at_s: float | None = None, at_degc: float | None = None) -> np.ndarray:
    """A jump at a time since power-on, or while the temperature is above a value."""
    above = world.temp_degc > at_degc if at_degc is not None else world.t_s >= at_s
    return above.astype(float)


def channel(
    world: World,
    *,
    source: str,
    centre: float = 0.0,
    span: float = 1.0,
    delay_s: float = 0.0,
    lag_s: float = 0.0,
    rate: bool = False,
    knee: float | None = None,
    power: float = 1.0,
    row: str | None = None,
    times: str | None = None,
    times_centre: float = 0.0,
) -> np.ndarray:
    """Any source: ((source - centre)/span), delayed, lagged, its rate a minute, above a knee, to a
    power, times a second source. row: a kind of model/effects.py whose curve the source goes
    through first. Sources: temp ax ay az gx gy gz time_s and every channel."""
    u = of(world, source)
    if row is not None:
        u = curve_of(row)(u)
    u = (u - centre) / span
    u = lagged(delayed(u, round(delay_s / world.dt_s)), lag_s, world.dt_s)
    if rate:
        u = np.gradient(u, world.dt_s) * 60
    if knee is not None:
        u = np.maximum(u - knee, 0.0)
    u = u**power
    return u if times is None else u * (of(world, times) - times_centre)


EFFECTS: dict[str, Callable[..., np.ndarray]] = {
    f.__name__.replace("_", "-"): f
    for f in (
        *(hysteresis, prandtl_ishlinskii, thermal_rate, sensor_lag, power_on, drift, kink),
        *(peak_temperature, linear_g, squared_g, vibration, supply, supply_temperature, scale),
        *(periodic, step, channel),
    )
}
TIMING = ("delay_ms", "clock_ppm", "jitter_us")
"""Options of kind timing, which no waveform has."""
RATE_EFFECTS = ("scale",)
"""These are no zero-rate output: they are in the reading, not in the true bias."""


def of(world: World, source: str) -> np.ndarray:
    """(n,) a source by name. Raises KeyError."""
    if source in ("ax", "ay", "az"):
        return world.accel_g[:, "xyz".index(source[1])]
    if source in ("gx", "gy", "gz"):
        return world.rate_dps[:, "xyz".index(source[1])]
    plain = {"temp": world.temp_degc, "time_s": world.t_s}
    return plain[source] if source in plain else world.channels[source].values


def lagged(u: np.ndarray, tau_s: float, dt_s: float) -> np.ndarray:
    """First-order lag along the first axis, settled at the first value."""
    if tau_s <= 0:
        return u
    keep = np.exp(-dt_s / tau_s)
    return lfilter([1 - keep], [1.0, -keep], u, axis=0, zi=keep * u[:1])[0]
