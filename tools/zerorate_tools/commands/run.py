"""`zerorate run`: the firmware as a service of a Linux board."""

import argparse
import errno
import sys
from pathlib import Path
from typing import Any


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "run",
        help="correct for ever on a Linux board, as a service",
        description="Read the chip, learn its bias at rest, keep what is learned, and publish the "
        "corrected samples as lines of JSON: on standard output, a Unix socket, or by UDP. A line "
        "has rate_dps without bias, raw_dps with it, bias_dps, accel_g, temp_degc, and t_us since "
        "the start; gap_us where samples are missing before it. `zerorate import` reads them.",
    )
    parser.add_argument("bus", metavar="BUS", help="/dev/i2c-1, or fake: for an emulated chip")
    parser.add_argument(
        "--state", type=Path, metavar="FILE", default=Path("learned.bin"), help="what was learned"
    )
    parser.add_argument("--socket", type=Path, metavar="FILE", help="Unix socket for readers")
    parser.add_argument("--udp", metavar="HOST:PORT", help="datagrams, to this machine only")
    parser.add_argument("--metrics", metavar="HOST:PORT", help="metrics for Prometheus")
    what = "let --udp and --metrics leave this machine"
    parser.add_argument("--remote", action="store_true", help=what)
    for flag, dest, kind, default, what in (
        ("--address", "address", lambda text: int(text, 0), 0x68, "of the chip (0x68)"),
        ("--hz", "odr_hz", float, 100.0, "output data rate (100)"),
        ("--dps", "full_scale_dps", int, 250, "250, 500, 1000 or 2000"),
        ("--g", "full_scale_g", int, 2, "2, 4, 8 or 16"),
        ("--dlpf-hz", "dlpf_hz", float, None, "the chip's low-pass filter (by --hz)"),
    ):
        parser.add_argument(flag, dest=dest, type=kind, default=default, metavar="N", help=what)
    parser.add_argument("--part", metavar="NAME", help="the chip, where its id says too little")
    parser.add_argument("--model", type=Path, metavar="FILE", help="effect model to subtract")
    parser.set_defaults(run=run)


#: What opening says of a path that is something else, and stays so.
_NO_BUS = (errno.ENOTTY, errno.EISDIR, errno.ENOTDIR)


def run(arguments: argparse.Namespace) -> None:
    import signal
    import time

    from zerorate.storage.places import FileStorage
    from zerorate_i2c import clock
    from zerorate_i2c.linux import LinuxI2C
    from zerorate_i2c.mpu6050 import MPU6050

    from ..errors import InFile, ZerorateError
    from ..service import Datagrams, FakeBus, Lines, Metrics, Service, Sink, System, UnixSocket

    if not arguments.state.parent.is_dir():
        raise InFile(arguments.state.parent, "no such folder", do="make it, or name another")
    names = ("odr_hz", "full_scale_dps", "full_scale_g", "dlpf_hz", "part")
    options = {name: getattr(arguments, name) for name in names}
    model = _model_bytes(arguments.model) if arguments.model else b""
    fake = FakeBus(arguments.address, arguments.part) if arguments.bus == "fake:" else None

    def open_bus() -> Any:
        try:
            return LinuxI2C(arguments.bus)
        except OSError as error:
            # a bus comes back by its name beneath /dev alone
            gone = error.errno == errno.ENOENT and not arguments.bus.startswith("/dev/")
            if error.errno not in _NO_BUS and not gone:
                raise
            do = "`ls /dev/i2c-*` says which there are"
            raise ZerorateError(f"{arguments.bus}: no I2C bus; {do}") from error

    def open_imu() -> MPU6050:
        bus = fake or open_bus()
        try:
            return MPU6050(bus, arguments.address, **options)
        except ValueError as error:
            raise ZerorateError(str(error)) from error
        except OSError:
            bus.close()
            raise

    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    def stored_ago_s() -> float:
        return time.time() - arguments.state.stat().st_mtime

    sinks: list[Sink] = []
    if arguments.udp:
        sinks.append(Datagrams(arguments.udp, arguments.remote))
    if arguments.metrics:
        sinks.append(Metrics(arguments.metrics, arguments.remote))
    if arguments.socket:  # last: it leaves a file where another is refused
        sinks.append(UnixSocket(arguments.socket))
    # systemd ends a service with SIGTERM; Ctrl-C and it do the same
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    storage = FileStorage(str(arguments.state))
    system = System(open_imu, storage, clock, say, stored_ago_s=stored_ago_s)
    Service(system, sinks or [Lines(sys.stdout)], model).run()


def _model_bytes(path: Path) -> bytes:
    """The bytes of model.bin, which need no library; those of its readable twin need tools."""
    if path.suffix != ".json":
        return path.read_bytes()
    from ..model import encoded, read_model

    return encoded(read_model(path))
