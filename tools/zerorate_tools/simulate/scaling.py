"""Coefficients of an effect: as given, or such that it has a wanted size over all sessions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .channels import stream
from .effects import EFFECTS, RATE_EFFECTS
from .schema import Description, Wrong, axes
from .world import World

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
