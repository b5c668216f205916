"""Draft folders: what is written grows there, and takes its place by renames that can be finished.

A draft lies in the folder where its content goes and is locked (flock) while its writer lives:
what carries our mark and whose lock is free was left by a killed run. Where one rename puts all in
its place, that is all. Else the draft is first renamed to `.zerorate-switch`: from then on it is as
good as written, and whoever reads or writes there next finishes what was killed (`settle`).
"""

import errno
import json
import os
import re
import secrets
import shutil
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

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
_OTHERS = f"{_PREFIX}others"
_LEAD = f"{_PREFIX}lead"
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
        if not (draft / _LEAD).exists():  # else it may count as written already
            drop(draft)


def clear_left_over(folder: Path) -> None:
    """Finish the switch, and remove the drafts, that killed runs left in a folder."""
    settle(folder)
    others = [d for d in folder.glob(f"{_PREFIX}*.partial") if d not in _mine and _is_folder(d)]
    for draft in filter(lambda one: _MARK.fullmatch(one.name), others):
        with suppress(OSError), _left_over(draft) as is_left_over:
            if is_left_over and _is_of_no_switch(draft):
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
    """All files of the drafts take their places, or none. Raises OSError, and all is as it was."""
    moves = [move for draft in drafts for move in _moves(draft, draft.parent)]
    if len(moves) == 1:
        os.replace(*moves[0])
    elif moves:
        _switch(drafts, moves)


def _switch(drafts: Sequence[Path], moves: list[_Move]) -> None:
    lead, *others = drafts
    for draft in others:
        (draft / _LEAD).write_text(json.dumps(os.fspath(lead.parent.resolve())))
    (lead / _OTHERS).write_text(json.dumps([os.fspath(d.resolve()) for d in others]))
    (lead / _OLD).mkdir()
    olds = [_kept(place, lead / _OLD / str(n)) for n, (_, place) in enumerate(moves)]
    switch = _committed(lead)
    moves = [(_within(path, lead, switch), place) for path, place in moves]
    done: list[int] = []
    try:
        for n in reversed(range(len(moves))):  # the lead's last: while it is there, all is written
            _replace(*moves[n])
            done.append(n)
    except OSError:
        for n in reversed(done):
            path, place = moves[n]
            os.replace(place, path)
            if olds[n]:
                os.replace(switch / _OLD / str(n), place)
        os.rename(switch, lead)
        raise
    with suppress(FileNotFoundError):  # where there are no locks, another has finished it
        os.rename(switch, lead)


def _replace(path: Path, place: Path) -> None:
    try:
        os.replace(path, place)
    except FileNotFoundError:  # where there are no locks, another may have done it
        if os.path.lexists(path) or not os.path.lexists(place):
            raise


def _within(path: Path, lead: Path, switch: Path) -> Path:
    return switch / path.relative_to(lead) if path.is_relative_to(lead) else path


def _kept(place: Path, old: Path) -> bool:
    """Whether there is a file in the place, which has then got a second name."""
    if not os.path.lexists(place):
        return False
    try:
        os.link(place, old, follow_symlinks=False)
    except (OSError, NotImplementedError):  # a file system without links, or another one
        shutil.copy2(place, old, follow_symlinks=False)
    return True


def _committed(lead: Path) -> Path:
    """Where the draft lies from now on: what is in it counts as written."""
    switch = lead.parent / _SWITCH
    while True:
        settle(lead.parent)
        try:
            os.rename(lead, switch)
            return switch
        except OSError as error:
            if error.errno not in _TAKEN:
                raise


def _finish(switch: Path) -> None:
    for draft in (*_others(switch), switch):
        for path, place in _moves(draft, draft.parent):
            _replace(path, place)
    done = _new_name(switch.parent)
    os.rename(switch, done)
    shutil.rmtree(done, ignore_errors=True)


def _others(switch: Path) -> Iterator[Path]:
    """The drafts that are of one switch with this one, by what both say."""
    mine = os.fspath(switch.parent.resolve())
    for name in _said(switch / _OTHERS) or []:
        draft = Path(name)
        if _MARK.fullmatch(draft.name) and _is_folder(draft) and _said(draft / _LEAD) == mine:
            yield draft


def _is_of_no_switch(draft: Path) -> bool:
    """Whether nobody counts the draft as written, its lead's switch being finished first."""
    lead = _said(draft / _LEAD)
    if lead is None:
        return True
    try:
        settle(Path(lead))
    except InFile:
        return False
    return Path(lead).is_dir()


def _said(file: Path) -> Any:
    try:
        return json.loads(file.read_bytes())
    except (OSError, ValueError):
        return None


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
