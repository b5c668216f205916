"""The rest path as one header and one C file, for who has no MicroPython, with a test program."""

import zlib
from array import array
from os import PathLike
from pathlib import Path

from zerorate import Corrector, Sensor

from ..recordings.atomic import written_together
from .c_functions import kernels_in_c
from .reading import Kernels

_SAMPLES = 5000
_HEADER = """\
/* zerorate: keeps a gyroscope's bias at zero. Made by `zerorate export c`; see docs/c.md.
   Integers of 32 bits only: no heap, no float, no library. MIT licence. */
#ifndef ZERORATE_H
#define ZERORATE_H
#include <stdint.h>

#define ZERORATE_STATE_WORDS {state}
#define ZERORATE_SETTINGS_WORDS {settings}

typedef struct {{
    int32_t state[ZERORATE_STATE_WORDS]; /* what was learned: save and load it as it is */
    int32_t settings[ZERORATE_SETTINGS_WORDS];
}} zerorate_t;

#ifdef __cplusplus
extern "C" {{
#endif
/* Forget everything. */
void zerorate_begin(zerorate_t *z);
/* sample: ax ay az temp gx gy gz, raw LSB, rates corrected in place; dt_us: since the one before.
   Returns 0 for a good reading, else what is wrong with the frame (1 repeated ... 7 time leapt). */
int32_t zerorate_update(zerorate_t *z, int32_t sample[7], int32_t dt_us);
#ifdef __cplusplus
}}
#endif
#endif
"""
_SOURCE = """\
/* Made by `zerorate export c` from the kernels of zerorate: the firmware's own text in C. */
#include "zerorate.h"

{kernels}
static const int32_t first_settings[ZERORATE_SETTINGS_WORDS] = {{{settings}}};
static const int32_t first_state[][2] = {{{state}}};

void zerorate_begin(zerorate_t *z) {{
    for (int i = 0; i < ZERORATE_SETTINGS_WORDS; i++) z->settings[i] = first_settings[i];
    for (int i = 0; i < ZERORATE_STATE_WORDS; i++) z->state[i] = 0;
    for (unsigned i = 0; i < sizeof first_state / sizeof *first_state; i++)
        z->state[first_state[i][0]] = first_state[i][1];
}}

int32_t zerorate_update(zerorate_t *z, int32_t sample[7], int32_t dt_us) {{
    return step_step(z->state, z->settings, sample, dt_us);
}}
"""
_TEST = """\
/* Replays {samples} made-up samples and compares the state with what Python's kernels left. */
#include <stdio.h>

#include "zerorate.h"

static zerorate_t z;

int main(void) {{
    uint32_t number = 1, crc = 0xffffffff;
    zerorate_begin(&z);
    for (int n = 0; n < {samples}; n++) {{
        int32_t x[7];
        for (int i = 0; i < 7; i++) {{
            number = (number * 75 + 74) % 65537;
            x[i] = (int32_t)(number >> 12) + (i == 2 ? 16384 : 40 * i);
        }}
        zerorate_update(&z, x, {dt_us});
    }}
    for (int i = 0; i < ZERORATE_STATE_WORDS; i++)
        for (int k = 0; k < 32; k += 8) {{
            crc ^= (uint32_t)z.state[i] >> k & 0xff;
            for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }}
    crc ^= 0xffffffff;
    printf("%s: state %08lx, expected {crc:08x}\\n", crc == 0x{crc:08x}u ? "equal" : "DIFFERENT",
           (unsigned long)crc);
    return crc != 0x{crc:08x}u;
}}
"""


def export_c(folder: str | PathLike[str], sensor: Sensor | None = None) -> list[Path]:
    """Write zerorate.h, zerorate.c and zerorate_test.c into `folder`; their paths.

    sensor: rate and scales, an MPU-6050 at +-250 dps and 100 Hz by default.
    """
    corrector = Corrector(sensor, motion=False, gravity=False)
    state, c = corrector.state, corrector.settings
    pairs = ", ".join(f"{{{at}, {word}}}" for at, word in enumerate(state) if word)
    dt_us = round(1e6 / corrector.sensor.odr_hz)
    texts = {
        "zerorate.h": _HEADER.format(state=len(state), settings=len(c)),
        "zerorate.c": _SOURCE.format(
            kernels=kernels_in_c(Kernels(), ("step", "step")),
            settings=", ".join(map(str, c)),
            state=pairs,
        ),
        "zerorate_test.c": _TEST.format(samples=_SAMPLES, dt_us=dt_us, crc=_crc(corrector, dt_us)),
    }
    with written_together(folder) as draft:
        for name, text in texts.items():
            (draft / name).write_text(text, encoding="utf-8")
    return [Path(folder) / name for name in texts]


def _crc(corrector: Corrector, dt_us: int) -> int:
    """CRC-32 of the state after the test program's samples, by CPython."""
    x, number = array("i", [0] * 7), 1
    for _ in range(_SAMPLES):
        for i in range(7):
            number = (number * 75 + 74) % 65537
            x[i] = (number >> 12) + (16384 if i == 2 else 40 * i)
        corrector.update(x, dt_us)
    return zlib.crc32(corrector.state.tobytes())
