"""Coefficients of an effect: as given, or such that it has a wanted size over all sessions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import BadDescription
from .effects import EFFECTS, RATE_EFFECTS
from .entries import axes
from .randomness import stream
from .schema import Description
from .world import World

_ALWAYS = ("kind", "dps", "rms_dps", "beyond_temperature", "session")
_ROWS = 4000


def waveform(world: World, effect: Mapping[str, Any], path: str) -> np.ndarray:
    """(n, 3) an effect's waveform per unit of coefficient. Raises BadDescription."""
    options = {k: v for k, v in effect.items() if k not in _ALWAYS}
    kind = effect.get("kind")
    if kind not in EFFECTS:
        problem = f"effect {kind!r} is unknown"
        raise BadDescription(path, problem, do=f"choose of {', '.join(EFFECTS)}, timing")
    if effect.get("session", world.number) != world.number:
        return np.zeros((len(world.t_s), 3))
    try:
        shape = EFFECTS[kind](world, **options)
    except KeyError as error:
        problem = f"effect {kind}: there is no channel {error}"
        raise BadDescription(path, problem, do=f"add [channels.{error.args[0]}]") from error
    except (TypeError, ValueError) as error:
        raise BadDescription(path, f"effect {kind}: {error}", do="correct it") from error
    return shape if shape.ndim == 2 else np.repeat(shape[:, None], 3, axis=1)


def coefficients(description: Description, number: int, worlds: Sequence[World], seed: int):
    """(3,) dps per unit of effect `number` (0-based), from `dps`, or from `rms_dps` over `worlds`.

    rms_dps: deviation of what the effect adds about each session's mean over the still samples
    (the moving ones for scale effects); with beyond_temperature, of what a straight line and a
    parabola over temperature, common to the sessions, leave of it. One number is the rms over the
    three axes, shared out at random; three are each axis's own.
    """
    effect = description.effects[number]
    where = f"effect {effect.get('kind')}"
    if "rms_dps" not in effect:
        return axes(effect.get("dps", 0.0), f"{where}.dps", description.path)
    wanted = axes(effect["rms_dps"], f"{where}.rms_dps", description.path)
    if not isinstance(effect["rms_dps"], (list, tuple)):
        direction = stream(seed, 0, f"effect {number}").standard_normal(3)
        wanted = wanted * direction / np.sqrt((direction**2).mean())
    size = _size(description, effect, worlds)
    if not (size > 0).all():
        do = "vary what it follows"
        raise BadDescription(description.path, f"{where} does not show in these sessions", do=do)
    return wanted / size


def _size(description: Description, effect: Mapping[str, Any], worlds: Sequence[World]):
    shapes, temps = [], []
    for world in worlds:
        use = ~world.still if effect["kind"] in RATE_EFFECTS else world.still
        at = np.flatnonzero(use if use.any() else ~use)
        at = at[:: max(len(at) // _ROWS, 1)]
        shape = waveform(world, effect, description.path)[at]
        warm = world.temp_degc[at, None] - 25
        shapes.append(shape - shape.mean(axis=0))
        temps.append(np.hstack([warm, warm**2]) - np.hstack([warm, warm**2]).mean(axis=0))
    shape, temp = np.concatenate(shapes), np.concatenate(temps)
    if effect.get("beyond_temperature"):
        shape = shape - temp @ np.linalg.lstsq(temp, shape, rcond=None)[0]
    return np.sqrt((shape**2).mean(axis=0))
