"""Draft folders: what is written grows there, and takes its place by renames that can be finished.

A draft lies in the folder where its content goes and is locked (flock) while its writer lives:
what carries our mark and whose lock is free was left by a killed run. Where one rename puts all in
its place, that is all. Else the draft is first renamed to `.zerorate-switch`: from then on it is as
good as written, and whoever reads or writes there next finishes what was killed (`settle`).
"""

import errno
import os
import re
import secrets
import shutil
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from ..ending import undisturbed
from ..errors import InFile

try:
    import fcntl
except ImportError:  # Windows: what a killed run left stays
    fcntl = None  # type: ignore[assignment]

_PREFIX = ".zerorate-"
_MARK = re.compile(r"\.zerorate-[0-9a-f]{16}\.partial")
_SWITCH = f"{_PREFIX}switch"
_OLD = f"{_PREFIX}old"
_PATIENCE_S = 10.0
_TAKEN = (errno.ENOTEMPTY, errno.EEXIST)
_Move = tuple[Path, Path]
_mine: dict[Path, int | None] = {}
if hasattr(os, "register_at_fork"):  # a fork has its parent's
    os.register_at_fork(after_in_child=_mine.clear)


def is_draft(name: str) -> bool:
    """Whether a folder of this name is a draft."""
    return _MARK.fullmatch(name) is not None or name == _SWITCH


def make_draft(folder: Path) -> Path:
    """A new draft in the folder, locked, to be given to drop() in the end. Raises OSError."""
    while True:
        draft = _new_name(folder)
        with undisturbed():  # a signal's end removes what is noted in _mine
            draft.mkdir()
            with suppress(FileNotFoundError, BlockingIOError):  # cleaned away before it was locked
                held = _lock(draft)
                if held is None or os.path.samestat(os.stat(draft), os.fstat(held)):
                    _mine[draft] = held
                    return draft


def drop(draft: Path) -> None:
    """Remove a draft of this process with all that is still in it."""
    shutil.rmtree(draft, ignore_errors=True)
    held = _mine.pop(draft, None)
    if held is not None:
        os.close(held)


def drop_all() -> None:
    """Remove all that this process has half-written, as it ends now."""
    for draft in list(_mine):
        drop(draft)


def clear_left_over(folder: Path) -> None:
    """Finish the switch, and remove the drafts, that killed runs left in a folder."""
    settle(folder)
    others = [d for d in folder.glob(f"{_PREFIX}*.partial") if d not in _mine and _is_folder(d)]
    for draft in filter(lambda one: _MARK.fullmatch(one.name), others):
        with suppress(OSError), _left_over(draft) as is_left_over:
            if is_left_over:
                shutil.rmtree(draft, ignore_errors=True)


def settle(folder: Path) -> None:
    """Finish a switch that a killed run began in the folder: call before files are read together.

    Raises InFile if it cannot be finished.
    """
    switch = folder / _SWITCH
    until = time.monotonic() + _PATIENCE_S
    while _is_folder(switch):
        try:
            with _left_over(switch) as is_left_over:
                if is_left_over:
                    _finish(switch)
                elif time.monotonic() > until:
                    raise TimeoutError(errno.ETIMEDOUT, "another program is at it")
        except FileNotFoundError:  # another has finished it
            return
        except OSError as error:
            problem = f"its files were being replaced, which cannot be finished: {error.strerror}"
            raise InFile(folder, problem, do="make it writable, then read it again") from error
        time.sleep(0.01)


def put_in_place(drafts: Sequence[Path]) -> None:
    """All files of the drafts take their places, those of a draft together.

    Raises OSError, before anything is moved where a place can be seen to be none for a file.
    """
    every = [(draft, _moves(draft, draft.parent)) for draft in drafts]
    for draft, moves in every:
        if len(moves) == 1:
            os.replace(*moves[0])
        elif moves:
            _switch(draft, moves)


