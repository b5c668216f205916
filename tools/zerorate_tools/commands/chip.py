"""Commands that talk to a chip: `zerorate record`, `watch` and `run`."""

import argparse
import errno
import sys
from pathlib import Path
from typing import Any

from zerorate_i2c.settings import ACCEL_RANGES_G, GYRO_RANGES_DPS, choose_divider, choose_filter

from ..bounds import bytes_of, text_of
from ..errors import InFile, ZerorateError
from ..progress import progress
from .learn import sources
from .options import Arguments, above_zero, command, group, option, switch


def _address(text: str) -> int:
    """An address that a chip on an I2C bus may have, as 0x68; the bus keeps the others."""
    if not 0x08 <= (address := int(text, 0)) <= 0x77:
        raise argparse.ArgumentTypeError(f"{text} is no I2C address; they are 0x08 to 0x77")
    return address


def _bus(text: str) -> str:
    """The path of a Linux bus, of which `record` takes the number alone, too."""
    return f"/dev/i2c-{text}" if text.isdecimal() else text


def _range(flag: str, of: str, ranges: tuple[int, ...], dest: str) -> Arguments:
    help = f"range of the {of}: {', '.join(map(str, ranges))}"
    return option(f"{flag} N", help, int, dest=dest, choices=ranges)


#: Options of a chip, which have the driver's own defaults.
_CHIP = (
    option("--address N", "I2C address of the chip (0x68)", _address),
    option("--hz N", "samples a second (100)", above_zero, dest="odr_hz"),
    _range("--dps", "gyroscope", GYRO_RANGES_DPS, "full_scale_dps"),
    _range("--g", "accelerometer", ACCEL_RANGES_G, "full_scale_g"),
    option(
        "--dlpf-hz N", "bandwidth of the gyroscope's low-pass filter (default: by --hz)", above_zero
    ),
    option("--part NAME", "name of the part, such as MPU-6500, if its id is unknown"),
)


def _chip(arguments: argparse.Namespace) -> dict[str, Any]:
    """The options of a chip that were typed, as MPU6050 takes them."""
    names = ("address", "odr_hz", "full_scale_dps", "full_scale_g", "dlpf_hz", "part")
    return {name: v for name in names if (v := getattr(arguments, name)) is not None}


@command(
    "record",
    "make a recording from a board or a Linux I2C bus",
    option("port PORT", "/dev/ttyACM0, COM3 or /dev/i2c-1", nargs="?"),
    option("-o --out FILE", ".parquet, .csv or .csv.gz", Path),
    option("--recover FILE", "finish the .partial.csv of a killed recording", Path),
    option("--seconds S", "stop after this time", above_zero),
    switch("--guide", "show how to turn the device until its scale factors and axes are known"),
    group("the chip, without --setup", *_CHIP),
    group(
        "on a board",
        option("--setup FILE", "a MicroPython file that makes `imu`, for other pins", Path),
    ),
    description="Record a chip until Ctrl-C. PORT is the serial port of a board, /dev/i2c-N, or "
    "fake: for an emulated chip in a simulated hand. Meanwhile the samples are in "
    "NAME.partial.csv, where they stay if the program is killed.",
)
def run_record(arguments: argparse.Namespace) -> int | None:
    """Record, or finish a recording; 1 where no sample came."""
    if (arguments.port is None) == (arguments.recover is None):
        raise ZerorateError("name a PORT to record, or a file by --recover FILE")
    if arguments.recover is not None:
        _recover(arguments)
    elif arguments.out is None:
        raise ZerorateError("name the file to record into by --out FILE")
    else:
        return _record(arguments)
    return None


def _recover(arguments: argparse.Namespace) -> None:
    from ..recordings import open_recording, recover

    target = recover(arguments.recover, arguments.out)
    samples = sum(len(columns["t_us"]) for columns in open_recording(target).batches())
    print(f"{target}: {samples} samples of {arguments.recover}")


