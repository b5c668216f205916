"""Runs on the board while it is flashed: what is there, bytes written, folders put in place."""

import os
from binascii import a2b_base64

try:
    from binascii import crc32
except ImportError:
    crc32 = None  # type: ignore[assignment]


def is_folder(path: str) -> bool:
    """Whether there is a folder of this name."""
    try:
        return os.stat(path)[0] & 0x4000 != 0
    except OSError:
        return False


def tell(path: str) -> None:
    """Print (path, size, CRC-32) of a file, or of all files below a folder."""
    if is_folder(path):
        for entry in os.listdir(path):
            tell(path + "/" + entry)
        return
    try:
        size = os.stat(path)[6]
    except OSError:
        return
    print(repr((path, size, checksum(path))))


def checksum(path: str) -> int | None:
    """The CRC-32 of a file; None where the board cannot work it out."""
    if crc32 is None:
        return None
    crc = 0
    data = bytearray(256)
    with open(path, "rb") as file:
        while True:
            n = file.readinto(data)
            if not n:
                return crc & 0xFFFFFFFF
            crc = crc32(memoryview(data)[:n], crc)


def make_folders(path: str) -> None:
    """Make the folders that a file is in."""
    at = path.find("/")
    while at >= 0:
        if not is_folder(path[:at]):
            os.mkdir(path[:at])
        at = path.find("/", at + 1)


def put(path: str, text: str, mode: str) -> None:
    """Write what base64 text says to a file; mode: wb or ab."""
    with open(path, mode) as file:
        file.write(a2b_base64(text))


def copy(one: str, other: str) -> None:
    """Copy a file that is here already."""
    data = bytearray(256)
    with open(one, "rb") as source, open(other, "wb") as file:
        while True:
            n = source.readinto(data)
            if not n:
                return
            file.write(memoryview(data)[:n])


def remove(path: str) -> None:
    """Remove a file or a folder with all that is in it, if it is there."""
    if is_folder(path):
        for entry in os.listdir(path):
            remove(path + "/" + entry)
        os.rmdir(path)
    else:
        try:
            os.remove(path)
        except OSError:
            pass


def keep_only(folder: str, names: list[str]) -> None:
    """Remove the files below folder that are not among names."""
    if is_folder(folder):
        for entry in os.listdir(folder):
            path = folder + "/" + entry
            if is_folder(path):
                keep_only(path, names)
            elif path not in names:
                os.remove(path)


def put_in_place(new: str | None, package: str, library: str) -> None:
    """Make the folder new the package in library. At every moment one of them is whole.

    The new one first becomes a folder beside main.py, where it is found before the library.
    """
    if new is not None:
        os.rename(new, package)
    place = library + "/" + package
    remove(place)
    if not is_folder(library):
        os.mkdir(library)
    os.rename(package, place)


def replace(new: str, name: str) -> None:
    """Make the file new that of this name."""
    try:
        os.rename(new, name)
    except OSError:  # a FAT file system renames onto nothing
        remove(name)
        os.rename(new, name)
