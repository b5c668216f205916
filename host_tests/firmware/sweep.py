"""Random sensors, settings and signals within the documented ranges: does anything leave 31 bits?

`make sweep` runs 10,000 configurations; `python -m host_tests.firmware.sweep -h` says more. Each
has everything drawn by its own number, so that what fails can be run again alone.
"""

import argparse
import random
import sys
from array import array

import numpy as np
from zerorate import Corrector, Sensor
from zerorate.settings import DEFAULTS, LEAST, MOST, has_meaning
from zerorate.storage.soundness import is_sound
from zerorate_tools.layout import SETTINGS
from zerorate_tools.replay.engines import others_of

from .checked import CheckedLibrary

RAIL = 32767
ROWS = 3000
_LEAPS_US = [0, -1, 1 << 29, -(1 << 29), (1 << 30) - 1, 900_000_000]


def between(draw, least, most):
    """A number of that range: an end of it, or anything between by its logarithm."""
    if draw.random() < 0.2:
        return draw.choice([least, most])
    low = max(least, most / 1e6)
    return min(most, low * (most / low) ** draw.random())


def sensor(draw):
    """A Sensor of the ranges that its constructor takes."""
    channel = draw.random()
    accel = 0.0 if channel < 0.1 else between(draw, 1.0, 32768.0)
    temp = 0.0 if channel > 0.9 else between(draw, 1.0, 2000.0)
    rate, scale = between(draw, 0.01, 8000.0), between(draw, 1.0, 8000.0)
    return Sensor(rate, scale, accel, temp, between(draw, 0.0, 100.0))


def options(draw, device):
    """Keywords of a Corrector for that sensor: form, sources, and some settings."""
    short = draw.randint(1, 6)
    found = {"bins": draw.randint(4, 19), "short": short, "long": draw.randint(1, 18 - short)}
    for name in ("document", "every", "ignore_outside"):
        found[name] = draw.random() < 0.3
    found["motion"] = device.accel_lsb_per_g and draw.random() < 0.4
    found["gravity"] = device.accel_lsb_per_g and draw.random() < 0.4
    if draw.random() < 0.7:  # so that few rows learn, evict and fit
        found["window_s"] = 0.0001
    for name in draw.sample(sorted(DEFAULTS), draw.choice([0, 1, 3, 8, len(DEFAULTS)])):
        if not has_meaning(name, found["document"], found["every"]):
            continue
        found[name] = between(draw, LEAST.get(name, 0.0), MOST[name.split("_")[-1]])
    return found


def corrector_of(number):
    """(what was chosen, the Corrector) of that configuration."""
    draw = random.Random(number)
    device = sensor(draw)
    chosen = options(draw, device)
    said = f"{vars(device)} {chosen}"
    try:
        return said, Corrector(device, **chosen)
    except OverflowError as error:
        return f"{error}, with {said}", None
    except ValueError:  # too slow a rate for the other sources
        return said, Corrector(device, **chosen | {"motion": False, "gravity": False})


def signal(noise, rows):
    """(rows, 7) frames: rests far apart in rate and temperature, motion, and anything at all."""
    frames = np.empty((rows, 7))
    at = 0
    while at < rows:
        count = int(noise.choice([30, 100, 400]))
        part = frames[at : at + count]
        spread = noise.choice([0, 1, 8, 60])
        level = noise.choice([0, 131, RAIL - 70, 70 - RAIL]) + noise.integers(-60, 61, 7)
        level[:3] = noise.choice([0, 16384, RAIL], 3)
        level[3] = noise.integers(-32768, 32768)
        part[:] = level + noise.normal(0, spread, part.shape)
        kind = noise.integers(6)
        if kind == 0:
            part[:] = noise.integers(-32768, 32768, part.shape)
        elif kind == 1:
            part[:, 4:] = np.where(np.arange(len(part)) & 1, RAIL - 9, 9 - RAIL)[:, None]
        elif kind == 2:
            part[:, 3] += np.arange(len(part)) * noise.choice([-390, -17, 17, 390])
        at += count
    return np.clip(np.rint(frames), -RAIL - 1, RAIL)


def times(noise, corrector, rows):
    """(rows,) dt_us: the period, now and then a leap."""
    period_us = max(1, min(900_000_000, round(1e6 / corrector.sensor.odr_hz)))
    dt_us = np.full(rows, period_us)
    leaps = noise.integers(0, rows, rows // 300)
    dt_us[leaps] = noise.choice([*_LEAPS_US, corrector.settings[SETTINGS.LEAP_US]], len(leaps))
    return dt_us


def attack(library, number, rows=ROWS):
    """What configuration `number` does that no small integer can, or ""."""
    chosen, corrector = corrector_of(number)
    if corrector is None:
        return chosen
    noise = np.random.default_rng(number)
    arrays = [corrector.state, corrector.settings, *others_of(corrector)]
    for words in arrays:
        if words is not None and max(map(abs, words)) >= 1 << 30:
            return f"a word beyond 31 bits at the start, with {chosen}"
    guard = array("i", [0] * 64)
    words = [None if a is None else np.array([*a, *guard], np.int32) for a in arrays]
    for part in range(2):  # the second is a power-on with what the first learned
        left = library.run(words, signal(noise, rows // 2), times(noise, corrector, rows // 2))
        if left or any(w is not None and w[-64:].any() for w in words):
            return f"{left or 'a word behind an array'}, power-on {part}, with {chosen}"
        corrector.state[:] = array("i", words[0][:-64].tolist())
        if not is_sound(corrector.state, corrector.settings):
            return f"a state that no store would give back, power-on {part}, with {chosen}"
        corrector.power_on()
        words[0][:-64] = corrector.state
    return ""


def main(arguments=None):
    """Attack; 1 if anything left 31 bits."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--configurations", type=int, default=10000)
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    chosen = parser.parse_args(arguments)
    library, found = CheckedLibrary(flags=("-O1",)), 0
    for number in range(chosen.first, chosen.first + chosen.configurations):
        left = attack(library, number)
        if left:
            found += 1
            print(f"{number}: {left}", flush=True)
    print(f"{chosen.configurations} configurations of {ROWS} samples: {found} overflows")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
