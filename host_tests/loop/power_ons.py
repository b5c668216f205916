"""Simulated sessions, and rests made of noise, as recordings on disk."""

from dataclasses import replace

import numpy as np
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.verify.power_on import PowerOn
from zerorate_tools.recordings import Recording, Scales, write_recording

SCALES = Scales("MPU-6050", 1.0, 1310.0, 16384.0, 340.0, 36.53)
#: Of `at_rest`.
HZ = 5.0
MPU = Scales("MPU-6050", HZ, 131.0, 16384.0, 340.0, 36.53)
#: Samples and ticks a block, of `powered_on`.
PER, TICKS = 20, 4


def recording(session, scales=SCALES, channel="load"):
    """A simulated session as one raw sample a second, which is one tick.

    channel: the name of its load, in hundredths; without a scale there is no temperature.
    """
    ticks = session.blocks * 20
    at = (np.arange(ticks) + 0.5) / 20 - 0.5
    columns = {"t_us": np.arange(ticks, dtype=np.int64) * 1_000_000}
    for a, name in enumerate(("gx", "gy", "gz")):
        rate = np.interp(at, np.arange(session.blocks), session.rate_dps[:, a])
        columns[name] = np.round(rate * scales.gyro_lsb_per_dps).astype(np.int32)
    for name, g in zip(("ax", "ay", "az"), (0, 0, 16384)):
        columns[name] = g + np.arange(ticks, dtype=np.int32) % 7
    if scales.temp_lsb_per_degc:
        degc = np.repeat(session.sources["temp"], 5)
        columns["temp"] = np.round((degc - 36.53) * 340).astype(np.int32)
    columns[channel] = np.round(np.repeat(session.sources["load"], 5) * 100).astype(np.int32)
    return Recording(columns, scales, session.name)


def at_rest(seed, n=6000, bias_lsb=30, middle_degc=25.0, swing_degc=8.0, **more):
    """Columns of a rest at 5 Hz, the temperature going up and down."""
    rng, at = np.random.default_rng(seed), np.arange(n)
    degc = middle_degc + swing_degc * np.sin(at / n * 6 + seed)
    return {
        "t_us": (at * 1e6 / HZ).astype(np.int64),
        **{a: np.rint(rng.normal(bias_lsb, 4, n)).astype(np.int32) for a in ("gx", "gy", "gz")},
        **{a: np.rint(rng.normal(0, 60, n)).astype(np.int32) for a in ("ax", "ay")},
        "az": np.rint(rng.normal(16384, 60, n)).astype(np.int32),
        "temp": np.rint((degc - 36.53) * 340).astype(np.int32),
        **more,
    }


def turning(seed, rate_dps, hz=20.0, noise_dps=0.05):
    """Columns of one rate, (n,) dps, about all axes."""
    rng, n = np.random.default_rng(seed), len(rate_dps)
    columns = {"t_us": np.arange(n, dtype=np.int64) * round(1e6 / hz)}
    for name in ("gx", "gy", "gz"):
        columns[name] = np.round((rate_dps + rng.normal(0, noise_dps, n)) * 131).astype(np.int32)
    return columns


def written(folder, recordings):
    """The paths of some recordings, written under their own names."""
    paths = []
    for one in recordings:
        paths.append(folder / f"{one.name}.parquet")
        write_recording(one, paths[-1])
    return paths


def with_volts(seed=0, blocks=40, bias_lsb=(30, -20, 10)):
    """Columns of a rest at one temperature, with a voltage beside it."""
    n = blocks * PER
    volts = np.random.default_rng(seed + 1000).normal(5000, 50, n)
    columns = at_rest(seed, n, 0, middle_degc=27.7, swing_degc=0.0)
    columns |= {g: columns[g] + b for g, b in zip(("gx", "gy", "gz"), bias_lsb)}
    return {**columns, "volt": np.rint(volts).astype(np.int32)}


def powered_on(folder, columns, channels=(), name="s", **more):
    """A recording on disk and its session, a block of four seconds."""
    [path] = written(folder, [Recording(columns, MPU, name)])
    rate = np.column_stack([columns[g] for g in ("gx", "gy", "gz")]) / 131.0
    blocks = -(-len(rate) // PER)
    means = [rate[at * PER : (at + 1) * PER].mean(axis=0) for at in range(blocks)]
    ticks = {n: np.resize(columns[n], blocks * PER).reshape(-1, 5) for n in ("temp", "volt")}
    sources = {n: of.mean(axis=1) for n, of in ticks.items()}
    sources["temp"] = 36.53 + sources["temp"] / 340
    session = Session(
        *(name, 4.0, TICKS, np.array(means), np.ones(blocks), sources),
        start_us=int(columns["t_us"][0]),
        tick_weight=np.full(blocks * TICKS, HZ),
    )
    session = replace(session, **more)
    every = np.ones(session.blocks, bool)
    return PowerOn(session, path, 131.0, session.rate_dps, every, channels)
