"""One command for both: a Linux I2C bus by its device path, a board by its serial port."""

import re
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from ..errors import MissingLibrary, ZerorateError
from ..recordings.writing import check_output
from .recorder import Recorded, Take

FAKE = "fake:"
_BUS = re.compile(r"/dev/i2c-\d+|\d+")


def record(
    port_or_bus: str, out: str | Path, *, seconds: float | None = None, **options: Any
) -> Recorded:
    """Record from /dev/i2c-N (or N) or from a board on a serial port into out; `fake:` is an
    emulated chip in a simulated hand, for as long as that moves and without waiting.

    seconds None records until KeyboardInterrupt. options: see record_bus and record_port. Raises
    MissingLibrary without smbus2 or mpremote, ZerorateError for a board that does not answer or a
    setting that no part can take, OSError for a bus that does not.
    """
    check_output(out)
    if _is_board(port_or_bus, options):
        from .port import record_port

        return record_port(port_or_bus, Path(out), seconds=seconds, **options)
    how = _record_fake if port_or_bus == FAKE else _record_linux
    return how(port_or_bus, Path(out), seconds=seconds, **options)


def stream(port_or_bus: str, take: Take, *, seconds: float | None = None, **options: Any) -> None:
    """As record, but into what take(scales) makes; `fake:` rests, in real time."""
    if _is_board(port_or_bus, options):
        from .port import stream_port

        stream_port(port_or_bus, take, seconds=seconds, **options)
        return
    from .bus import stream_bus
    from .fake_chip import FakeBus

    with nullcontext(FakeBus()) if port_or_bus == FAKE else _opened(port_or_bus) as i2c:
        stream_bus(i2c, take, source=port_or_bus, seconds=seconds, **options)


def _is_board(port_or_bus: str, options: dict[str, Any]) -> bool:
    if port_or_bus != FAKE and not _BUS.fullmatch(port_or_bus):
        return True
    if "setup" in options:
        raise ZerorateError(f"{port_or_bus} is no board: leave out --setup")
    return False


def _record_fake(source: str, out: Path, *, seconds: float | None, **options: Any) -> Recorded:
    from .bus import record_bus
    from .fake_hand import in_hand

    given = {name: options[name] for name in ("address", "part") if name in options}
    try:
        bus, clock, longest = in_hand(**given)
        seconds = longest if seconds is None else min(seconds, longest)
        return record_bus(bus, out, source=source, seconds=seconds, time_source=clock, **options)
    except ValueError as error:
        raise ZerorateError(f"{source} {error}") from error


def _record_linux(bus: str, out: Path, **options: Any) -> Recorded:
    from .bus import record_bus

    with _opened(bus) as i2c:
        return record_bus(i2c, out, source=bus, **options)


@contextmanager
def _opened(bus: str) -> Iterator[Any]:
    """The bus; what the driver refuses is said in a line."""
    from zerorate_i2c.linux import LinuxI2C

    try:
        i2c = LinuxI2C(int(bus) if bus.isdigit() else bus)
    except ImportError as error:
        raise MissingLibrary("smbus2") from error
    try:
        yield i2c
    except ValueError as error:
        raise ZerorateError(f"{bus}: {error}") from error
    finally:
        i2c.close()
