"""MicroPython 1.25 of Debian 13, each architecture in its own folder with its own C library."""

import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes.cache import fill, runtime_folder
from zerorate_tools.runtimes.debian import fetch_packages, host_architecture, unpack, unpack_one
from zerorate_tools.runtimes.runtime import UnixPort

_PACKAGES = (
    *("micropython", "libc6", "libffi8", "libmbedcrypto16", "libmbedtls21", "libmbedx509-7"),
    "libgcc-s1",
)
_ARCHITECTURES = {"x86": "i386", "armhf": "armhf", "x64": "amd64"}
_LOADERS = {
    "x86": "usr/lib/i386-linux-gnu/ld-linux.so.2",
    "x64": "usr/lib/x86_64-linux-gnu/ld-linux-x86-64.so.2",
}
_QEMU = "usr/bin/qemu-arm"


def find_unix_port(name: str) -> UnixPort:
    """The fetched interpreter `x86`, `armhf` or `x64`. Raises MissingRuntime."""
    folder = _folder(name)
    if not folder.is_dir():
        raise MissingRuntime(f"the {name} interpreter is not fetched yet")
    emulated = name == "armhf"
    launcher = (qemu_arm(), "-L", str(folder)) if emulated else _loader(folder / _LOADERS[name])
    return UnixPort(name, folder / "usr/bin/micropython", launcher)


def fetch_unix_port(name: str) -> None:
    """Fetch and unpack `x86`, `armhf` (with qemu-arm if the system has none) or `x64`."""
    if name != "armhf" and host_architecture() != "amd64":
        raise MissingRuntime(f"{name} runs on x86-64 machines only")
    fetch_folder(_folder(name).name, _ARCHITECTURES[name], _PACKAGES, link_lib=name == "armhf")
    if name == "armhf" and not shutil.which("qemu-arm"):
        fill(_qemu_folder(), _fetch_qemu)


def fetch_folder(
    name: str, architecture: str, packages: Sequence[str], link_lib: bool = False
) -> Path:
    """Unpack Debian 13 packages into the cache folder `name` unless it is there; return it.

    link_lib: add the link lib -> usr/lib, which a program's own loader path needs.
    """

    def build(folder: Path) -> None:
        with tempfile.TemporaryDirectory(prefix="zerorate-deb-") as download:
            for deb in fetch_packages(Path(download), architecture, packages):
                unpack(deb, folder)
        if link_lib:
            (folder / "lib").symlink_to("usr/lib")

    return fill(runtime_folder(name), build)


def _fetch_qemu(folder: Path) -> None:
    with tempfile.TemporaryDirectory(prefix="zerorate-deb-") as download:
        (deb,) = fetch_packages(Path(download), host_architecture(), ["qemu-user"])
        # The package holds every emulated machine; one is wanted.
        unpack_one(deb, _QEMU, folder)


def _folder(name: str) -> Path:
    return runtime_folder(f"{name}-debian13")


def _qemu_folder() -> Path:
    return runtime_folder("qemu-arm-debian13")


def _loader(loader: Path) -> tuple[str, ...]:
    return (str(loader), "--library-path", str(loader.parent))


def qemu_arm() -> str:
    """What runs armhf programs: the system's, else the fetched one. Raises MissingRuntime."""
    own = _qemu_folder() / _QEMU
    qemu = shutil.which("qemu-arm") or (str(own) if own.is_file() else None)
    if qemu is None:
        raise MissingRuntime("qemu-arm, which runs armhf programs, is missing")
    return qemu
