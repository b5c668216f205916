"""Outputs appear whole or not at all, a file or a folder of them."""

import errno
import os
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from os.path import realpath
from pathlib import Path
from tempfile import TemporaryFile

from ..ending import undisturbed
from ..errors import InFile
from .drafts import clear_left_over, drop, is_draft, make_draft, put_in_place

_LONGEST_NAME = 255
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS)
_Path = str | os.PathLike[str]


@contextmanager
def written_beside(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a file of the same name in a draft, renamed onto `path` when the block ends well.

    Else it is deleted. What killed runs left half-written in the folder goes. Raises InFile if the
    folder does not exist or cannot be written, or has no room.
    """
    with all_written_beside([path]) as temporaries:
        yield temporaries[0]


@contextmanager
def all_written_beside(paths: Iterable[str | os.PathLike[str]]) -> Iterator[list[Path]]:
    """As written_beside, of several files: all of them take their places, or none does."""
    places = [Path(path) for path in paths]
    first = next(iter(places), Path())
    drafts: dict[Path, Path] = {}
    with ExitStack() as stack:
        for place in places:
            check_name(place)
            if place.parent not in drafts:
                draft = _draft(place.parent, place, "name a folder that exists and is yours")
                drafts[place.parent] = stack.enter_context(draft)
        temporaries = [drafts[place.parent] / place.name for place in places]
        with no_room_said(first, "make room, or name another folder"):
            for temporary in temporaries:
                temporary.touch()
            yield temporaries
            _put_in_place(list(drafts.values()), first)


def check_name(path: Path) -> None:
    """Raise InFile if the name is too long for a file."""
    if len(os.fsencode(path.name)) > _LONGEST_NAME:
        problem = f"the name is longer than {_LONGEST_NAME} bytes"
        raise InFile(path, problem, do="give it a shorter one")


def check_room_for(path: Path) -> None:
    """Raise InFile if no file can be made in its folder."""
    try:
        TemporaryFile(dir=path.parent).close()
    except OSError as error:
        raise _cannot_be_written(path, error, "name a folder that is yours") from error


def check_apart(outputs: Iterable[_Path | None], inputs: Iterable[_Path | None]) -> None:
    """Raise InFile if an output is a file that is read, too, or two outputs are one; None: none."""
    read = {realpath(path) for path in inputs if path is not None}
    written: set[str] = set()
    for path in outputs:
        if path is None:
            continue
        place = realpath(path)
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
    """Yield a draft of each folder; the files of all go to their places, or none does.

    One rename decides: a program killed before it has written nothing, one killed after it has
    written all, which the next that reads or writes there finishes (`drafts.settle`).
    """
    wanted = [Path(folder) for folder in folders]
    drafts: dict[Path, Path] = {}
    within = []
    with ExitStack() as stack:
        for folder in wanted:
            there = _lowest_there(folder)
            if there.resolve() not in drafts:
                draft = _draft(there, folder, "name a folder that is yours")
                drafts[there.resolve()] = stack.enter_context(draft)
            within.append(drafts[there.resolve()] / folder.relative_to(there))
        with no_room_said(wanted[0], "all is as it was; make room"):
            for inside in within:
                inside.mkdir(parents=True, exist_ok=True)
            yield within
            _put_in_place(list(drafts.values()), wanted[0])


def _lowest_there(folder: Path) -> Path:
    """The folder itself, or the lowest above it that there is. Raises InFile for a file."""
    there = next((f for f in (folder, *folder.parents) if os.path.lexists(f)), Path())
    if not there.is_dir():
        raise InFile(folder, f"cannot be written: {there} is no folder", do="name another folder")
    return there


@contextmanager
def _draft(folder: Path, shown: Path, do: str) -> Iterator[Path]:
    try:
        clear_left_over(folder)
        draft = make_draft(folder)
    except OSError as error:
        raise _cannot_be_written(shown, error, do) from error
    try:
        yield draft
    finally:
        drop(draft)


@contextmanager
def no_room_said(path: Path, do: str) -> Iterator[None]:
    """Raise InFile, of the path, where a disk takes no more within the block."""
    try:
        yield
    except OSError as error:
        if error.errno not in _FULL:
            raise
        raise _cannot_be_written(path, error, do) from error


def _put_in_place(drafts: list[Path], path: Path) -> None:
    try:
        with undisturbed():
            put_in_place(drafts)
    except OSError as error:
        place = Path(error.filename2 or error.filename or path)
        raise _cannot_be_written(place, error, "all is as it was") from error


def final(path: Path) -> Path:
    """Where a file of a draft goes in the end; any other path as it is."""
    return Path(*(part for part in path.parts if not is_draft(part)))


def _cannot_be_written(path: Path, error: OSError, do: str) -> InFile:
    why = os.strerror(error.errno) if error.errno else str(error)
    return InFile(final(path), f"cannot be written: {why}", do=do)
