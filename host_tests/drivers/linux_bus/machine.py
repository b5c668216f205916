"""Debian 13's kernel and QEMU in a folder of their own, and the command that boots them.

The guest is the host's file tree, mounted read-only by 9p, under a kernel that has /dev/i2c-0: the
i2c-stub module, 256 registers at one address, answering SMBus but no raw I2C. Emulated (TCG), so
no right on /dev/kvm is needed.
"""

import lzma
import shutil
import subprocess
import tempfile
from pathlib import Path

from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes import unix_port
from zerorate_tools.runtimes.runtime import fill, runtime_folder

NAME = "linux-bus-debian13"
_PACKAGES = ("qemu-system-x86", "busybox-static", "linux-image-amd64")
_MODULES = ("virtio_pci", "9pnet_virtio", "9p", "i2c-dev", "i2c-stub")
_INIT = Path(__file__).with_name("init.sh")


def folder() -> Path:
    """Where the machine is kept, whether it is there or not."""
    return runtime_folder(NAME)


def fetch() -> Path:
    """Fetch the machine (about 150 MB, 40 MB kept); MissingRuntime says why it cannot be had."""
    return fill(folder(), _build)


def boot(command: str, seconds: int) -> str:
    """Boot, run a shell command in the host's tree as root and power off; the console's text.

    MissingRuntime when the machine has not been fetched; subprocess.TimeoutExpired after seconds.
    """
    root = folder()
    if not root.is_dir():
        raise MissingRuntime(
            "the emulated Linux bus is not there: "
            "python -m host_tests.drivers.linux_bus.run fetches it"
        )
    with tempfile.TemporaryDirectory(prefix="zerorate-boot-") as scratch:
        initramfs = Path(scratch) / "initramfs.cpio"
        initramfs.write_bytes(_initramfs(root, command))
        done = subprocess.run(
            _qemu(root, initramfs), capture_output=True, timeout=seconds, stdin=subprocess.DEVNULL
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
        *("-accel", "tcg", "-cpu", "max", "-smp", "2", "-m", "1024", "-nographic", "-no-reboot"),
        *("-nic", "none", "-kernel", str(root / "vmlinuz"), "-initrd", str(initramfs)),
        *("-append", "console=ttyS0 quiet panic=-1 mitigations=off"),
        *("-fsdev", share, "-device", "virtio-9p-pci,fsdev=host,mount_tag=host"),
    ]


def _initramfs(root: Path, command: str) -> bytes:
    """A newc archive (Linux Documentation/driver-api/early-userspace/buffer-format.rst)."""
    files = {"init": _INIT.read_bytes(), "command": command.encode()}
    files["bin/busybox"] = (root / "usr/bin/busybox").read_bytes()
    for path in [*root.glob("*.ko"), root / "modules.order"]:
        files[path.name] = path.read_bytes()
    entries = [_entry(name, b"", 0o040755) for name in ("bin", "host", "proc", "dev")]
    entries += [_entry(name, data, 0o100755) for name, data in files.items()]
    return b"".join([*entries, _entry("TRAILER!!!", b"", 0)])


def _entry(name: str, data: bytes, mode: int) -> bytes:
    path = name.encode() + b"\0"
    fields = [0, mode, 0, 0, 1, 0, len(data), 0, 0, 0, 0, len(path), 0]
    head = b"070701" + b"".join(b"%08X" % field for field in fields) + path
    return head + b"\0" * (-len(head) % 4) + data + b"\0" * (-len(data) % 4)
