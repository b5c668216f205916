"""`zerorate export c DIR`: the firmware's rest path in C."""

import argparse
from pathlib import Path


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser("export", help="write the firmware as C, for no MicroPython")
    actions = parser.add_subparsers(metavar="LANGUAGE", required=True)
    c = actions.add_parser("c", help="a header, a C file, a test program, and what builders read")
    c.add_argument("folder", type=Path, metavar="DIR", help="made if it is not there")
    for name, default in (("odr-hz", 100.0), ("gyro-lsb-per-dps", 131.0)):
        c.add_argument(f"--{name}", type=float, default=default, metavar="N", help=f"{default:g}")
    for name, default in (("accel-lsb-per-g", 16384.0), ("temp-lsb-per-degc", 340.0)):
        text = f"{default:g}; 0 where there is none"
        c.add_argument(f"--{name}", type=float, default=default, metavar="N", help=text)
    c.add_argument(
        "--model", type=Path, metavar="FILE", help="a model.bin; its scales replace those above"
    )
    c.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    from zerorate import Sensor

    from zerorate_tools.errors import ZerorateError
    from zerorate_tools.kernels.export import export_c

    try:
        sensor = Sensor(
            arguments.odr_hz,
            arguments.gyro_lsb_per_dps,
            arguments.accel_lsb_per_g,
            arguments.temp_lsb_per_degc,
        )
        paths = export_c(arguments.folder, sensor, arguments.model)
    except ValueError as error:
        raise ZerorateError(str(error)) from error
    for path in paths:
        print(path)
