"""Outputs appear whole or not at all, a file or a folder of them."""

import errno
import os
import platform
import re
import shutil
import signal
import zlib
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from ..errors import InFile

_ENDING = 40
_LONGEST_NAME = 255
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS)
_MINE = f"{zlib.crc32(platform.node().encode()):08x}"
_MARK = re.compile(r"\.(?:([0-9a-f]{8})-)?([0-9]+)\.partial(\..*)?", re.DOTALL)
_HELD = {getattr(signal, name) for name in ("SIGTERM", "SIGINT", "SIGHUP") if hasattr(signal, name)}
_under_way: set[Path] = set()
_Path = str | os.PathLike[str]


@contextmanager
def written_beside(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a file name beside `path`, renamed onto it when the block ends well, else deleted.

    The name keeps the suffixes, as libraries choose a format by them. What a killed run left beside
    it goes. Raises InFile if the folder does not exist or cannot be written, or has no room.
    """
    path = Path(path)
    clear_left_over(path.parent)
    temporary = path.with_name(_beside(path.name))
    _under_way.add(temporary)
    try:
        temporary.touch()
    except OSError as error:
        do = "name a folder that exists and is yours"
        raise _cannot_be_written(path, error, do) from error
    try:
        check_name(path)
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        if error.errno not in _FULL:
            raise
        raise _cannot_be_written(path, error, "make room, or name another folder") from error
    finally:
        _drop(temporary)


def check_name(path: Path) -> None:
    """Raise InFile if the name is too long for a file."""
    if len(os.fsencode(path.name)) > _LONGEST_NAME:
        problem = f"the name is longer than {_LONGEST_NAME} bytes"
        raise InFile(path, problem, do="give it a shorter one")


def check_apart(outputs: Iterable[_Path | None], inputs: Iterable[_Path | None]) -> None:
    """Raise InFile if an output is a file that is read, too, or two outputs are one; None: none."""
    read = {Path(path).resolve() for path in inputs if path is not None}
    written: set[Path] = set()
    for path in outputs:
        if path is None:
            continue
        place = Path(path).resolve()
        if place in read:
            raise InFile(path, "would be written over, but is read", do="name another to write")
        if place in written:
            raise InFile(path, "would be written twice", do="name another for one of the two")
        written.add(place)


@contextmanager
def written_together(folder: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield an empty draft of `folder`; its files go there when the block ends well, or none does.

    The folder is made where it is not there. Raises InFile if it cannot be written.
    """
    with all_written_together([folder]) as drafts:
        yield drafts[0]


@contextmanager
def all_written_together(folders: Iterable[str | os.PathLike[str]]) -> Iterator[list[Path]]:
    """Yield a draft of each folder; the files of all go to their places, or none does."""
    with ExitStack() as stack:
        drafts = {stack.enter_context(_draft(Path(folder))): Path(folder) for folder in folders}
        yield list(drafts)
        with _undisturbed():
            _take_places(drafts)


@contextmanager
def _draft(folder: Path) -> Iterator[Path]:
    was_there = folder.is_dir()
    draft = folder / _mark()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        clear_left_over(folder)
        shutil.rmtree(draft, ignore_errors=True)
        _under_way.add(draft)
        draft.mkdir()
    except OSError as error:
        do = "name a folder that is yours"
        raise _cannot_be_written(folder, error, do) from error
    try:
        yield draft
    except OSError as error:
        if error.errno not in _FULL:
            raise
        raise _cannot_be_written(folder, error, "all is as it was; make room") from error
    finally:
        _drop(draft)
        if not was_there:
            with suppress(OSError):  # it stays where something is in it
                folder.rmdir()


def final(path: Path) -> Path:
    """Where a file of a draft goes in the end; any other path as it is."""
    return Path(*(part for part in path.parts if not _MARK.fullmatch(part) or "partial." in part))


def clear_left_over(folder: Path) -> None:
    """Remove from a folder what killed runs of this machine left half-written."""
    for path in folder.glob(".*.partial*"):
        mark = _MARK.fullmatch(path.name)
        if mark and mark[1] in (None, _MINE) and not _lives(int(mark[2])):
            _drop(path)


def drop_all() -> None:
    """Remove all that this process has half-written, as it ends now."""
    for path in list(_under_way):
        if path.name.startswith(_mark()):  # a fork has its parent's
            _drop(path)


def _drop(path: Path) -> None:
    with suppress(OSError):
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    _under_way.discard(path)


def _take_places(drafts: dict[Path, Path]) -> None:
    """Rename each file of each draft; where one cannot be, those before it come back."""
    places = {  # by resolved names, as two folders may be one
        path.resolve(): (folder / path.relative_to(draft), draft / f"old-{number}")
        for draft, folder in drafts.items()
        for number, path in enumerate(sorted(p for p in draft.rglob("*") if p.is_file()))
    }
    done: list[tuple[Path, Path]] = []
    for path, (place, kept) in places.items():
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            if place.is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(place))
            if place.exists():
                os.replace(place, kept)
            done.append((place, kept))
            os.replace(path, place)
        except OSError as error:
            for taken, before in reversed(done):
                os.replace(before, taken) if before.exists() else taken.unlink(missing_ok=True)
            raise _cannot_be_written(place, error, "all is as it was") from error


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Signals that end the program wait for the end of the block, where they can be held."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _HELD)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _cannot_be_written(path: Path, error: OSError, do: str) -> InFile:
    why = os.strerror(error.errno) if error.errno else str(error)
    return InFile(final(path), f"cannot be written: {why}", do=do)


def _lives(pid: int) -> bool:
    if os.name == "nt":
        return True  # where a signal 0 would end it
    try:
        os.kill(pid, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


def _mark() -> str:
    return f".{_MINE}-{os.getpid()}.partial"


def _beside(name: str) -> str:
    """The name with a mark before it; where that is too long, its checksum and its end."""
    mark = f"{_mark()}."
    if len(os.fsencode(mark + name)) > _LONGEST_NAME:
        name = f"{zlib.crc32(os.fsencode(name)):08x}{name[-_ENDING:]}"
    return mark + name
