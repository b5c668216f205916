"""MicroPython 1.25 of Debian 13, each architecture in its own folder with its own C library.

Packages are fetched and unpacked into a folder: nothing of the system is changed. A second apt
configuration is made from the machine's own Debian source with the suite replaced, so the mirror,
proxies and certificates are those that the machine already uses. A mirror may serve an
architecture's list that its release file does not know; debian13.sha256 pins what the interpreters
of other architectures need, for that case.
"""

import platform
import re
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes.runtime import UnixPort

from .runtime import fill, runtime_folder

_PACKAGES = (
    *("micropython", "libc6", "libffi8", "libmbedcrypto16", "libmbedtls21", "libmbedx509-7"),
    "libgcc-s1",
)
ARCHITECTURES = {"x86": "i386", "armhf": "armhf", "x64": "amd64"}
_LOADERS = {
    "x86": "usr/lib/i386-linux-gnu/ld-linux.so.2",
    "x64": "usr/lib/x86_64-linux-gnu/ld-linux-x86-64.so.2",
}
_QEMU = "usr/bin/qemu-arm"
_SUITE = "trixie"
_KEYRING = "/usr/share/keyrings/debian-archive-keyring"
_PINNED = Path(__file__).with_name("debian13.sha256")
_APT_HELPER = "/usr/lib/apt/apt-helper"


def find_unix_port(name: str) -> UnixPort:
    """The fetched interpreter `x86`, `armhf` or `x64`. Raises MissingRuntime."""
    folder = _folder(name)
    if not folder.is_dir():
        raise MissingRuntime(f"the {name} interpreter is not fetched yet")
    if name == "armhf":
        launcher = (qemu_arm(), "-L", str(folder))
    else:
        loader = folder / _LOADERS[name]
        launcher = (str(loader), "--library-path", str(loader.parent))
    return UnixPort(name, folder / "usr/bin/micropython", launcher)


def fetch_unix_port(name: str) -> None:
    """Fetch and unpack `x86`, `armhf` (with qemu-arm if the system has none) or `x64`."""
    if name != "armhf" and host_architecture() != "amd64":
        raise MissingRuntime(f"{name} runs on x86-64 machines only")
    fill(_folder(name), lambda folder: _fetch_interpreter(folder, ARCHITECTURES[name]))
    if name == "armhf" and not shutil.which("qemu-arm"):
        fill(_folder("qemu-arm"), _fetch_qemu)


def _fetch_interpreter(folder: Path, architecture: str) -> None:
    with tempfile.TemporaryDirectory(prefix="zerorate-deb-") as download:
        for deb in fetch_packages(Path(download), architecture, _PACKAGES):
            unpack(deb, folder)
    (folder / "lib").symlink_to("usr/lib")  # where a program says that its loader is


def _fetch_qemu(folder: Path) -> None:
    with tempfile.TemporaryDirectory(prefix="zerorate-deb-") as download:
        (deb,) = fetch_packages(Path(download), host_architecture(), ["qemu-user"])
        # The package holds every emulated machine; one is wanted.
        unpack_one(deb, _QEMU, folder)


def _folder(name: str) -> Path:
    return runtime_folder(f"{name}-debian13")


def qemu_arm() -> str:
    """What runs armhf programs: the system's, else the fetched one. Raises MissingRuntime."""
    own = _folder("qemu-arm") / _QEMU
    qemu = shutil.which("qemu-arm") or (str(own) if own.is_file() else None)
    if qemu is None:
        raise MissingRuntime("qemu-arm, which runs armhf programs, is missing")
    return qemu


def fetch_packages(folder: Path, architecture: str, packages: Sequence[str]) -> list[Path]:
    """Download packages (no dependencies) into `folder` and return the .deb files, checked by apt.

    Raises MissingRuntime when this machine has no apt or no Debian source, or apt fails.
    """
    mirror = _own_mirror()
    try:
        _download_listed(folder, architecture, packages)
    except MissingRuntime:
        pinned = _pinned(architecture)
        if set(packages) - set(pinned):
            raise
        for sha256, path in map(pinned.__getitem__, packages):
            uri, target = f"{mirror}/{path}", str(folder / Path(path).name)
            _output_of([_APT_HELPER, "download-file", uri, target, f"SHA256:{sha256}"])
    return sorted(folder.glob("*.deb"))


