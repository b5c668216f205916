"""A fast simulated device at block level, for the loop's tests and its table of false alarms.

Noise, temperature path and channels are drawn from a seed; an effect is scaled to a multiple of the
noise's floor by what of it survives a refit of offset, T and T^2 (what those take is no news to any
model).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy.fft import irfft, rfft

from ...loop.read.sessions import Session, block_basis
from ...model.term import Term, first_order_lag, play

BLOCK_S = 20.0
TICKS = 4


@dataclass
class Device:
    """Sessions with what the loop must not see: the noise alone (n, 3) of each session and the
    floor per axis.
    """

    sessions: list[Session]
    noise_dps: list[np.ndarray]
    floor_dps: np.ndarray
    truth: list[str] = field(default_factory=list)


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


def _levels(rng, ticks, tick_s, every_s, low, high):
    out, i = np.empty(ticks), 0
    while i < ticks:
        step = max(1, int(rng.exponential(every_s) / tick_s))
        out[i : i + step] = rng.uniform(low, high)
        i += step
    return out


def _wander(rng, ticks, tick_s, tau_s):
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
        "vdd_mv": 3300
        + 40 * _wander(rng, ticks, tick_s, 900.0)
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


PRANDTL_ISHLINSKII = "prandtl-ishlinskii"
#: The same, kept before power-on where its temperature begins, as a model takes it to be; and what
#: is left of the first by a model told its weights, but not where it was kept.
PRANDTL_ISHLINSKII_KNOWN = f"{PRANDTL_ISHLINSKII}, start known"
PRANDTL_ISHLINSKII_TOLD = f"{PRANDTL_ISHLINSKII}, told"
#: Deviation of the temperature before a power-on from its first one.
KEPT_OFF_DEGC = 3.0

HOSTILE = ("walk4", "steep", "telegraph", "outliers", "unequal")


def _hidden(rng: np.random.Generator, n: int) -> np.ndarray:
    """(n,) a slow cause nobody recorded: a different smooth wander in every session."""
    return (
        _wander(rng, n * TICKS, BLOCK_S / TICKS, rng.uniform(400, 1800)).reshape(n, TICKS).mean(1)
    )


def survivor_rms(parts: list[np.ndarray], sessions: list[Session], powers=(1, 2)) -> float:
    """RMS of what offset per session and powers of T cannot take of an effect given as (n,) a
    session.
    """
    rows, target = [], []
    for p, s in zip(parts, sessions):
        t = s.block_mean(s.sources["temp"]) - 25.0
        rows.append(np.column_stack([t**k - (t**k).mean() for k in powers]))
        target.append(p - p.mean())
    x, y = np.vstack(rows), np.concatenate(target)
    return float(np.std(y - x @ np.linalg.lstsq(x, y, rcond=None)[0]))


def simulate(
    seed: int,
    effects: Sequence[tuple[str, float]] = (),
    sessions: int = 4,
    hours: float = 1.0,
    noise_kind: str = "plain",
    hidden: float = 0.0,
    bare: bool = False,
) -> Device:
    """A device. effects: (name of `shapes_of`, size in floors); hidden: size of a cause that is not
    recorded.

    bare: temperature only, no further channels.
    """
    rng = np.random.default_rng(seed)
    n = int(hours * 3600 / BLOCK_S)
    floor, level = _noise_level(rng)
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
        made.append(
            Session(f"session-{i + 1}", BLOCK_S, TICKS, noises[-1].copy(), np.ones(n), sources)
        )
    line = rng.normal(0, 0.02, 3)
    for s in made:
        t = s.block_mean(s.sources["temp"]) - 25.0
        s.rate_dps += rng.normal(0, 0.5) + np.outer(t, line) + rng.normal(0, 0.02, 3)
    for name, size in effects:
        _add(rng, made, name, size * floor)
    if hidden:
        _add_parts(rng, made, [_hidden(rng, n) for _ in made], hidden * floor)
    return Device(made, noises, floor, [name for name, _ in effects])


def _noise_level(rng):
    white = rng.uniform(0.5e-3, 1.0e-3, 3)
    pink = rng.uniform(0.5e-3, 0.9e-3, 3)
    walk = rng.uniform(0.02e-3, 0.07e-3, 3)
    m = np.arange(1, 400)[:, None]
    floor = np.sqrt((white**2 / m + 0.441 * pink**2 + walk**2 * m / 3).min(axis=0))
    return floor, np.array([white, pink, walk])


def _add_parts(rng, sessions, parts, size_dps, powers=(1, 2), whole=None):
    """whole: what is so large of which these parts are left."""
    direction = rng.normal(size=3)
    direction *= np.sqrt(3) / np.linalg.norm(direction)
    scale = survivor_rms(parts if whole is None else whole, sessions, powers)
    for p, s in zip(parts, sessions):
        s.rate_dps += np.outer(p, direction * size_dps) / scale


def _add(rng, sessions, name, size_dps):
    if name == "step":
        s = sessions[int(rng.integers(0, len(sessions) - 1))]
        at = int(rng.uniform(0.2, 0.8) * s.blocks)
        s.rate_dps[at:] += 4 * size_dps * rng.choice([-1, 1], 3)
        return
    if name in ("linear-acceleration", "squared-acceleration", "scale-factor", "cross-axis"):
        _add_matrix(rng, sessions, name, size_dps)
        return
    shapes = shapes_of(rng, sessions)
    sized_as = PRANDTL_ISHLINSKII if name == PRANDTL_ISHLINSKII_TOLD else name
    parts, whole = ([shapes[n](s) for s in sessions] for n in (name, sized_as))
    # T^2 is what the refit takes, so its own size is counted beside T alone.
    powers = (1,) if name == "temperature-quadratic" else (1, 2)
    _add_parts(rng, sessions, parts, size_dps, powers, whole)


def _add_matrix(rng, sessions, name, size_dps):
    matrix = rng.normal(size=(3, 3))
    prefix, power = ("acc", 1) if "acceleration" in name else ("rate", 1)
    power = 2 if name == "squared-acceleration" else power
    if name == "scale-factor":
        matrix = np.diag(np.diag(matrix) + np.sign(np.diag(matrix)) * 0.5)
    if name == "cross-axis":
        matrix -= np.diag(np.diag(matrix))
    vec = [
        np.column_stack([s.block_mean(s.sources[f"{prefix}_{a}"] ** power) for a in "xyz"])
        for s in sessions
    ]
    whole = np.vstack([v - v.mean(0) for v in vec]) @ matrix.T
    scale = np.sqrt((whole.std(0) ** 2).mean())
    for s, v in zip(sessions, vec):
        s.rate_dps += (v @ matrix.T) * size_dps / scale


def _many_plays(rng):
    """A sum of play operators and their squares; where each stands at a power-on nobody knows: the
    device was kept some degrees off before."""
    radii = np.sort(rng.uniform(0.5, 8.0, int(rng.integers(3, 7))))
    weights = rng.dirichlet(np.ones(len(radii)))
    lopsided = rng.uniform(-0.04, 0.04, len(radii))
    kept_off_degc = rng.normal(0.0, KEPT_OFF_DEGC, 64)

    def shape(session: Session, known: bool = False) -> np.ndarray:
        degc = session.sources["temp"]
        off_degc = 0.0 if known else kept_off_degc[int(session.name.split("-")[-1])]
        before = degc[0] + off_degc
        total = np.zeros(len(degc))
        for radius, weight, square in zip(radii, weights, lopsided):
            stands = play(np.r_[before, degc], 2 * radius)[1:]
            total += weight * (stands - degc + square * (stands - 25.0) ** 2)
        return session.block_mean(total)

    return shape


def _term(**fields):
    return lambda s: block_basis(Term(**fields), s)


def shapes_of(rng: np.random.Generator, sessions: list[Session]) -> dict:
    """Name -> function of a session giving the (n,) shape, with parameters drawn off the loop's
    grids.
    """
    temp = np.concatenate([s.sources["temp"] for s in sessions])
    lo = max(s.sources["temp"].min() for s in sessions)
    hi = min(s.sources["temp"].max() for s in sessions)
    knot = rng.uniform(lo + 0.35 * (hi - lo), lo + 0.65 * (hi - lo))
    u = rng.uniform
    return {
        "temperature-quadratic": _term(source="temp", centre=25.0, power=2),
        "temperature-cubic": _term(source="temp", centre=float(temp.mean()), power=3),
        "temperature-kink": _term(source="temp", knot=float(knot)),
        "thermal-rate": _term(source="temp", lag_s=u(20, 40), lag_mode="rate"),
        "thermal-lag": _term(source="temp", lag_s=u(60, 250), lag_mode="difference"),
        "thermal-hysteresis": _term(source="temp", memory="backlash", width=u(2, 6)),
        PRANDTL_ISHLINSKII: (plays := _many_plays(rng)),
        PRANDTL_ISHLINSKII_KNOWN: partial(plays, known=True),
        PRANDTL_ISHLINSKII_TOLD: lambda s: plays(s) - plays(s, known=True),
        "power-on-transient": _term(source="one", decay_s=u(150, 900)),
        "time-drift": _term(source="time"),
        "vibration": _term(source="vib"),
        "supply-voltage": _term(source="vdd_mv", centre=3300.0),
        "supply-temperature": _term(
            source="vdd_mv", centre=3300.0, second="temp", second_centre=float(temp.mean())
        ),
        "load-squared-delayed": _term(source="load", power=2, delay_s=u(100, 250)),
        "load-squared-lagged": _term(source="load", power=2, lag_s=u(100, 250), lag_mode="lag"),
        "load-kink": _term(source="load", knot=u(0.4, 0.7)),
        "load-humidity": _term(source="load", centre=0.5, second="humidity", second_centre=45.0),
        "temperature-peak": _term(source="temp", memory="peak"),
        "humidity": _term(source="humidity"),
    }
