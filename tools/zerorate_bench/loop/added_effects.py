"""Effects that are added to a fast simulated device, of sizes in floors of its noise.

A size is of what survives a refit of offset, T and T^2: what those take is no news to any model.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from zerorate_tools.loop.read.sessions import Session, block_basis
from zerorate_tools.model.term import Term, play

PRANDTL_ISHLINSKII = "prandtl-ishlinskii"
#: The same, kept before power-on where its temperature begins, as a model takes it to be; and what
#: is left of the first by a model told its weights, but not where it was kept.
PRANDTL_ISHLINSKII_KNOWN = f"{PRANDTL_ISHLINSKII}, start known"
PRANDTL_ISHLINSKII_TOLD = f"{PRANDTL_ISHLINSKII}, told"
#: Curves of a recorded channel.
CURVE_OF = "humidity"
CURVES = ("power of 1.5 above a threshold", "sigmoid", "half a sine", "notch")
#: Deviation of the temperature before a power-on from its first one.
KEPT_OFF_DEGC = 3.0

#: (n,) what an effect adds to the blocks of a session, of any size.
Shape = Callable[[Session], np.ndarray]


def _survivor_rms(
    parts: list[np.ndarray], sessions: list[Session], powers: Sequence[int] = (1, 2)
) -> float:
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


def add_parts(
    rng: np.random.Generator,
    sessions: list[Session],
    parts: list[np.ndarray],
    size_dps: float | np.ndarray,
    powers: Sequence[int] = (1, 2),
    whole: list[np.ndarray] | None = None,
) -> None:
    """whole: what is so large of which these parts are left."""
    direction = rng.normal(size=3)
    direction *= np.sqrt(3) / np.linalg.norm(direction)
    scale = _survivor_rms(parts if whole is None else whole, sessions, powers)
    for p, s in zip(parts, sessions):
        s.rate_dps += np.outer(p, direction * size_dps) / scale


def add_effect(
    rng: np.random.Generator, sessions: list[Session], name: str, size_dps: float | np.ndarray
) -> None:
    """Add one effect by its name to all sessions, with parameters drawn off the loop's grids."""
    if name == "step":
        s = sessions[int(rng.integers(0, len(sessions) - 1))]
        at = int(rng.uniform(0.2, 0.8) * s.blocks)
        s.rate_dps[at:] += 4 * size_dps * rng.choice([-1, 1], 3)
        return
    if name in ("linear-acceleration", "squared-acceleration", "scale-factor", "cross-axis"):
        _add_matrix(rng, sessions, name, size_dps)
        return
    shapes = (_curves if name in CURVES else _shapes_of)(rng, sessions)
    sized_as = PRANDTL_ISHLINSKII if name == PRANDTL_ISHLINSKII_TOLD else name
    parts, whole = ([shapes[n](s) for s in sessions] for n in (name, sized_as))
    # T^2 is what the refit takes, so its own size is counted beside T alone.
    powers = (1,) if name == "temperature-quadratic" else (1, 2)
    add_parts(rng, sessions, parts, size_dps, powers, whole)


def _add_matrix(
    rng: np.random.Generator, sessions: list[Session], name: str, size_dps: float | np.ndarray
) -> None:
    matrix = rng.normal(size=(3, 3))
    prefix = "acc" if "acceleration" in name else "rate"
    power = 2 if name == "squared-acceleration" else 1
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


def _many_plays(rng: np.random.Generator) -> Callable[..., np.ndarray]:
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


def _curve(of: Callable[[np.ndarray], np.ndarray]) -> Shape:
    return lambda s: s.block_mean(of(s.sources[CURVE_OF]))


def _curves(rng: np.random.Generator, sessions: list[Session]) -> dict[str, Shape]:
    """Curves of a channel that no catalogue lists, anywhere within what was recorded."""
    seen = np.concatenate([s.sources[CURVE_OF] for s in sessions])
    lo, span = seen.min(), np.ptp(seen)
    at, wide = lo + rng.uniform(0.3, 0.7) * span, rng.uniform(0.08, 0.15) * span
    forms = (
        lambda h: np.maximum(h - at, 0.0) ** 1.5,
        lambda h: np.tanh((h - at) / wide),
        lambda h: np.sin(np.pi * (h - lo) / span),
        lambda h: np.exp(-0.5 * ((h - at) / wide) ** 2),
    )
    return {name: _curve(form) for name, form in zip(CURVES, forms)}


def _term(**fields: Any) -> Shape:
    return lambda s: block_basis(Term(**fields), s)


def _shapes_of(rng: np.random.Generator, sessions: list[Session]) -> dict[str, Shape]:
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
