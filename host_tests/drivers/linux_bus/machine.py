"""The recorder on a real Linux kernel's I2C bus, emulated: Debian 13's kernel and QEMU.

python -m host_tests.drivers.linux_bus.machine fetches them, runs guest.py and prints what it found.
The guest is the host's file tree, mounted read-only by 9p, under a kernel that has /dev/i2c-0: the
i2c-stub module, 256 registers at one address, answering SMBus but no raw I2C. Emulated (TCG), so
no right on /dev/kvm is needed.
"""

import json
import lzma
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.runtimes import unix_port
from zerorate_tools.runtimes.runtime import fill, runtime_folder

NAME = "linux-bus-debian13"
_PACKAGES = ("qemu-system-x86", "busybox-static", "linux-image-amd64")
_MODULES = ("virtio_pci", "9pnet_virtio", "9p", "i2c-dev", "i2c-stub")
_HERE = Path(__file__).parent
_TIME_LIMIT_S = 900


def folder() -> Path:
    """Where the machine is kept, whether it is there or not."""
    return runtime_folder(NAME)


def fetch() -> Path:
    """Fetch the machine (about 150 MB, 40 MB kept); MissingRuntime says why it cannot be had."""
    return fill(folder(), _build)


def run_guest(rate_hz: float = 25, seconds: float = 4) -> dict:
    """What came of guest.py: rows, those that are false or out of order, and samples lost.

    Raises MissingRuntime when the machine has not been fetched, ZerorateError with the end of the
    console's text when the guest came to no result.
    """
    folders = ("tools", "drivers", "firmware", "host_tests/fakes")
    path = ":".join(str(_HERE.parents[2] / folder) for folder in folders)
    guest = shlex.join([sys.executable, str(_HERE / "guest.py"), str(rate_hz), str(seconds)])
    settings = f"PYTHONPATH={shlex.quote(path)} PYTHONDONTWRITEBYTECODE=1"
    console = _boot(f"{settings} {guest} 2>&1 | cat\n")
    if found := re.search("^RESULT (.*)$", console, re.MULTILINE):
        return json.loads(found[1])
    last = " | ".join(line for line in console.splitlines()[-6:] if line)
    raise ZerorateError(f"the emulated Linux machine came to no result: {last}")


def _boot(command: str) -> str:
    """Boot, run a shell command in the host's tree as root and power off; the console's text."""
    root = folder()
    if not root.is_dir():
        do = "python -m host_tests.drivers.linux_bus.machine fetches it"
        raise MissingRuntime(f"the emulated Linux bus is not there: {do}")
    with tempfile.TemporaryDirectory(prefix="zerorate-boot-") as scratch:
        tree, initramfs = Path(scratch, "tree"), Path(scratch, "initramfs.cpio")
        tree.mkdir()
        initramfs.write_bytes(_initramfs(root, tree, command))
        done = subprocess.run(
            _qemu(root, initramfs),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_TIME_LIMIT_S,
        )
    return done.stdout.decode(errors="replace").replace("\r\n", "\n")


def _build(target: Path) -> None:
    if unix_port.host_architecture() != "amd64":
        raise MissingRuntime("the emulated Linux bus needs an x86-64 machine")
    with tempfile.TemporaryDirectory(prefix="zerorate-debs-") as scratch:
        for deb in _debs(Path(scratch)):
            kernel = deb.name.startswith("linux-image")
            unix_port.unpack(deb, Path(scratch, "kernel") if kernel else target)
        _keep_kernel(Path(scratch, "kernel"), target)


def _debs(folder: Path) -> list[Path]:
    """The packages and all they depend on, as for a machine that has none installed yet."""
    options = unix_port._second_configuration(folder, "amd64")
    unix_port._apt([*options, "update"])
    wanted = ["install", "--yes", "--download-only", "--no-install-recommends", *_PACKAGES]
    unix_port._apt([*options, *wanted])
    return sorted(folder.glob("cache/archives/*.deb"))


def _keep_kernel(unpacked: Path, target: Path) -> None:
    """The kernel and the few modules used, uncompressed and in the order in which they load."""
    shutil.copy(next(unpacked.glob("boot/vmlinuz-*")), target / "vmlinuz")
    compressed = {_plain(path): path for path in unpacked.rglob("*.ko*")}
    order: list[str] = []
    for name in _MODULES:
        _add_module(_plain(Path(name)), compressed, target, order)
    (target / "modules.order").write_text("\n".join(order) + "\n")


def _add_module(name: str, files: dict[str, Path], target: Path, order: list[str]) -> None:
    if name in order or name not in files:  # not there: built into the kernel
        return
    packed = files[name].read_bytes()
    module = lzma.decompress(packed) if files[name].suffix == ".xz" else packed
    for needed in _depends(module):
        _add_module(needed, files, target, order)
    (target / f"{name}.ko").write_bytes(module)
    order.append(name)


def _depends(module: bytes) -> list[str]:
    start = module.find(b"\0depends=")
    listed = module[start + 9 : module.index(b"\0", start + 9)].decode() if start >= 0 else ""
    return [name.replace("-", "_") for name in listed.split(",") if name]


def _plain(path: Path) -> str:
    return path.name.split(".ko")[0].replace("-", "_")


def _qemu(root: Path, initramfs: Path) -> list[str]:
    libraries = root / "usr/lib/x86_64-linux-gnu"
    share = "local,id=host,path=/,security_model=none,readonly=on,multidevs=remap"
    return [
        *(str(libraries / "ld-linux-x86-64.so.2"), "--library-path", str(libraries)),
        str(root / "usr/bin/qemu-system-x86_64"),
        *("-L", str(root / "usr/share/seabios"), "-L", str(root / "usr/share/qemu")),
        *("-accel", "tcg", "-cpu", "max", "-smp", "1", "-m", "1024", "-nographic", "-no-reboot"),
        *("-nic", "none", "-kernel", str(root / "vmlinuz"), "-initrd", str(initramfs)),
        *("-append", "console=ttyS0 quiet panic=-1 mitigations=off"),
        *("-fsdev", share, "-device", "virtio-9p-pci,fsdev=host,mount_tag=host"),
    ]


def _initramfs(root: Path, folder: Path, command: str) -> bytes:
    """The archive of what runs before the host's tree is there, made in an empty folder."""
    for name in ("bin", "host", "proc", "dev"):
        (folder / name).mkdir()
    shutil.copy(_HERE / "init.sh", folder / "init")
    (folder / "init").chmod(0o755)
    (folder / "command").write_text(command)
    busybox = root / "usr/bin/busybox"
    shutil.copy(busybox, folder / "bin")
    for path in [*root.glob("*.ko"), root / "modules.order"]:
        shutil.copy(path, folder)
    names = "".join(f"{path.relative_to(folder)}\n" for path in sorted(folder.rglob("*")))
    pack = [busybox, "cpio", "-o", "-H", "newc"]
    done = subprocess.run(pack, cwd=folder, input=names.encode(), capture_output=True, check=True)
    return done.stdout


if __name__ == "__main__":
    fetch()
    print(json.dumps(run_guest(), indent=2))