def _switch(draft: Path, moves: list[_Move]) -> None:
    (draft / _OLD).mkdir()
    olds = [_kept(place, draft / _OLD / str(n)) for n, (_, place) in enumerate(moves)]
    switch = _committed(draft)
    moves = [(switch / path.relative_to(draft), place) for path, place in moves]
    done: list[int] = []
    try:
        for n, move in enumerate(moves):
            _replace(*move)
            done.append(n)
    except OSError:
        for n in reversed(done):
            path, place = moves[n]
            os.replace(place, path)
            if olds[n]:
                os.replace(switch / _OLD / str(n), place)
        os.rename(switch, draft)
        raise
    with suppress(FileNotFoundError):  # where there are no locks, another has finished it
        os.rename(switch, draft)


def _replace(path: Path, place: Path) -> None:
    try:
        os.replace(path, place)
    except FileNotFoundError:  # where there are no locks, another may have done it
        if os.path.lexists(path) or not os.path.lexists(place):
            raise


def _kept(place: Path, old: Path) -> bool:
    """Whether there is a file in the place, which has then got a second name."""
    if not os.path.lexists(place):
        return False
    try:
        os.link(place, old, follow_symlinks=False)
    except (OSError, NotImplementedError):  # a file system without links, or another one
        shutil.copy2(place, old, follow_symlinks=False)
    return True


def _committed(draft: Path) -> Path:
    """Where the draft lies from now on: what is in it counts as written."""
    switch = draft.parent / _SWITCH
    while True:
        settle(draft.parent)
        try:
            os.rename(draft, switch)
            return switch
        except OSError as error:
            if error.errno not in _TAKEN:
                raise


def _finish(switch: Path) -> None:
    for path, place in _moves(switch, switch.parent):
        _replace(path, place)
    done = _new_name(switch.parent)
    os.rename(switch, done)
    shutil.rmtree(done, ignore_errors=True)


def _moves(draft: Path, folder: Path) -> list[_Move]:
    """(from, to) of the fewest renames that put all of a draft in its place. Raises OSError."""
    found: list[_Move] = []
    for path in sorted(draft.iterdir()):
        place = folder / path.name
        if path.name.startswith(_PREFIX):
            continue
        if _is_folder(path) and place.is_dir():
            found += _moves(path, place)
            continue
        if place.is_dir() or (_is_folder(path) and os.path.lexists(place)):
            number = errno.EISDIR if place.is_dir() else errno.ENOTDIR
            raise OSError(number, os.strerror(number), os.fspath(place))
        if place.exists() and not place.is_file():
            number = errno.EOPNOTSUPP  # a device, a pipe: what is not written but replaced
            raise OSError(number, os.strerror(number), os.fspath(place))
        found.append((path, place))
    return found


@contextmanager
def _left_over(draft: Path) -> Iterator[bool]:
    """Whether the draft's writer is gone; it is locked within the block."""
    try:
        held = _lock(draft)
    except BlockingIOError:
        yield False
        return
    try:
        # without locks a switch can be finished by two, a draft must be left alone
        there = held is None or os.path.samestat(os.stat(draft), os.fstat(held))
        yield there and (held is not None or draft.name == _SWITCH)
    finally:
        if held is not None:
            os.close(held)


def lock(descriptor: int) -> bool:
    """Lock an open file or folder until it is closed; whether there are locks here.

    Raises BlockingIOError where another has it.
    """
    try:
        if fcntl is not None:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError:  # a file system without them
        return False
    return fcntl is not None


def _lock(folder: Path) -> int | None:
    """A descriptor that holds the folder's lock until it is closed; None where there are no locks.

    Raises BlockingIOError where another has it.
    """
    if fcntl is None:
        return None
    descriptor, held = os.open(folder, os.O_RDONLY), False
    try:
        held = lock(descriptor)
    finally:
        if not held:
            os.close(descriptor)
    return descriptor if held else None


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _new_name(folder: Path) -> Path:
    return folder / f"{_PREFIX}{secrets.token_hex(8)}.partial"
