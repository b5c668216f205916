"""The rest path, and an effect model, as a header and a C file, with a test program."""

import zlib
from array import array
from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from zerorate import Corrector, Sensor
from zerorate.model import EffectModel

from zerorate_tools.layout import EFFECTS

from ..model.check import check_model, sensor_for
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
#define ZERORATE_EFFECTS_WORDS {words}

typedef struct {{
    int32_t state[ZERORATE_STATE_WORDS]; /* what was learned: save and load it as it is */
    int32_t settings[ZERORATE_SETTINGS_WORDS];
{effects}}} zerorate_t;

#ifdef __cplusplus
extern "C" {{
#endif
/* Forget everything. */
void zerorate_begin(zerorate_t *z);
/* sample: ax ay az temp gx gy gz, raw LSB, rates corrected in place; dt_us: since the one before.
   Returns 0 for a good reading, else what is wrong with the frame (1 repeated ... 7 time leapt). */
int32_t zerorate_update(zerorate_t *z, int32_t sample[7], int32_t dt_us);
{channels}#ifdef __cplusplus
}}
#endif
#endif
"""
_CHANNELS = """\
/* What an extra channel of the model reads now; numbers: {names}. */
void zerorate_channel(zerorate_t *z, int32_t number, int32_t value);
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
{begin}}}

int32_t zerorate_update(zerorate_t *z, int32_t sample[7], int32_t dt_us) {{
{update}}}
"""
_BARE = "    return step_step(z->state, z->settings, sample, dt_us);\n"
_BEGIN_MODEL = """\
    for (int i = 0; i < ZERORATE_EFFECTS_WORDS; i++) z->effects[i] = 0;
    for (unsigned i = 0; i < sizeof first_effects / sizeof *first_effects; i++)
        z->effects[first_effects[i][0]] = first_effects[i][1];
"""
_WITH_MODEL = """\
    int32_t *s = z->state, kind = guard_check(s, z->settings, sample, dt_us);
    effects_sense(s, z->effects, sample, dt_us, kind == 0);
    step_admit(s, z->settings, sample, kind);
    return step_finish(s, z->settings, sample, kind);
"""
_CHANNEL = """
void zerorate_channel(zerorate_t *z, int32_t number, int32_t value) {{
    if (number >= 0 && number < {count}) z->effects[{at} + number] = value;
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


def export_c(
    folder: str | PathLike[str],
    sensor: Sensor | None = None,
    model: str | PathLike[str] | None = None,
) -> list[Path]:
    """Write zerorate.h, zerorate.c and zerorate_test.c into `folder`; their paths.

    sensor: rate and scales, an MPU-6050 at +-250 dps and 100 Hz by default; model: a model.bin of
    `zerorate close`, whose scales are taken instead. Raises BadModel.
    """
    effects = EffectModel()
    if model is not None:
        sensor = sensor_for(check_model(model).scales)
        effects.load_file(str(model), sensor)
    corrector = Corrector(sensor, motion=False, gravity=False)
    if model is not None:
        corrector.use_model(effects)
    state, c, has_model = corrector.state, corrector.settings, model is not None
    dt_us = round(1e6 / corrector.sensor.odr_hz)
    texts = {
        "zerorate.h": _HEADER.format(
            state=len(state), settings=len(c), words=len(effects.e), **_declared(effects, has_model)
        ),
        "zerorate.c": _SOURCE.format(
            kernels=_kernels(effects, has_model),
            settings=", ".join(map(str, c)),
            state=_pairs(state),
            begin=_BEGIN_MODEL if has_model else "",
            update=_WITH_MODEL if has_model else _BARE,
        )
        + (_CHANNEL.format(count=len(effects.channels), at=EFFECTS.CHANNELS) * has_model),
        "zerorate_test.c": _TEST.format(samples=_SAMPLES, dt_us=dt_us, crc=_crc(corrector, dt_us)),
    }
    with written_together(folder) as draft:
        for name, text in texts.items():
            (draft / name).write_text(text, encoding="utf-8")
    return [Path(folder) / name for name in texts]


def _declared(effects: EffectModel, has_model: bool) -> dict[str, str]:
    """What the header declares of a model."""
    if not has_model:
        return {"effects": "", "channels": ""}
    names = ", ".join(f"{i} {name}" for i, name in enumerate(effects.channels)) or "none"
    words = "    int32_t effects[ZERORATE_EFFECTS_WORDS]; /* the model at work: do not save it */\n"
    return {"effects": words, "channels": _CHANNELS.format(names=names)}


def _kernels(effects: EffectModel, has_model: bool) -> str:
    if not has_model:
        return kernels_in_c(Kernels(), ("step", "step"))
    entries = (("guard", "check"), ("effects", "sense"), ("step", "admit"), ("step", "finish"))
    first = f"static const int32_t first_effects[][2] = {{{_pairs(effects.e)}}};"
    return f"{kernels_in_c(Kernels(), *entries)}\n{first}"


def _pairs(words: Iterable[int]) -> str:
    return ", ".join(f"{{{at}, {word}}}" for at, word in enumerate(words) if word)


def _crc(corrector: Corrector, dt_us: int) -> int:
    """CRC-32 of the state after the test program's samples, by CPython."""
    x, number = array("i", [0] * 7), 1
    for _ in range(_SAMPLES):
        for i in range(7):
            number = (number * 75 + 74) % 65537
            x[i] = (number >> 12) + (16384 if i == 2 else 40 * i)
        corrector.update(x, dt_us)
    return zlib.crc32(corrector.state.tobytes())
