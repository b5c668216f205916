"""The rest path, and an effect model, as a header and a C file, with a test program."""

import re
import zlib
from array import array
from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path

from zerorate import Corrector, Sensor
from zerorate.model import EffectModel
from zerorate.storage.learned_store import _STATE_VERSION
from zerorate.storage.reasons import REASONS
from zerorate.storage.soundness import _NEAR_Q8

from zerorate_tools import __version__, layout

from ..model.binary import encoded
from ..model.files import check_model, sensor_for
from ..recordings.atomic import written_together
from .c_functions import kernels_in_c
from .reading import Kernels

_SAMPLES = 5000
_FOLDER = Path(__file__).parent / "exported"
_ARRAYS = {
    "STATE": layout.STATE,
    "AXIS": layout.AXIS,
    "ESTIMATOR": layout.ESTIMATOR,
    "SETTINGS": layout.SETTINGS,
}
_PACKAGED = (
    *("library.json", "library.properties", "CMakeLists.txt", "idf_component.yml"),
    *("zephyr/module.yml", "zephyr/Kconfig", "examples/yaw/yaw.ino"),
)
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

static void begin_state(zerorate_t *z) {{
    for (int i = 0; i < ZERORATE_STATE_WORDS; i++) z->state[i] = 0;
    for (unsigned i = 0; i < sizeof first_state / sizeof *first_state; i++)
        z->state[first_state[i][0]] = first_state[i][1];
}}

static void begin_effects(zerorate_t *z) {{
{begin}}}

void zerorate_begin(zerorate_t *z) {{
    for (int i = 0; i < ZERORATE_SETTINGS_WORDS; i++) z->settings[i] = first_settings[i];
    begin_state(z);
    begin_effects(z);
}}

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
    """Write the header, the C file, a test program and what builders read into `folder`; paths.

    sensor: rate and scales, an MPU-6050 at +-250 dps and 100 Hz by default; model: a model.bin or
    model.json of `zerorate close`, whose scales are taken instead. Raises BadModel.
    """
    effects = None
    if model is not None:
        checked = check_model(model)
        sensor = sensor_for(checked.scales)
        effects = EffectModel()
        effects.load(encoded(checked), sensor)
    corrector = Corrector(sensor, motion=False, gravity=False)
    if effects is not None:
        corrector.use_model(effects)
    # and what Arduino, PlatformIO, ESP-IDF and Zephyr read
    texts = {**_code(corrector), **{name: _filled(name, corrector.sensor) for name in _PACKAGED}}
    with written_together(folder) as draft:
        for name, text in texts.items():
            (draft / name).parent.mkdir(parents=True, exist_ok=True)
            (draft / name).write_text(text, encoding="utf-8")
    return [Path(folder) / name for name in texts]


def _code(corrector: Corrector) -> dict[str, str]:
    """Name -> text of the header, the C file and the test program."""
    state, c, dt_us = corrector.state, corrector.settings, round(1e6 / corrector.sensor.odr_hz)
    words, channels, pieces = _of_model(corrector.effects)
    counts = {"STATE": len(state), "SETTINGS": len(c), "EFFECTS": layout.EFFECTS.size}
    header = {f"{name}_WORDS": str(count) for name, count in counts.items()}
    header |= {"EFFECTS": words, "CHANNELS": channels}
    last = max(layout.STORE.numbers.values())
    header["REASONS"] = "\n".join(
        f"    ZERORATE_{name} = {number}{',' * (number < last)} /* {REASONS[number]} */"
        for name, number in layout.STORE.numbers.items()
    )
    source = _SOURCE.format(settings=", ".join(map(str, c)), state=_pairs(state), **pieces)
    if corrector.effects is not None:
        count = len(corrector.effects.channels)
        source += _CHANNEL.format(count=count, at=layout.EFFECTS.CHANNELS)
    return {
        "zerorate.h": _filled("zerorate.h", corrector.sensor, header),
        "zerorate_units.h": _filled("zerorate_units.h", corrector.sensor),
        "zerorate.c": f"{source}\n{_stored(corrector)}",
        "test/zerorate_test.c": _TEST.format(
            samples=_SAMPLES, dt_us=dt_us, crc=_crc(corrector, dt_us)
        ),
    }


def _stored(corrector: Corrector) -> str:
    """What begins a power-on, saves and loads, with the layout's words that it names."""
    text = (_FOLDER / "stored.c").read_text(encoding="utf-8")
    words = {
        f"{name}_{word}": getattr(array, ("EST_" if name == "ESTIMATOR" else "") + word)
        for name, array in _ARRAYS.items()
        for word in sorted(set(re.findall(rf"\b{name}_(\w+)", text)) - {"BITS"})
    }
    words |= {
        "NO_VALUE": layout.MARKS.NO_VALUE,
        "FREE": layout.MARKS.FREE,
        "STILL": layout.STILLNESS.STILL,
    }
    words |= {"ANY_TEMPERATURE": layout.SOURCE.ANY_TEMPERATURE, "NEAR_Q8": _NEAR_Q8}
    words |= {"RECORD_VERSION": _STATE_VERSION, "OWN_STEP_LSB": corrector._step_lsb}
    crc = corrector.effects.crc if corrector.effects is not None else b""
    words |= {"MODEL_CRC": f"0x{int.from_bytes(crc, 'little'):08x}u"}
    lines = [f"#define {name} ({value})" for name, value in words.items()]
    for name in ("AXIS", "ESTIMATOR"):
        bits = "".join(f"\\x{bit:02x}" for bit in _ARRAYS[name].bits())
        lines.append(f'#define {name}_BITS "{bits}"')
    return "\n".join([*lines, "", text])


def _of_model(effects: EffectModel | None) -> tuple[str, str, dict[str, str]]:
    """What the header declares of a model's words and channels, and what the C file does."""
    if effects is None:
        kernels = kernels_in_c(Kernels(), ("step", "step"))
        return "", "", {"kernels": kernels, "begin": "    (void)z;\n", "update": _BARE}
    names = ", ".join(f"{i} {name}" for i, name in enumerate(effects.channels)) or "none"
    words = "    int32_t effects[ZERORATE_EFFECTS_WORDS]; /* the model at work: do not save it */\n"
    entries = (("guard", "check"), ("effects", "sense"), ("step", "admit"), ("step", "finish"))
    first = f"static const int32_t first_effects[][2] = {{{_pairs(effects.e)}}};"
    kernels = f"{kernels_in_c(Kernels(), *entries)}\n{first}"
    pieces = {"kernels": kernels, "begin": _BEGIN_MODEL, "update": _WITH_MODEL}
    return words, _CHANNELS.format(names=names), pieces


def _filled(name: str, sensor: Sensor, more: Mapping[str, str] | None = None) -> str:
    """The text of a file of this folder, its @NAMES@ replaced."""
    text = (_FOLDER / name).read_text(encoding="utf-8")
    scales = (sensor.gyro_lsb_per_dps, sensor.accel_lsb_per_g, sensor.temp_lsb_per_degc)
    numbers = (sensor.odr_hz, *scales, sensor.temp_offset_degc)
    values = {"VERSION": __version__, **(more or {})}
    values |= dict(zip(("MAJOR", "MINOR", "PATCH"), __version__.split(".")))
    for key, number in zip(("ODR_HZ", "GYRO", "ACCEL", "TEMP", "OFFSET"), numbers):
        values[key] = repr(float(number))
    return re.sub("@([A-Z_]+)@", lambda found: values[found[1]], text)


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
