"""From ticks to the blocks that the loop fits."""

import numpy as np

from .dequantise import dequantise, step_lsb
from .earth import earth_of
from .sessions import OWN_SOURCES, Session, block_means
from .still import runs, still_ticks
from .ticks import Ticks, gap_filled

BLOCK_S = 20.0
_WANTED_BLOCKS = 150
_MOST_BLOCKS = 1500
_MOST_WITH_GAPS = 250
_LEAST_STILL = 0.25
_BRIDGE, _BRIDGED_SHARE = 5, 0.1


def block_seconds(ticks: list[Ticks]) -> float:
    """Length of a block, a whole number of ticks, the same for all sessions.

    20 s; shorter where the longest session would have fewer than 150 of them, longer where it would
    have more than 1500. One recording alone, which is cut into parts with gaps, gets at most 250.
    """
    longest = max(len(t.count) * t.tick_s for t in ticks)
    most = _MOST_BLOCKS if len(ticks) > 1 else _MOST_WITH_GAPS
    return _whole_ticks(ticks, max(min(BLOCK_S, longest / _WANTED_BLOCKS), longest / most))


def sessions_from(ticks: list[Ticks]) -> list[Session]:
    """Sessions of equal blocks; at most 250 where one has long gaps, which cost their cube."""
    sessions = [session_of(t, block_seconds(ticks)) for t in ticks]
    if all(can_be_bridged(s.available) for s in sessions):
        return sessions
    longest = max(s.blocks * s.block_s for s in sessions)
    block_s = _whole_ticks(ticks, max(sessions[0].block_s, longest / _MOST_WITH_GAPS))
    return [session_of(t, block_s) for t in ticks]


def can_be_bridged(available: np.ndarray) -> bool:
    """Whether the blocks missing are few and apart."""
    longest = np.diff(runs(~available)).max(initial=0)
    missing = int((~available).sum())
    return bool(longest <= _BRIDGE and missing <= _BRIDGED_SHARE * len(available))


def _whole_ticks(ticks, want_s):
    tick_s = max(t.tick_s for t in ticks)
    return tick_s * max(1, int(np.ceil(want_s / tick_s - 1e-9)))


def session_of(ticks: Ticks, block_s: float) -> Session:
    """Block means of the rate's still part, tick means of the rest, times counted from the first
    sample.
    """
    per = max(1, round(block_s / ticks.tick_s))
    blocks = len(ticks.count) // per
    m = blocks * per
    still = still_ticks(ticks)[:m]
    earth = earth_of(ticks)
    rate_at_rest = rate = ticks.rate[:m] - earth.rate_dps[:m]
    used = still
    if ticks.reference is not None:
        used = (ticks.count[:m] > 0) & np.isfinite(ticks.reference[:m]).all(axis=1)
        rate = rate - np.where(used[:, None], ticks.reference[:m], 0.0)
    weight = np.where(used, ticks.count[:m], 0.0)
    mean = block_means(rate, weight, blocks)
    share = used.reshape(blocks, per).mean(axis=1)
    mean[share < _LEAST_STILL] = np.nan
    return Session(
        ticks.name, per * ticks.tick_s, per, mean, np.where(share < _LEAST_STILL, 0.0, share),
        sources_of(ticks, m), ticks.start_us, earth=earth, delay=ticks.delay,
        ticks_dps=np.where(still[:, None], rate_at_rest, np.nan),
        welch=_welch(ticks), tick_weight=weight, temp_step_degc=_temp_step_degc(ticks),
    )  # fmt: skip


def _welch(ticks: Ticks):
    if ticks.segments is None:
        return None
    return ticks.segments.at_rest(still_ticks(ticks), ticks.scales.odr_hz)


def _temperature(ticks: Ticks) -> np.ndarray:
    return ticks.scales.temp_degc(0) + dequantise(_temp_lsb(ticks)) / ticks.scales.temp_lsb_per_degc


def _temp_step_degc(ticks: Ticks) -> float:
    lsb_per_degc = ticks.scales.temp_lsb_per_degc
    if ticks.temp is None or not lsb_per_degc:
        return 0.0
    return step_lsb(_temp_lsb(ticks)) / lsb_per_degc


def _temp_lsb(ticks: Ticks) -> np.ndarray:
    return (ticks.temp - ticks.scales.temp_degc(0)) * ticks.scales.temp_lsb_per_degc


def sources_of(ticks: Ticks, m: int) -> dict[str, np.ndarray]:
    """The first m ticks of every source by the names that effect slots know."""
    out = {}
    if ticks.temp is not None:
        out["temp"] = _temperature(ticks)[:m]
    if ticks.accel is not None and ticks.vib is not None:
        out.update({f"acc_{a}": ticks.accel[:m, i] for i, a in enumerate("xyz")})
        out["vib"] = ticks.vib[:m]
    if ticks.reference is not None:
        out.update({f"rate_{a}": gap_filled(ticks.reference[:m, i]) for i, a in enumerate("xyz")})
    out.update({n: v[:m] for n, v in ticks.extra.items() if n not in OWN_SOURCES})
    return out
