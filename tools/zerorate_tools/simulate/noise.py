"""Noise by its colour: what no model can take away; and the random streams it is drawn from."""

import zlib

import numpy as np
from scipy.signal import lfilter

_OCTAVES_TO_S = 4e4


def stream(seed: int, session: int, purpose: str) -> np.random.Generator:
    """A generator for one purpose of one session.

    Noise stays the same sample for sample when an effect is added, so two runs differ by it alone.
    """
    return np.random.default_rng([seed, session, zlib.crc32(purpose.encode())])


def flicker(rng: np.random.Generator, n: int, dt_s: float, floor: np.ndarray) -> np.ndarray:
    """(n, axes) flicker noise whose Allan deviation is flat at `floor` (axes,), same unit.

    A sum of first-order Gauss-Markov processes, one per octave of time constant from dt to 4e4 s,
    all of one variance s2: one-sided density h/f with h = s2/ln 2, Allan variance 2 ln2 h
    (IEEE Std 952, annex C; the factor 0.664 of some data sheets is this over the bias instability).
    """
    std = np.asarray(floor, float) / np.sqrt(2.0)
    total = np.zeros((n, len(std)))
    for tau_s in octaves_s(dt_s):
        total += gauss_markov(rng, n, dt_s, tau_s, std)
    return total


def octaves_s(dt_s: float) -> np.ndarray:
    """Time constants of flicker noise, s: an octave each, from a sample's to 4e4 s."""
    return dt_s * 2.0 ** np.arange(max(int(np.ceil(np.log2(_OCTAVES_TO_S / dt_s))), 1))


def gauss_markov(
    rng: np.random.Generator, n: int, dt_s: float, tau_s: float, std: np.ndarray
) -> np.ndarray:
    """(n, axes) stationary first-order process of correlation time tau_s and deviation `std`."""
    keep = np.exp(-dt_s / tau_s)
    drive = rng.standard_normal((n, len(std))) * (std * np.sqrt(1 - keep**2))
    first = rng.standard_normal((1, len(std))) * std
    return lfilter([1.0], [1.0, -keep], drive, axis=0, zi=keep * first)[0]


def random_walk(rng: np.random.Generator, n: int, dt_s: float, step: np.ndarray) -> np.ndarray:
    """(n, axes) walk from zero; step (axes,) is its deviation after one second."""
    steps = rng.standard_normal((n, len(step))) * (np.asarray(step) * np.sqrt(dt_s))
    steps[:1] = 0.0
    return np.cumsum(steps, axis=0)


def telegraph(
    rng: np.random.Generator, n: int, dt_s: float, size: np.ndarray, mean_s: float
) -> np.ndarray:
    """(n, axes) jumps between -size/2 and +size/2, each level held mean_s on average."""
    flips = rng.random((n, len(size))) < dt_s / mean_s
    flips[0] = rng.random(len(size)) < 0.5
    return (np.cumsum(flips, axis=0) % 2 - 0.5) * size


def power_law(
    rng: np.random.Generator, n: int, dt_s: float, std: np.ndarray, exponent: float
) -> np.ndarray:
    """(n, axes) noise with density f**-exponent and deviation `std` over these n samples."""
    frequency = np.fft.rfftfreq(n, dt_s)
    shape = np.zeros_like(frequency)
    shape[1:] = frequency[1:] ** (-exponent / 2)
    spectrum = np.fft.rfft(rng.standard_normal((n, len(std))), axis=0) * shape[:, None]
    coloured = np.fft.irfft(spectrum, n, axis=0)
    return coloured / np.maximum(coloured.std(axis=0), 1e-300) * std


def outliers(
    rng: np.random.Generator, n: int, dt_s: float, size: float, per_hour: float
) -> np.ndarray:
    """(n, 3) rare single readings off by a normal deviate of deviation `size`."""
    hit = rng.random(n) < per_hour * dt_s / 3600
    return np.where(hit[:, None], rng.standard_normal((n, 3)) * size, 0.0)
