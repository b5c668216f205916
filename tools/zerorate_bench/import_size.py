"""What importing a huge CSV costs."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from zerorate_tools.errors import ZerorateError

from .children import in_child

_HEADER = b"t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g,temp_degC\n"
_ROWS = 100_000
_HZ = 100
_DIGITS = 8
_BIAS_DPS, _NOISE_DPS, _NOISE_G = (0.3, -0.2, 0.1), 0.05, 0.002
_TIMED = """
from zerorate_tools.importers import import_recording
start = time.monotonic()
report = import_recording(*sys.argv[1:])
print(json.dumps([report.rows_written, time.monotonic() - start, *spent()]))
"""


def steps() -> int:
    """How often `run` advances."""
    return 2


def run(gb: float, folder: Path | None, advance: Callable[[float], None]) -> dict[str, float]:
    """gb, rows, seconds by the wall and of the processor, peak_mb of an import into Parquet.

    folder: where file, recording and what lies between have room, some 2.5 times as much.
    advance: called with 1 after the making and after the import. Raises ZerorateError.
    """
    with TemporaryDirectory(prefix="zerorate-bench-", dir=folder) as scratch:
        source, out = Path(scratch) / "large.csv", Path(scratch) / "large.parquet"
        rows = write_large(source, gb)
        advance(1)
        written, seconds, cpu_s, peak_bytes = in_child(_TIMED, source, out)
        if written != rows:
            raise ZerorateError(f"{written:.0f} of {rows} rows were imported")
        size_gb = source.stat().st_size / 1e9
        advance(1)
    return {
        "gb": size_gb,
        "rows": rows,
        "seconds": seconds,
        "processor_s": cpu_s,
        "peak_mb": peak_bytes / 1e6,
    }


def write_large(path: Path, gigabytes: float) -> int:
    """Write a log at rest at 100 Hz of at least so many 10^9 bytes; the number of its rows.

    The same 100,000 rows over and over, each time with later time stamps.
    """
    lines = np.frombuffer(b"".join(_lines()), np.uint8).reshape(_ROWS, -1).copy()
    rows = 0
    with open(path, "wb") as file:
        file.write(_HEADER)
        while file.tell() < gigabytes * 1e9:
            whole, hundredths = np.divmod(np.arange(rows, rows + _ROWS), _HZ)
            for place in range(_DIGITS):
                lines[:, _DIGITS - 1 - place] = 48 + whole // 10**place % 10
            lines[:, _DIGITS + 1] = 48 + hundredths // 10
            lines[:, _DIGITS + 2] = 48 + hundredths % 10
            file.write(lines.tobytes())
            rows += _ROWS
    return rows


def _lines() -> list[bytes]:
    luck = np.random.default_rng(1)
    rates = luck.normal(_BIAS_DPS, _NOISE_DPS, (_ROWS, 3))
    forces = luck.normal((0, 0, 1), _NOISE_G, (_ROWS, 3))
    temp = 25 + 5 * np.sin(np.linspace(0, 2 * np.pi, _ROWS, endpoint=False))
    form = b"%011.2f" + 3 * b",%+.5f" + 3 * b",%+.5f" + b",%.3f\n"
    return [form % (0.0, *row) for row in np.column_stack([rates, forces, temp]).tolist()]


def in_markdown(found: dict[str, float]) -> str:
    return (
        f"{found['gb']:.2f} GB of CSV, {found['rows']:,.0f} rows: {found['seconds']:.0f} s "
        f"({found['processor_s']:.0f} s of a processor), at most {found['peak_mb']:.0f} MB\n"
    )