def _record(arguments: argparse.Namespace) -> int:
    from ..boards.recording import record
    from ..recordings.growing import left_over

    for partial in left_over(arguments.out):
        finish = f"zerorate record --recover {partial} finishes it"
        print(f"{partial}: of a recording that was killed; {finish}", file=sys.stderr)
    options = _chip(arguments)
    if arguments.setup is not None:
        options["setup"] = text_of(arguments.setup, "name MicroPython source")
    if arguments.guide:
        return _guided(arguments, options)
    with progress(f"recording {arguments.port}", arguments.seconds) as done:
        result = record(
            arguments.port, arguments.out, seconds=arguments.seconds, done=done, **options
        )
    return _made(arguments.out, result)


def _guided(arguments: argparse.Namespace, options: dict[str, Any]) -> int:
    """Record until every entry is known; say what is not where it ends before."""
    from ..boards.recording import FAKE, record
    from ..guide import Guide, screen, unknown

    with screen() as shown, Guide(shown, waits=arguments.port == FAKE) as guide:
        result = record(
            *(arguments.port, arguments.out),
            seconds=arguments.seconds,
            done=guide.done,
            heard=guide.heard,
            **options,
        )
    code = _made(arguments.out, result)
    if guide.known is not None and not guide.known.all_known:
        print(f"not known yet: {', '.join(unknown(guide.known))}")
    if not code:
        print(f"next: zerorate close {arguments.out} --out closed")
    return code


def _made(out: Path, result: Any) -> int:
    print(f"{out}: {result}" if result.samples else f"no sample came, nothing is written: {result}")
    return 0 if result.samples else 1


#: With --own or not: what did not come, and what to do.
_NOTHING_CAME = {
    False: ("no sample came", "is its writer at work?"),
    True: ("its program printed nothing", "zerorate flash PORT --main FILE puts one there"),
}


@command(
    "watch",
    "show live what is learned, from a board or a growing recording",
    option("source SOURCE", "run.csv, /dev/ttyACM0 or /dev/i2c-1"),
    option("--for SECONDS", "stop after this time", above_zero, dest="seconds"),
    switch("--once", "read what is there, and stop"),
    option("--every SECONDS", "time between two lines", above_zero, dest="every_s"),
    switch("--plain", "print lines on a terminal too"),
    option("--model FILE", "an effect model to load", Path),
    *sources(),
    switch("--own", "only read what the board's own program prints"),
    option("--plot FILE", "draw the bias over time at the end", Path),
    option("--setup FILE", "on a board: a MicroPython file that makes `imu`", Path),
    description="Show rates, bias with its source and one sigma, temperature and what is learned, "
    "until Ctrl-C. SOURCE is a growing .csv, as of `zerorate record`, the serial port of a board, "
    "/dev/i2c-N, or fake: for an emulated chip at rest.",
)
def run_watch(arguments: argparse.Namespace) -> None:
    """Watch; an error where no sample, or no line, ever came."""
    if arguments.own and (arguments.model or arguments.setup):
        raise ZerorateError("--own leaves the board's program as it is; drop --model and --setup")
    from ..watch.screen import WatchOptions, check_picture, draw
    from ..watch.watching import watch

    if arguments.plot:
        check_picture(arguments.plot)
    names = ("seconds", "once", "every_s", "plain", "model", "own")
    options = WatchOptions(
        **{name: getattr(arguments, name) for name in names},
        settings={"motion": arguments.motion, "gravity": arguments.gravity},
        setup=text_of(arguments.setup, "name MicroPython source") if arguments.setup else "",
    )
    live = watch(arguments.source, options)
    if live is None:
        came, do = _NOTHING_CAME[arguments.own]
        raise ZerorateError(f"{arguments.source}: {came}; {do}")
    if arguments.plot:
        draw(live, arguments.plot)
        print(arguments.plot)


#: What opening says of a path that is something else, and stays so.
_NO_BUS = (errno.ENOTTY, errno.EISDIR, errno.ENOTDIR)


