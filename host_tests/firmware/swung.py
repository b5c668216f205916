"""A device that swings about all axes, from integers alone, and what the two sources that need no
rest make of it to the last bit: committed in host_tests/golden/swung.json."""

import json
import zlib
from pathlib import Path

from zerorate.gravity import gravity
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.motion import in_motion
from zerorate.motion.motion_settings import motion_settings, motion_state

from . import trace

GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "swung.json"
_LSB = (131.0, 16384.0)
_SAMPLES, _PART = 2400, 32
_CALM = range(900, 1100)  # the device rests as it lies
_ONE = 1 << 28


def frames():
    """Yield (frame, dt_us) at 25 Hz: two pendulums turn it by up to 100 dps, gravity with it; now
    and then a bus is bad, a blow comes, or time is missing."""
    noise = list(trace.GENERATOR)
    pendulums, up_q17 = [8000, 0, 6000, 3000], [0, 0, 1 << 17]
    for n in range(_SAMPLES):
        for at, swift in ((0, 3), (2, 2)):
            pendulums[at] += pendulums[at + 1] * swift >> 4
            pendulums[at + 1] -= pendulums[at] * swift >> 4
        turn = (pendulums[0], pendulums[2], pendulums[1] + pendulums[3])
        turn = (0, 0, 0) if n in _CALM else turn
        up = [part >> 3 for part in up_q17]
        short = (_ONE - sum(part * part for part in up)) >> 14
        frame = [0, 0, 0, 2000 + n, 400, -900, 150 + (n >> 6)]
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            crossed = (up[j] * turn[k] - up[k] * turn[j]) >> 12
            up_q17[i] += (crossed * 1430 >> 13) + (up[i] * short >> 12)
            frame[i] = (up_q17[i] >> 3) + trace.noise(noise, 200)
            frame[4 + i] += turn[i] + trace.noise(noise, 12)
        dt_us = trace.PERIOD_US
        if n % 389 == 388:
            dt_us = trace.break_frame(frame, n // 389 % 7)
        elif n % 97 == 96:
            frame[n % 3] *= 2
        yield frame, dt_us


def _motion(**options):
    settings = motion_settings(25.0, *_LSB, **options)
    return in_motion.update, motion_state(settings), settings


def _gravity(**options):
    settings = gravity_settings(25.0, *_LSB, **options)
    return gravity.update, gravity_state(settings), settings


SOURCES = {
    "motion": lambda: _motion(),
    "motion, short stages": lambda: _motion(node_s=0.2, longest_stage=4, least_dps=0.01),
    "motion, document": lambda: _motion(document=True),
    "gravity": lambda: _gravity(),
    "gravity, few units": lambda: _gravity(units=4, threshold=1),
    "gravity, document": lambda: _gravity(document=True),
}


def checksums(name):
    """CRC-32 of the settings, and of the state after each part, with what the calls returned."""
    update, state, settings = SOURCES[name]()
    found, said = [zlib.crc32(settings.tobytes())], 0
    for n, (frame, dt_us) in enumerate(frames(), start=1):
        said += update(state, settings, frame, dt_us) or 0
        if n % _PART == 0:
            found.append(zlib.crc32(state.tobytes(), said))
    return found


def renew_golden():
    """Write what these sources make of it, on purpose."""
    done = {name: checksums(name) for name in SOURCES}
    GOLDEN.write_text(json.dumps(done) + "\n", encoding="utf-8")
