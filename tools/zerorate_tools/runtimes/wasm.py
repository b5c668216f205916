"""MicroPython's WebAssembly port under Node.js: 31-bit small integers."""

import json
from pathlib import Path

from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes.cache import runtime_folder
from zerorate_tools.runtimes.node import install, locked_version, node_command
from zerorate_tools.runtimes.runtime import Job, Runtime

_HERE = Path(__file__).parent / "webassembly"
_PACKAGE = "@micropython/micropython-webassembly-pyscript"
_JOB_FILE = ".job.json"


class Wasm(Runtime):
    """The WebAssembly port; `heap` is where it starts, it grows by itself."""

    name = "wasm"

    def __init__(self, package: Path, node: list[str]) -> None:
        self.package = package
        self.node = node

    def command(self, job: Job) -> list[str]:
        work = {
            "package": str(self.package),
            "folder": str(job.folder),
            "script": job.script,
            "argv": job.args,
            "modules": [str(m) for m in job.modules],
            "files_out": job.files_out,
            "heap": job.heap_bytes,
        }
        (job.folder / _JOB_FILE).write_text(json.dumps(work), encoding="utf-8")
        return [*self.node, str(_HERE / "runner.mjs"), _JOB_FILE]


def find_wasm() -> Wasm:
    """The fetched package with a Node.js to run it. Raises MissingRuntime."""
    package = _folder() / "node_modules" / _PACKAGE
    if not package.is_dir():
        raise MissingRuntime("the wasm interpreter is not fetched yet")
    return Wasm(package, node_command())


def fetch_wasm() -> None:
    """Install the package that package-lock.json pins. Raises MissingRuntime."""
    install(_HERE, _folder(), _PACKAGE)


def _folder() -> Path:
    return runtime_folder(f"wasm-{locked_version(_HERE, _PACKAGE)}")
