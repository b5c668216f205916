"""The firmware and the driver put on a board: the packages' own files, nothing else."""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path, PurePosixPath

from ..errors import InFile
from .connection import connected

PACKAGES = ("zerorate", "zerorate_i2c")
# Parts of the packages that a board has no use for.
_HOST_ONLY = {"zerorate_i2c/linux.py"}
_LIBRARY = PurePosixPath("lib")


def package_files(package: str) -> dict[PurePosixPath, Path]:
    """Path below lib on the board -> file, for every file of a package that a board needs."""
    spec = find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise ModuleNotFoundError(f"{package} is not installed beside zerorate_tools")
    root = Path(next(iter(spec.submodule_search_locations)))
    found = {PurePosixPath(package, *p.relative_to(root).parts): p for p in root.rglob("*.py")}
    return {name: found[name] for name in sorted(found) if str(name) not in _HOST_ONLY}


def flash(
    port: str,
    dry_run: bool = False,
    main: Path | None = None,
    say: Callable[[str], None] = print,
    model: Path | None = None,
) -> int:
    """Copy the packages to lib on the board at port; total bytes.

    main: a file, copied to main.py; model: a model.bin or model.json, to model.bin, where
    `EffectModel.load_file` finds it. Every file is told to say with its size; dry_run only tells.
    Files that are the same there already stay. Raises BoardError, BadModel, InFile.
    """
    files = _contents(main, model)
    total = sum(map(len, files.values()))
    if dry_run:
        for name, data in files.items():
            say(f"{len(data):8d}  {name}")
    else:
        with connected(port) as board:
            for name, data in files.items():
                say(f"{len(data):8d}  {name}  {_put(board, name, data)}")
    say(f"{total:8d}  bytes in {len(files)} files" + (" (dry run)" if dry_run else ""))
    return total


def _contents(main: Path | None, model: Path | None) -> dict[PurePosixPath, bytes]:
    files = {
        _LIBRARY / name: path.read_bytes()
        for package in PACKAGES
        for name, path in package_files(package).items()
    }
    if main is not None:
        files[PurePosixPath("main.py")] = _read(Path(main))
    if model is not None:
        from ..model import encoded, read_model  # recording needs none of what these import

        files[PurePosixPath("model.bin")] = encoded(read_model(model))
    return files


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InFile(path, f"cannot be read: {error.strerror}", do="name a program") from error


def _put(board, name: PurePosixPath, data: bytes) -> str:
    for folder in reversed(name.parents[:-1]):
        if not board.fs_exists(str(folder)):
            board.fs_mkdir(str(folder))
    if _is_there(board, name, data):
        return "the same already"
    board.fs_writefile(str(name), data)
    return "written"


def _is_there(board, name: PurePosixPath, data: bytes) -> bool:
    """By its hash, which the board works out where it can."""
    try:
        return board.fs_hashfile(str(name), "sha256") == sha256(data).digest()
    except FileNotFoundError:
        return False
