"""One command for both: a Linux I2C bus by its device path, a board by its serial port."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..errors import MissingLibrary, ZerorateError
from ..recordings import Scales
from ..recordings.writing import check_output
from .recorder import Recorded, SampleTaker

FAKE = "fake:"
_BUS = re.compile(r"/dev/i2c-\d+|\d+")


def record(
    port_or_bus: str,
    out: str | Path,
    *,
    seconds: float | None = None,
    done: Callable[[float], object] = lambda seconds: None,
    **options,
) -> Recorded:
    """Record from /dev/i2c-N (or N) or from a board on a serial port into out; `fake:` is an
    emulated chip in a simulated hand, for as long as that moves and without waiting.

    seconds None records until KeyboardInterrupt. options: see record_bus and record_port. Raises
    MissingLibrary without smbus2 or mpremote, ZerorateError for a board that does not answer or a
    setting that no part can take, OSError for a bus that does not.
    """
    check_output(out)
    _require_a_board(port_or_bus, options)
    if port_or_bus == FAKE:
        return _record_fake(Path(out), seconds=seconds, done=done, **options)
    if _BUS.fullmatch(port_or_bus):
        return _record_linux(port_or_bus, Path(out), seconds=seconds, done=done, **options)
    from .port import record_port

    return record_port(port_or_bus, Path(out), seconds=seconds, done=done, **options)


def stream(
    port_or_bus: str,
    take: Callable[[Scales], SampleTaker],
    *,
    seconds: float | None = None,
    done: Callable[[float], object] = lambda seconds: None,
    **options,
) -> None:
    """As record, but into the SampleTaker that take(scales) makes; `fake:` rests, in real time."""
    _require_a_board(port_or_bus, options)
    if port_or_bus == FAKE:
        from .bus import stream_bus
        from .fake_chip import FakeBus

        stream_bus(FakeBus(), take, source=FAKE, seconds=seconds, done=done)
        return
    if _BUS.fullmatch(port_or_bus):
        from .bus import stream_bus

        with _opened(port_or_bus) as i2c:
            stream_bus(i2c, take, source=port_or_bus, seconds=seconds, done=done, **options)
        return
    from .port import stream_port

    stream_port(port_or_bus, take, seconds=seconds, done=done, **options)


def _require_a_board(port_or_bus: str, options: dict[str, Any]) -> None:
    if "setup" in options and (port_or_bus == FAKE or _BUS.fullmatch(port_or_bus)):
        raise ZerorateError(f"{port_or_bus} is no board: leave out --setup")


def _record_fake(out: Path, *, seconds: float | None, **options) -> Recorded:
    from .bus import record_bus
    from .fake_hand import in_hand

    given = {name: options[name] for name in ("address", "part") if name in options}
    try:
        bus, clock, longest = in_hand(**given)
        seconds = longest if seconds is None else min(seconds, longest)
        return record_bus(bus, out, source=FAKE, seconds=seconds, time_source=clock, **options)
    except ValueError as error:
        raise ZerorateError(f"{FAKE} {error}") from error


def _record_linux(bus: str, out: Path, **options) -> Recorded:
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
