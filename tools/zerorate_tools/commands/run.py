"""`zerorate run`: the firmware as a service of a Linux board."""

import argparse
import sys
from pathlib import Path


def add_parser(subparsers) -> None:
    parser = subparsers.add_parser(
        "run",
        help="correct for ever on a Linux board, as a service",
        description="Read the chip, learn its bias at rest, keep what is learned, and publish the "
        "corrected samples as lines of JSON: on standard output, a Unix socket, or by UDP. A line "
        "has rate_dps without bias, bias_dps, accel_g, temp_degc, and t_us since the start.",
    )
    parser.add_argument("bus", metavar="BUS", help="I2C bus: /dev/i2c-1")
    parser.add_argument(
        "--state", type=Path, metavar="FILE", default=Path("learned.bin"), help="what was learned"
    )
    parser.add_argument("--socket", type=Path, metavar="FILE", help="Unix socket for readers")
    parser.add_argument("--udp", metavar="HOST:PORT", help="datagrams, to this machine only")
    parser.add_argument("--remote", action="store_true", help="let --udp leave this machine")
    for flag, dest, kind, default, what in (
        ("--address", "address", lambda text: int(text, 0), 0x68, "of the chip (0x68)"),
        ("--hz", "odr_hz", float, 100.0, "output data rate (100)"),
        ("--dps", "full_scale_dps", int, 250, "250, 500, 1000 or 2000"),
    ):
        parser.add_argument(flag, dest=dest, type=kind, default=default, metavar="N", help=what)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    import signal

    from zerorate.storage.places import FileStorage
    from zerorate_i2c import clock
    from zerorate_i2c.linux import LinuxI2C
    from zerorate_i2c.mpu6050 import MPU6050

    from ..errors import ZerorateError
    from ..service import Datagrams, Lines, Service, Sink, System, UnixSocket

    def open_imu():
        options = {name: getattr(arguments, name) for name in ("odr_hz", "full_scale_dps")}
        bus = LinuxI2C(arguments.bus)
        try:
            return MPU6050(bus, arguments.address, **options)
        except ValueError as error:
            raise ZerorateError(str(error)) from error
        except OSError:
            bus.close()
            raise

    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    sinks: list[Sink] = []
    if arguments.socket:
        sinks.append(UnixSocket(arguments.socket))
    if arguments.udp:
        sinks.append(Datagrams(arguments.udp, arguments.remote))
    # systemd ends a service with SIGTERM; Ctrl-C and it do the same
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    system = System(open_imu, FileStorage(str(arguments.state)), clock, say)
    Service(system, sinks or [Lines(sys.stdout)]).run()
