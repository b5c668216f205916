"""A folder of sound and odd files, for commands to stumble over."""

import contextlib
import gzip
import json
import math
import os
import re
import shutil
import struct
import zipfile
import zlib
from copy import deepcopy

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from zerorate_tools import cli
from zerorate_tools.model import write_model
from zerorate_tools.simulate import simulate_to_files

from host_tests.golden.known import EVERYTHING
from host_tests.tools.killed_writers import model

_SCALES = '{"sensor":"x","odr_hz":%s,"gyro_lsb_per_dps":%s,"temp_lsb_per_degc":%s,'
_SCALES += '"temp_offset_degc":36.53}'
_ALL_SCALES = {
    "sensor": "x", "odr_hz": 100.0, "gyro_lsb_per_dps": 131.0, "accel_lsb_per_g": 16384.0,
    "temp_lsb_per_degc": 340.0, "temp_offset_degc": 36.53, "source": "s", "more": {"a": [1, 2]},
}  # fmt: skip
_HEAD = "t_us,gx,gy,gz,temp\n"
_ROWS = [f"{i * 10000},{i % 7},{i % 5},{i % 3},{i % 9}\n" for i in range(500)]
_LOG = _HEAD + "".join(_ROWS)
_ODD_SCALES = ("0", "-1", "1e18", "1e-300", "1e400", "NaN", "null", '"x"', "[1]", "true")
_TEXTS = {
    "names": ",".join(f"c{i}" for i in range(200_000)) + "\n" + _ROWS[0],
    "long-name": "t_us,gx,gy,gz," + "n" * 900_000 + "\n" + _ROWS[0],
    "nul": _LOG.replace(",", ",\0", 3),
    "utf16": _LOG.encode("utf-16"),
    "wide": _HEAD + f"{10**30},{10**20},1e400,{'9' * 5000},nan\n",
    "far": f"{_HEAD}{-(2**63)},1,2,3,4\n{2**63 - 1},1,2,3,4\n",
    "one-row": _HEAD + _ROWS[0],
    "one-time": _HEAD + "".join(f"7,{row.split(',', 1)[1]}" for row in _ROWS),
    "no-row": _HEAD,
    "ragged": _HEAD + "".join(row[: len(row) // 2] + "\n" for row in _ROWS),
    "quotes": _LOG.replace("gx", '"gx'),
    "loud": _HEAD + "".join(f"{i * 10000},{2**31 - 1},{-(2**31)},1,1\n" for i in range(500)),
    "\x1b[31m\u202e": _LOG,
    "a\nb": _LOG,
    "n" * 251: _LOG,
    os.fsdecode(b"a\xff"): _LOG,
}
_ZIPS = {
    "up.zip": ["../up.csv", "/etc/up.csv"],
    "many.zip": [f"{i}.csv" for i in range(500)],
    "odd.zip": ["a\nb.csv", "\x1b[31m.csv", "con", "x/" * 60 + "x.csv"],
    "none.zip": [],
}


def make(folder, draw):
    """Write all into an empty folder."""
    (folder / "dev.toml").write_text("[every_session]\nminutes = 0.5\n")
    for name in ("run", "left.partial"):
        _csv(folder, name)
    simulate_to_files({"every_session": {"minutes": 1}}, folder / "run.parquet", seed=1)
    with contextlib.chdir(folder), open(os.devnull, "w") as null, contextlib.redirect_stdout(null):
        cli.main(["replay", "run.parquet", "--out", "bias.parquet", "--state", "state.bin"])
        write_model(model(1), ".")
    for name, text in _TEXTS.items():
        _csv(folder, name, text)
    for number, odd in enumerate(_ODD_SCALES):
        _csv(folder, f"hz{number}", scales=(odd, "131.0", "340"))
        _csv(folder, f"lsb{number}", scales=("100", odd, "340"))
        _csv(folder, f"temp{number}", scales=("100", "131.0", odd))
    (folder / "rates.csv").write_text(_LOG.replace("t_us,gx,gy,gz", "t_us,gx_dps,gy_dps,gz_dps"))
    (folder / "cut.csv.gz").write_bytes(gzip.compress(_LOG.encode())[:-20])
    (folder / "more.csv.gz").write_bytes(gzip.compress(_LOG.encode()) + b"more")
    (folder / "deep.json").write_text("[" * 100_000)
    (folder / "deep.toml").write_text("a=" + "{a=" * 3000)
    (folder / "big.json").write_text('{"gx":[' + ",".join(["1e999", "9" * 5000] * 9) + "]}")
    _parquets(folder)
    _zips(folder)
    _damaged(folder, draw)
    _places(folder)


#: What `drawn` writes: what one takes as a device, a model, a recording.
DRAWN = {
    "DEVICE": ("drawn.yaml",), "MODEL": ("drawn-model.json", "drawn-model.bin"),
    "LOG": ("drawn.csv",),
}  # fmt: skip
_LEAVES = (
    *(0, -1, 1, 2, 60, 0.001, 1e6, 1e18, -1e18, 1e-300, 1e308, math.inf, -math.inf, math.nan),
    *(2**31, -(2**31), 2**63, 10**30, None, True, [], {}, [1], [[1]], [1, 2, 3]),
    *("", "x", "temp", "rest", "\x1b[31m", "1/0", "../x"),
)


def drawn(folder, draw):
    """Sound files of which a value or two are others, by the random `draw`; checksums are right."""
    (folder / "drawn.yaml").write_text(_as_yaml(_turned(EVERYTHING, draw)))
    model = json.loads((folder / "model.json").read_text())
    (folder / "drawn-model.json").write_text(json.dumps(_turned(model, draw)))
    words = bytearray((folder / "model.bin").read_bytes()[:-4])
    at, size = draw.randrange(6, len(words) - 4), draw.choice((1, 2, 4))
    words[at : at + size] = draw.choice((b"\xff", b"\0", b"\x80", draw.randbytes(1))) * size
    (folder / "drawn-model.bin").write_bytes(words + zlib.crc32(words).to_bytes(4, "little"))
    cells = [row.split(",") for row in _LOG.splitlines()]
    for _ in range(draw.choice((0, 0, 1, 9))):
        cells[draw.randrange(len(cells))][draw.randrange(5)] = str(draw.choice(_LEAVES))
    (folder / "drawn.csv").write_text("\n".join(map(",".join, cells)) + "\n")
    (folder / "drawn.json").write_text(json.dumps(_turned(_ALL_SCALES, draw)))


def _as_yaml(value):
    """JSON, whose numbers YAML writes otherwise."""
    text = re.sub("(-?)Infinity", r"\1.inf", json.dumps(value)).replace("NaN", ".nan")
    return re.sub(r"(?<![\d.])(\d)e([+-])", r"\1.0e\2", text)


def _turned(value, draw):
    """A copy of what JSON holds, of which one or two parts are others."""
    other = deepcopy(value)
    for _ in range(draw.choice((1, 1, 2))):
        part, key = draw.choice([*_places_in(other)])
        part[key] = deepcopy(draw.choice(_LEAVES))
    return other


def _places_in(value):
    """(container, key) of every part."""
    keys = [*value] if isinstance(value, dict) else range(len(value))
    for key in keys:
        yield value, key
        if isinstance(value[key], dict | list):
            yield from _places_in(value[key])


def _csv(folder, name, text=_LOG, scales=("100", "131.0", "340")):
    content = text if isinstance(text, bytes) else text.encode()
    (folder / f"{name}.csv").write_bytes(content)
    if len(name) < 250:
        (folder / f"{name}.json").write_text(_SCALES % scales)


def _parquets(folder):
    sound = (folder / "run.parquet").read_bytes()
    (folder / "cut.parquet").write_bytes(sound[: len(sound) // 2])
    (folder / "footer.parquet").write_bytes(sound[:-8] + struct.pack("<I", 2**31 - 1) + b"PAR1")
    table = pq.read_table(folder / "run.parquet")
    for name, odd in {
        "empty": table.slice(0, 0),
        "row": table.slice(0, 1),
        "list": table.append_column("l", pa.array([[1]] * len(table))),
        "null": table.append_column("n", pa.nulls(len(table))),
        "float": table.set_column(1, "gx", table["gx"].cast(pa.float64())),
    }.items():
        pq.write_table(odd, folder / f"{name}.parquet")


def _zips(folder):
    for name, members in _ZIPS.items():
        with zipfile.ZipFile(folder / name, "w") as packed:
            for member in members:
                packed.writestr(member, _LOG)
    whole = (folder / "odd.zip").read_bytes()
    (folder / "cut.zip").write_bytes(whole[: len(whole) // 2])
    (folder / "tail.zip").write_bytes(whole[:-30])
    locked = whole.replace(b"PK\3\4\x14\0\0", b"PK\3\4\x14\0\1")
    (folder / "locked.zip").write_bytes(
        locked.replace(b"PK\1\2\x14\3\x14\0\0", b"PK\1\2\x14\3\x14\0\1")
    )


def _damaged(folder, draw):
    for suffix in (".bin", ".mat", ".ulg", ".h5", ".db3", ".json", ""):
        (folder / f"noise{suffix}").write_bytes(draw.randbytes(3000))
    words = np.array([draw.randrange(-(2**30), 2**30) for _ in range(400)], "<i4").tobytes()
    (folder / "words.bin").write_bytes(words)
    (folder / "cut-model.bin").write_bytes((folder / "model.bin").read_bytes()[:-5])
    for number in range(3):
        turned = bytearray((folder / "state.bin").read_bytes())
        turned[draw.randrange(len(turned))] ^= 1 << draw.randrange(8)
        (folder / f"turned{number}.bin").write_bytes(turned)
        text = bytearray((folder / "model.json").read_bytes())
        at = draw.randrange(len(text))
        text[at : at + draw.randrange(5)] = draw.choice((b"1e400", b"null", b"-9", b"[[", b""))
        (folder / f"model{number}.json").write_bytes(text)


def _places(folder):
    for suffix in (".csv", ".parquet"):
        os.mkfifo(folder / f"fifo{suffix}")
        (folder / f"loop{suffix}").symlink_to(f"loop{suffix}")
        (folder / f"gone{suffix}").symlink_to(f"nowhere/x{suffix}")
        (folder / f"to-run{suffix}").symlink_to(f"run{suffix}")
        (folder / f"void{suffix}").touch()
        (folder / f"dir{suffix}").mkdir()
    os.link(folder / "run.parquet", folder / "same.parquet")
    (folder / "full" / "device=a").mkdir(parents=True)
    shutil.copy(folder / "run.parquet", folder / "full" / "device=a")
    (folder / "shut").mkdir()
    for name, mode in (("secret.csv", 0), ("fixed.parquet", 0o444), ("shut/x.parquet", 0o644)):
        (folder / name).write_text(_LOG)
        (folder / name).chmod(mode)
    (folder / "shut").chmod(0o555)
