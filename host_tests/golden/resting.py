"""What is read of recordings in which it is hard to tell what rests: to the tick, by each rate."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from zerorate_tools.loop.read.blocks import sessions_from
from zerorate_tools.loop.read.still import deviation_of, still_stretch, still_ticks
from zerorate_tools.loop.read.ticks import read_ticks, tick_seconds
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.recordings.checks import GAP

#: Hz, dps of noise in a sample, and degrees of latitude.
_KINDS = ((20.0, 0.05, 0.0), (2.0, 0.5, 48.0), (5.0, 0.8, None), (0.2, 0.02, -30.0))
#: Seconds of the middle of what a hand does, how long it lasts, dps, and about which axis.
_MOTION = (
    *((30, 40, 5.0, 0), (300, 60, 2.0, 1), (500, 4, 60.0, 2), (640, 25, 1.2, 2)),
    *((800, 90, 0.3, 0), (900, 12, 0.6, 1), (1130, 50, 20.0, 2), (1490, 30, 9.0, 0)),
)


def _recording(number, hz, noise_dps, latitude_deg):
    """25 minutes: a fast ramp with motion that sets in slowly, a knock, shakes, faults and gaps."""
    rng, at_s = np.random.default_rng(number), np.arange(0, 1500, 1 / hz)
    n = len(at_s)
    degc = 20 + np.clip(at_s - 200, 0, 700) / 40
    rate = 0.15 * degc[:, None] * [1.0, -0.5, 0.2] + 0.3 * (at_s[:, None] > 502) * [0, 0, 1.0]
    for middle_s, long_s, dps, axis in _MOTION:
        rate[:, axis] += dps * np.cos(np.clip((at_s - middle_s) / long_s, -0.5, 0.5) * np.pi) ** 2
    tilt = np.clip((at_s - 1100) / 60, 0, 1) + 0.02 * np.sin(at_s / 50)
    accel = np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)])
    accel += rng.normal(0, np.where(np.abs(at_s - 1300) < 20, 0.3, 0.004), (3, n)).T
    words = {f"g{a}": (rate[:, i] + rng.normal(0, noise_dps, n)) * 131 for i, a in enumerate("xyz")}
    if number != 2:
        words |= {f"a{a}": accel[:, i] * 16384 for i, a in enumerate("xyz")}
        words |= {"temp": (degc - 36.53) * 340 // 32 * 32, "fan": 9.0 * (at_s % 90 < 30)}
    if number == 0:  # a rate that is known of most
        words |= {f"ref_g{a}": rate[:, i] * 131 for i, a in enumerate("xyz")}
    if number == 1:  # an attitude that is seen now and then
        turned = np.cumsum(np.radians(rate[:, 2])) / hz / 2
        parts = np.cos(turned), 0 * turned, 0 * turned, np.sin(turned)
        words |= {f"q{part}": 9e6 * of for part, of in zip("wxyz", parts)}
    columns = {n: np.rint(of).astype(np.int64) for n, of in words.items()}
    lost = rng.random(n) < 0.02
    for name in columns.keys() & {"ref_gx", "ref_gy", "ref_gz", "qw", "fan"}:
        columns[name][lost] = GAP
    columns["gx"][rng.integers(0, n, 3)] = 32767
    columns = {"t_us": (at_s * 1e6).astype(np.int64) + 5_000_000, **columns}
    kept = (rng.random(n) < 0.96) & (np.abs(at_s - 700) > 8)
    more = {} if latitude_deg is None else {"latitude_deg": latitude_deg}
    more |= {"attitude": [2.0, 0.0, 0.0, 2.0]} if number == 3 else {}
    scales = Scales("MPU-6050", hz, 131.0, 16384.0, 340.0, 36.53, more=more)
    return Recording({n: of[kept] for n, of in columns.items()}, scales, f"run-{number}")


def edges(mask):
    """Where a mask changes, in words."""
    return [" ".join(map(str, np.flatnonzero(np.diff(np.r_[0, mask, 0]))))]


def _numbers(of):
    """Of a number or an array of them: what is there, and how it goes along; of none nothing."""
    of = np.asarray(of if isinstance(of, int | float | np.ndarray) else [])
    if not of.size or of.dtype.kind not in "biuf":
        return {}
    of = np.atleast_1d(of).astype(float)
    there, at = np.isfinite(of), np.linspace(-1, 1, len(of))
    of = np.where(there, of, 0.0)
    return {"": of, " along": of.T * at, " there": there.T * at}


def rests():
    """{name: numbers} and {name: words} of recordings, ticks and sessions."""
    found, words = {}, {}
    with TemporaryDirectory() as folder:
        for number, kind in enumerate(_KINDS):
            path = Path(folder, f"{number}.parquet")
            write_recording(_recording(number, *kind), path)
            ticks = read_ticks(path, tick_seconds(path))
            [session] = sessions_from([ticks])
            own = {**vars(ticks), **vars(session), **ticks.extra, **ticks.faults, **session.sources}
            own |= {"moved": session.moved, "available": session.available}
            own |= {"earth": session.earth.rate_dps, "moving": session.moving_s}
            own |= zip(("tau", "deviation"), deviation_of(path))
            own |= zip(("stretch", "each"), still_stretch(path))
            for name, of in own.items():
                found |= {f"{number} {name}{n}": v for n, v in _numbers(of).items()}
            still, every = still_ticks(ticks), still_ticks(ticks, edges=False)
            words |= {f"{number} still": edges(still), f"{number} all still": edges(every)}
            words[f"{number} said"] = [session.earth.said]
    return found, words