@command(
    "run",
    "correct continuously on a Linux board, as a service",
    option("bus BUS", "/dev/i2c-1, or fake: for an emulated chip", _bus),
    option("--state FILE", "file for what is learned (learned.bin; of fake: fake.bin)", Path),
    option("--socket FILE", "Unix socket for readers", Path),
    option("--udp HOST:PORT", "send datagrams, only to this machine"),
    option("--metrics HOST:PORT", "serve metrics for Prometheus"),
    switch("--remote", "let other machines reach --udp and --metrics"),
    *_CHIP,
    option("--model FILE", "effect model to apply", Path),
    description="Read the chip, learn its bias at rest, store what is learned, and publish the "
    "corrected samples as lines of JSON on standard output, a Unix socket, or by UDP. A line has "
    "rate_dps (without bias), raw_dps (with it), bias_dps, accel_g, temp_degc, t_us since the "
    "start, and gap_us if samples are missing before it. `zerorate import` reads them.",
)
def run_run(arguments: argparse.Namespace) -> None:
    import signal
    import time

    from zerorate_i2c import clock
    from zerorate_i2c.linux import LinuxI2C
    from zerorate_i2c.mpu6050 import MPU6050

    from ..host import store_file
    from ..service import Datagrams, FakeBus, Lines, Metrics, Service, Sink, System, UnixSocket

    # what an emulated chip taught would be a wrong bias for the real one
    state = arguments.state or Path("fake.bin" if arguments.bus == "fake:" else "learned.bin")
    if not state.parent.is_dir():
        raise InFile(state.parent, "no such folder", do="make it, or name another")
    options = _chip(arguments)
    model = _model_bytes(arguments.model) if arguments.model else b""
    fake = None
    _require_settings(options)
    if arguments.bus == "fake:":
        fake = FakeBus(**{name: options[name] for name in ("address", "part") if name in options})

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
            return MPU6050(bus, **options)
        except ValueError as error:
            raise ZerorateError(str(error)) from error
        except OSError:
            bus.close()
            raise

    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    def stored_ago_s() -> float:
        return time.time() - state.stat().st_mtime

    sinks: list[Sink] = []
    if arguments.udp:
        sinks.append(Datagrams(arguments.udp, arguments.remote))
    if arguments.metrics:
        sinks.append(Metrics(arguments.metrics, arguments.remote))
    storage = store_file(state)
    if arguments.socket:  # last: it leaves a file where another is refused
        sinks.append(UnixSocket(arguments.socket))
    # systemd ends a service with SIGTERM, a closed terminal with SIGHUP; Ctrl-C does the same
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:  # by nohup
            signal.signal(number, signal.default_int_handler)
    system = System(open_imu, storage, clock, say, stored_ago_s=stored_ago_s)
    Service(system, sinks or [Lines(sys.stdout)], model, str(arguments.model)).run()


def _require_settings(options: dict[str, Any]) -> None:
    """Raise ZerorateError for a rate and a filter that no part can take, or not the part named:
    before the bus is waited for."""
    from zerorate_i2c.parts import MPU6050_KIND, MPU6500_KIND, part_by_name

    odr_hz, refused = options.get("odr_hz", 100), None
    try:
        part = options.get("part")
        kinds = (part_by_name(part)[6],) if part else (MPU6050_KIND, MPU6500_KIND)
    except ValueError as error:
        raise ZerorateError(str(error)) from error
    for kind in kinds:
        try:
            choose_divider(choose_filter(kind, odr_hz, options.get("dlpf_hz"))[0], odr_hz)
            return
        except ValueError as error:
            refused = error
    raise ZerorateError(str(refused))


def _model_bytes(path: Path) -> bytes:
    """The bytes of model.bin, which need no library; those of its readable twin need tools."""

    if path.suffix != ".json":
        return bytes_of(path, "name a model.bin or model.json")
    from ..model import encoded, read_model

    return encoded(read_model(path))
