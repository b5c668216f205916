"""npm packages pinned by a folder's package-lock.json, installed into the cache."""

import json
import shutil
import subprocess
from pathlib import Path

from ..errors import MissingRuntime
from .cache import fill
from .node import node_command, npm_command, npm_environment

_INSTALL = ["ci", "--ignore-scripts", "--no-audit", "--no-fund", "--no-update-notifier"]


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
    done = subprocess.run(
        [*npm_command(), *_INSTALL],
        cwd=folder,
        env=npm_environment(),
        capture_output=True,
        text=True,
    )
    if done.returncode:
        why = _complaint(done.stderr)
        raise MissingRuntime(f"npm could not install {package}, is there a network? {why}")


def _complaint(stderr: str) -> str:
    lines = [line for line in stderr.strip().splitlines() if "complete log" not in line]
    reasons = [line for line in lines if "reason:" in line] or lines[-1:] or ["no message"]
    return reasons[0].removeprefix("npm error").strip()