def unpack(deb: Path, folder: Path) -> None:
    """Unpack a package's files below `folder`, without installing it."""
    _output_of(["dpkg-deb", "-x", str(deb), str(folder)])


def unpack_one(deb: Path, name: str, folder: Path) -> None:
    """Unpack the one file `name` of a large package below `folder`."""
    with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", deb], stdout=subprocess.PIPE) as source:
        subprocess.run(["tar", "-x", "-C", folder, f"./{name}"], stdin=source.stdout)
    if not (folder / name).is_file():
        raise MissingRuntime(f"{deb.name} holds no {name}")


def host_architecture() -> str:
    """Debian's name of this machine's architecture. Raises MissingRuntime off Linux."""
    names = {"x86_64": "amd64", "aarch64": "arm64"}
    if platform.system() != "Linux" or platform.machine() not in names:
        raise MissingRuntime("only Linux on x86-64 or arm64 can run Debian's packages")
    return names[platform.machine()]


def _download_listed(folder: Path, architecture: str, packages: Sequence[str]) -> None:
    with tempfile.TemporaryDirectory(prefix="zerorate-apt-") as state:
        options = _second_configuration(Path(state), architecture)
        _apt([*options, "update"], cwd=folder)
        _apt([*options, "download", *packages], cwd=folder)


def _pinned(architecture: str) -> dict[str, tuple[str, str]]:
    """SHA-256 and path below the mirror of every pinned package of an architecture, by name."""
    lines = [line.split() for line in _PINNED.read_text(encoding="utf-8").splitlines()]
    wanted = [(sha, path) for sha, path in lines if path.endswith(f"_{architecture}.deb")]
    return {Path(path).name.split("_")[0]: (sha, path) for sha, path in wanted}


def _second_configuration(state: Path, architecture: str) -> list[str]:
    for name in ("lists/partial", "cache/archives/partial"):
        (state / name).mkdir(parents=True)
    (state / "status").touch()
    (state / "own.sources").write_text(_source(_own_mirror()), encoding="utf-8")
    settings = {
        "Dir::Etc::SourceList": state / "own.sources",
        "Dir::Etc::SourceParts": "/dev/null",
        "Dir::State::Lists": state / "lists",
        "Dir::State::Status": state / "status",
        "Dir::Cache": state / "cache",
        "APT::Architecture": architecture,
        "APT::Architectures": architecture,
        "APT::Sandbox::User": "root",
        "Acquire::Languages": "none",
    }
    return [part for key, value in settings.items() for part in ("-o", f"{key}={value}")]


def _source(mirror: str) -> str:
    stanza = f"Types: deb\nURIs: {mirror}\nSuites: {_SUITE}\nComponents: main\n"
    keyring = next((p for p in (f"{_KEYRING}.gpg", f"{_KEYRING}.pgp") if Path(p).is_file()), None)
    return stanza + (f"Signed-By: {keyring}\n" if keyring else "")


def _own_mirror() -> str:
    """The mirror of the machine's own release, as apt itself reads its sources."""
    codename = _debian_codename()
    listed = _apt(["--print-uris", "update"])
    for mirror in re.findall(rf"'(\S+)/dists/{codename}/InRelease'", listed):
        if f"{mirror}/dists/{codename}/main/" in listed:
            return mirror
    raise MissingRuntime(f"apt has no source for Debian {codename} main on this machine")


def _debian_codename() -> str:
    try:
        release = platform.freedesktop_os_release()
    except OSError:
        release = {}
    if release.get("ID") != "debian" or not release.get("VERSION_CODENAME"):
        raise MissingRuntime("this machine is not Debian, whose package source would be used")
    return release["VERSION_CODENAME"]


def _apt(arguments: Sequence[str], cwd: Path | None = None) -> str:
    return _output_of(["apt-get", "--quiet", *arguments], cwd)


def _output_of(command: Sequence[str], cwd: Path | None = None) -> str:
    if not shutil.which(command[0]):
        raise MissingRuntime(f"{command[0]} is missing: Debian's packages come through it")
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True)
    if done.returncode:
        errors = [line for line in done.stderr.splitlines() if line.startswith("E:")]
        said = errors or done.stderr.strip().splitlines() or ["no message"]
        raise MissingRuntime(f"{command[0]} failed: {said[0]}")
    return done.stdout
