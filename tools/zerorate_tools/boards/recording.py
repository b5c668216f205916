"""One command for both: a Linux I2C bus by its device path, a board by its serial port."""

import re
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path
from typing import Any

from ..errors import MissingLibrary, ZerorateError
from ..recordings.writing import check_output
from .recorder import Heard, Recorded, Take, recorded

FAKE = "fake:"
_BUS = re.compile(r"/dev/i2c-\d+|\d+")


def record(
    port_or_bus: str,
    out: str | Path,
    *,
    seconds: float | None = None,
    heard: Heard | None = None,
    **options: Any,
) -> Recorded:
    """Record from /dev/i2c-N (or N) or from a board on a serial port into out; `fake:` is an
    emulated chip in a simulated hand, for as long as that moves and without waiting.

    seconds None records until KeyboardInterrupt. options: see stream_bus and stream_port. Raises
    MissingLibrary without smbus2 or mpremote, InFile without room, ZerorateError for a board that
    does not answer, for a setting that no part can take, and for a bus or board that fails on its
    way, when out holds what had been verified, OSError for a bus that does not answer.
    """
    check_output(out)
    how = _of_a_hand if port_or_bus == FAKE else stream
    streamed = partial(how, port_or_bus, seconds=seconds, **options)
    return recorded(Path(out), heard, streamed)


def stream(port_or_bus: str, take: Take, *, seconds: float | None = None, **options: Any) -> None:
    """As record, but into what take(scales) makes; `fake:` rests, in real time."""
    if port_or_bus != FAKE and not _BUS.fullmatch(port_or_bus):
        from .port import stream_port

        stream_port(port_or_bus, take, seconds=seconds, **options)
        return
    from .bus import stream_bus
    from .fake_chip import FakeBus

    _check_no_setup(port_or_bus, options)
    with nullcontext(FakeBus()) if port_or_bus == FAKE else _opened(port_or_bus) as i2c:
        stream_bus(i2c, take, source=port_or_bus, seconds=seconds, **options)


def _of_a_hand(source: str, take: Take, *, seconds: float | None, **options: Any) -> None:
    from .bus import stream_bus
    from .fake_chip import in_hand

    _check_no_setup(source, options)
    given = {name: options[name] for name in ("address", "part") if name in options}
    try:
        bus, clock, longest = in_hand(**given)
        seconds = longest if seconds is None else min(seconds, longest)
        stream_bus(bus, take, source=source, seconds=seconds, time_source=clock, **options)
    except ValueError as error:
        raise ZerorateError(f"{source} {error}") from error


def _check_no_setup(source: str, options: dict[str, Any]) -> None:
    if "setup" in options:
        raise ZerorateError(f"{source} is no board: leave out --setup")


@contextmanager
def _opened(bus: str) -> Iterator[Any]:
    """The bus; what the driver refuses is said in a line."""
    from zerorate_i2c.linux import LinuxI2C

    path, i2c = f"/dev/i2c-{bus}" if bus.isdigit() else bus, None
    try:
        i2c = LinuxI2C(path)
        yield i2c
    except ImportError as error:
        raise MissingLibrary("smbus2") from error
    except ValueError as error:
        raise ZerorateError(f"{path}: {error}") from error
    except OSError as error:  # smbus2 and the driver name no bus
        error.filename = error.filename or path
        raise
    finally:
        if i2c is not None:
            i2c.close()
