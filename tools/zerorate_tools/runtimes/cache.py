"""Where fetched interpreters live, and how a folder appears there whole or not at all."""

import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path


def cache_folder() -> Path:
    """The folder of everything fetched: $ZERORATE_CACHE, else zerorate in the XDG cache."""
    own = os.environ.get("ZERORATE_CACHE")
    if own:
        return Path(own).expanduser().absolute()
    xdg = os.environ.get("XDG_CACHE_HOME")
    return (Path(xdg) if xdg else Path.home() / ".cache") / "zerorate"


def runtime_folder(name: str) -> Path:
    """The folder of one fetched interpreter or tool, whether it is there or not."""
    return cache_folder() / "runtimes" / name


def fill(folder: Path, build: Callable[[Path], None]) -> Path:
    """Build `folder` beside its place and rename it there; one that is there is left alone."""
    if folder.is_dir():
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    # realpath-free and beside the target: a rename must not cross file systems.
    draft = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        build(draft)
        draft.chmod(0o755)
        _move_into_place(draft, folder)
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return folder


def _move_into_place(draft: Path, folder: Path) -> None:
    try:
        draft.rename(folder)
    except OSError:
        if not folder.is_dir():  # else another process was quicker: its copy is as good
            raise
