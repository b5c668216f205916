"""The trace through the firmware in this process, by CPython or compiled."""

import json
import zlib
from array import array
from pathlib import Path

import numpy as np
from zerorate import Corrector, Sensor
from zerorate_tools.layout import STATE, named_state

from . import trace
from .played import by_machine_code

GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "trace.json"
WHERE = GOLDEN.with_name("where.json")


def golden(mode):
    """The checksums of a mode that were committed."""
    return json.loads(GOLDEN.read_text(encoding="utf-8"))[mode]


def corrector_for(mode):
    """The corrector that runs the trace in that mode."""
    return Corrector(Sensor(*trace.SENSOR), **trace.LIMITS, **trace.MODES[mode])


def frames(updates):
    """((n, 7) int32 frames, (n,) int32 dt_us) of the whole trace."""
    frame, generator = array("i", [0] * 7), array("i", trace.GENERATOR)
    rows, dt_us = np.empty((updates, 7), np.int32), np.empty(updates, np.int32)
    for n in range(updates):
        dt_us[n] = trace.fill(frame, n, generator)
        rows[n] = frame
    return rows, dt_us


def on_cpython(mode):
    """(final state, bias of every sample), bytes."""
    corrector = corrector_for(mode)
    frame, generator = array("i", [0] * 7), array("i", trace.GENERATOR)
    biases = array("i")
    for n in range(trace.UPDATES[mode]):
        dt_us = trace.fill(frame, n, generator)
        corrector.update(frame, dt_us)
        biases.extend(corrector.state[STATE.OUT_Q8 : STATE.OUT_Q8 + 3])
    return corrector.state.tobytes(), biases.tobytes()


def on_machine_code(mode):
    """The same by the kernels compiled."""
    corrector = corrector_for(mode)
    outcome = by_machine_code(corrector, *frames(trace.UPDATES[mode]))
    return corrector.state.tobytes(), outcome.bias_q8.tobytes()


def checksums(state, biases):
    """What is committed of a run: {"state": CRC-32, "bias": CRC-32}, hexadecimal."""
    return {"state": f"{zlib.crc32(state):08x}", "bias": f"{zlib.crc32(biases):08x}"}


def details(state, biases):
    """Every word of the final state, and a CRC-32 of each act's biases: they say where two part."""
    act = 12 * trace.ACT
    acts = [zlib.crc32(biases[at : at + act]) for at in range(0, len(biases), act)]
    return {"state": array("i", state).tolist(), "acts": acts}


def where_it_parts(mode, state, biases):
    """In words: the first act, and the words of the final state, that are not as committed."""
    old = json.loads(WHERE.read_text(encoding="utf-8"))[mode]
    new = details(state, biases)
    acts = [n for n, (a, b) in enumerate(zip(old["acts"], new["acts"])) if a != b]
    names = [name for name, _ in named_state(corrector_for(mode).settings)]
    words = [f"{n} {a} -> {b}" for n, a, b in zip(names, old["state"], new["state"]) if a != b]
    first = f"first at samples {acts[0] * trace.ACT} and on" if acts else "no bias differs"
    return f"{first}; {len(words)} words of the state: {', '.join(words[:8])}"


def renew_golden():
    """Write what this firmware makes of the trace into host_tests/golden, on purpose."""
    done = {mode: on_cpython(mode) for mode in trace.MODES}
    golden = {mode: checksums(*one) for mode, one in done.items()}
    GOLDEN.write_text(json.dumps(golden, indent=2) + "\n", encoding="utf-8")
    where = {mode: details(*one) for mode, one in done.items()}
    WHERE.write_text(json.dumps(where) + "\n", encoding="utf-8")
