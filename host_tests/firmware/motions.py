"""Simulated motion for the two sources that learn without rest, in raw LSB with its true bias.

And words of the source in motion as vectors and turns.
"""

from array import array
from itertools import accumulate
from operator import mul

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation
from zerorate.motion.motion_settings import motion_settings

GYRO_LSB_PER_DPS = 131.0
ACCEL_LSB_PER_G = 16384.0
SETTINGS = motion_settings()
Q14, Q12 = 1 << 14, 4096


class Motion:
    """A device at +-250 dps and +-2 g. samples: (n, 7) ints; bias_dps: (3,)."""

    def __init__(self, attitude, bias_dps, hz, seed, shake_g=0.1):
        random = np.random.default_rng(seed)
        count = len(attitude) - 1
        rates = np.degrees((attitude[:-1].inv() * attitude[1:]).as_rotvec()) * hz
        up = np.tile([0.0, 0.0, 1.0], (count, 1))
        t = np.arange(count) / hz
        for axis in range(3):
            cycle = 2 * np.pi * random.uniform(0.5, 2.5) * t
            up[:, axis] += shake_g * np.sin(cycle + random.uniform(0, 6.28))
        force = attitude[:-1].inv().apply(up) + random.normal(0, 0.004, (count, 3))
        rates = rates + bias_dps + random.normal(0, 0.05, (count, 3))
        samples = np.zeros((count, 7))
        samples[:, :3] = force * ACCEL_LSB_PER_G
        samples[:, 4:] = rates * GYRO_LSB_PER_DPS
        self.samples = np.clip(np.round(samples), -32768, 32767).astype(int)
        self.bias_dps = np.asarray(bias_dps)
        self.hz, self.attitude = hz, attitude


def pose(seed):
    """A random attitude."""
    return Rotation.from_rotvec(np.random.default_rng(seed).normal(0, 1.2, 3))


def swinging(seed, seconds, hz=50.0, bias_dps=None, turn_dps=None, start=None):
    """All axes swing at 20 to 120 dps about a mean attitude; turn_dps: heading rate, per sample."""
    random = np.random.default_rng(seed)
    t = np.arange(int(seconds * hz) + 1) / hz
    angles = np.zeros((len(t), 3))
    for axis in range(3):
        cycle = 2 * np.pi * random.uniform(0.4, 2.0)
        peak = np.radians(random.uniform(20, 120)) / cycle
        angles[:, axis] = peak * np.sin(cycle * t + random.uniform(0, 6.28))
    attitude = (pose(seed) if start is None else start) * Rotation.from_rotvec(angles)
    if turn_dps is not None:
        heading = np.cumsum(np.resize(turn_dps, len(t))) / hz
        attitude = Rotation.from_rotvec(np.radians(heading)[:, None] * [0, 0, 1]) * attitude
    bias_dps = random.uniform(-6, 6, 3) if bias_dps is None else bias_dps
    return Motion(attitude, bias_dps, hz, seed)


def wandering(seed, seconds, hz=50.0):
    """Turns of 60 dps about each axis, to all poses."""
    random = np.random.default_rng(seed)
    rates = gaussian_filter1d(random.normal(size=(int(seconds * hz), 3)), hz / 2, axis=0)
    turns = Rotation.from_rotvec(np.radians(60 * rates / rates.std()) / hz)
    attitude = Rotation.concatenate(list(accumulate(turns, mul, initial=Rotation.identity())))
    return Motion(attitude, random.uniform(-6, 6, 3), hz, seed, shake_g=0.05)


def turning(seconds, dps, axis, hz=50.0, bias_dps=(1.0, -2.0, 3.0), start=None, seed=0):
    """A steady turn about an axis of the room, e.g. [1, 0, 0] for a turntable on its side."""
    t = np.arange(int(seconds * hz) + 1) / hz
    turn = Rotation.from_rotvec(np.radians(dps) * t[:, None] * np.asarray(axis))
    start = Rotation.identity() if start is None else start
    return Motion(turn * start, bias_dps, hz, seed, shake_g=0.0)


class Fed:
    """A source fed with recordings; learned: (seconds, bias dps, sigma dps) of each time it did."""

    def __init__(self, update, settings, state, bias, sigma):
        self.update, self.settings, self.state, self.at = update, settings, state, (bias, sigma)
        self.learned = []
        self.seconds = 0.0

    def feed(self, motion):
        dt_us = round(1e6 / motion.hz)
        scale = 256 * GYRO_LSB_PER_DPS
        for sample in motion.samples.tolist():
            self.seconds += 1 / motion.hz
            if self.update(self.state, self.settings, sample, dt_us):
                bias, sigma = (np.array(self.state[a : a + 3]) / scale for a in self.at)
                self.learned.append((self.seconds, bias, sigma))
            self.after_each()
        return self

    def after_each(self):
        pass

    def errors_mdps(self, bias_dps, after_s=0.0):
        return np.array([1000 * (b - bias_dps) for t, b, _ in self.learned if t >= after_s])


def put_words(state, at, values):
    state[at : at + len(values)] = array("i", [int(round(v)) for v in values])


def rotation_at(state, at):
    w, *xyz = state[at : at + 4]
    return Rotation.from_quat([*xyz, w])
