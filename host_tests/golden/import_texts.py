"""What an import reads of texts drawn by a seed: mostly usual ones, with an oddity now and then."""

import gzip
import json
import re
from functools import reduce
from operator import xor
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import cut
from zerorate_tools.importers.logs import json_file
from zerorate_tools.importers.tables import checked_lines
from zerorate_tools.importers.tables.delimited import delimited

_TOLD = re.compile(r"--[a-z-]+(?: [^\s,;()]+)?|-?\d+\.?\d*")
_NAMES = ["t_s", "gx_dps", "gy_dps", "gz_dps", "temp_c"]
_HEADS = (
    *([_NAMES], [_NAMES], [_NAMES], []),
    [["", "gyro (rad/s)", "", "", "die"], ["t", "x", "y", "z", "x"]],
    [["t", "gx", "gy", "gz", "c"], ["s", "deg/s", "deg/s", "(deg/s)", "[degC]"]],
    [["s", "dps", "dps", "dps", "-"], ["t", "gx", "gy", "gz", "c"]],
    [["t", "gx", "gx", "", "gx"]],
)
_ABOVE = ("", "# a note", "Sample rate: 0.2 kHz", "tscale,0.001\ngscale,0.5,,", "r,1,2,3",
          "#a,b,c,d")  # fmt: skip
_BEFORE = ("", "12:00:{:06.3f} -> ", "I ({}) imu: ", "\x1b[0;32mI ({}) imu: ", "[tag] ")
_TIMES = (
    *("{:.3f}", "12:00:{:06.3f}", "2026-05-01T23:59:{:06.3f}+01:00", "12:00:{:02.0f} AM"),
    *("1.5.2026 11:59:{:02.0f} pm", "12:00:{:02.0f}:250", "2026/05/01 12:00:{:02.0f},5"),
)


def mostly(luck, usual, *others):
    """The usual value, or now and then one of the others."""
    return usual if luck.random() < 0.8 else others[luck.integers(len(others))]


def attempt(step, *of):
    """What a step says, or why it refuses: figures and what to type, the words are free."""
    try:
        return str(step(*of))
    except ZerorateError as error:
        return " ".join(["no:", *_TOLD.findall(re.sub(r"/\S+", "", str(error)))])


def _rows(luck, delimiter, number):
    """The lines of a table's rows."""
    time, before = mostly(luck, *_TIMES), mostly(luck, *_BEFORE)
    word = mostly(luck, "", "on", "a b")
    commas, labels = luck.random() < 0.1, luck.random() < 0.12
    end = mostly(luck, "", delimiter)
    for n in range(number):
        cells = [f"{v:.4g}" for v in (n * 0.25 - 2, 1 / (n + 3), -(2.0**n), 20 + n)]
        cells = [cell.replace(".", ",") for cell in cells] if commas else cells
        cells = [f'"{cell}"' if delimiter == "," in cell else cell for cell in cells]
        cells = [time.format(n / 4), *cells, *([word if n % 3 else "off"] if word else [])]
        if labels:
            cells = [f"{name}={cell}" for name, cell in zip(_NAMES, cells)]
        lone = delimiter if luck.random() < 0.02 else ""
        yield before.format(n * 4) + delimiter.join(cells) + (end or lone)


def _text(luck):
    """A table as a program writes it."""
    delimiter, comment = mostly(luck, *",;\t| ", "   "), mostly(luck, "", "#", "// ", "% ")
    head = _HEADS[luck.integers(len(_HEADS))]
    out = ["GYROFLOW IMU LOG"] if luck.random() < 0.1 else []
    out += [mostly(luck, *_ABOVE), *(comment + delimiter.join(names) for names in head)]
    out += _rows(luck, delimiter, mostly(luck, 30, 1, 2, 5))
    odd = ("", "  ", "# note", "1,2", "nan", delimiter.join(head[-1]) if head else "x", "a b c")
    for _ in range(mostly(luck, 0, 1, 3)):
        out.insert(luck.integers(len(out) + 1), odd[luck.integers(len(odd))])
    return mostly(luck, "\n", "\r\n").join(out) + mostly(luck, "\n", "", "\0\0")


def _read(reader, path):
    """Of a file: names, sums, what lacks, rows' places, words, dates, rate and what is dropped."""
    table = reader(path)
    chunks = list(table.chunks(table.names))
    values = {n: np.concatenate([c.columns[n] for c in chunks]) for n in table.names}
    sums = [f"{n} {np.nansum(v):.6g} {np.isnan(v).sum()}" for n, v in values.items()]
    words = [f"{n} {' '.join(of)}" for n, of in table.words.items()]
    place = sum(chunk.place.sum() for chunk in chunks)
    about = [*sorted(table.calendar), table.said_hz, *table.dropped.values(), len(table.notes)]
    return ", ".join(map(str, [*sums, *words, place, *about]))


def texts():
    """What is read of texts."""
    luck, said = np.random.default_rng(6), []
    with TemporaryDirectory() as folder:
        path = Path(folder, "in.csv")
        for _ in range(400):
            path.write_bytes(_text(luck).encode(mostly(luck, "utf-8", "utf-8-sig", "utf-16")))
            said.append(attempt(_read, delimited, path))
    return {"texts": said}


def _record(luck, n, oddities):
    """A sample as an object of JSON may be."""
    number, words = (str if "text" in oddities else float)(n / 4), ["still", "fast", "", str(n)]
    record = {"t": f"2026-05-01T12:00:{n:02d}Z" if "date" in oddities else n * 10, "w": number}
    record |= {"imu": {"gyro": [n, 2.5, -n], "on": n % 2 == 1, "note": f"{n} and so"}}
    record["kind"] = words[n % 2] if luck.random() < 0.82 else n
    if "long" in oddities:
        record["more"] = [{"x": n}] * mostly(luck, 9, 10) if n == 0 else list(range(8 + n % 4))
    if "lacks" in oddities and luck.random() < 0.3:
        record.pop(mostly(luck, "t", "w", "imu", "kind"))
    return record


def _json(luck):
    """A text of records of JSON, in any of the ways that it is written."""
    oddities = [one for one in ("text", "date", "long", "lacks") if luck.random() < 0.3]
    rows = [_record(luck, n, oddities) for n in range(mostly(luck, 25, 1, 5))]
    rows[len(rows) // 2] = mostly(luck, rows[len(rows) // 2], None, 7, "x", [1, 2, 3])
    lists = {n: [r.get(n) if isinstance(r, dict) else None for r in rows] for n in ("t", "w")}
    lists["t"] = mostly(luck, lists["t"], dict(enumerate(lists["t"])))
    held = {"a": rows, "b": mostly(luck, 3, rows)}
    kinds = ("lines", "lines", "printed", rows, lists, held, [[n, 2, 3] for n in range(9)], 7, {})
    kind = kinds[luck.integers(len(kinds))]
    if isinstance(kind, str):
        return "\n".join(str(row) if kind == "printed" else json.dumps(row) for row in rows)
    return json.dumps(kind, indent=mostly(luck, None, 1))


def records():
    """What is read of files of JSON."""
    luck, said = np.random.default_rng(8), []
    with TemporaryDirectory() as folder:
        path = Path(folder, "in.json")
        for _ in range(200):
            path.write_text(_json(luck))
            said.append(attempt(_read, json_file.read, path))
    return {"records": said}


def _checked(luck):
    """Lines with a checksum, some of which are of another name, damaged or cut."""
    kind = mostly(luck, "VNYMR", "VNIMU", "X")
    for n in range(mostly(luck, 30, 1, 3)):
        cells = [mostly(luck, kind, kind, "GPS", "G-S"), *map(str, range(n, n + 12))]
        cells = mostly(luck, cells, cells[:-1], [*cells, "x"]) if n else cells
        text = ",".join(cells)
        line = f"${text}*{reduce(xor, text.encode(), 0):02X}"
        odd = line[1:], line[:-1], line.replace("1", "7"), line.replace("*", "*Z"), f" {line} ", ""
        yield line if luck.random() < 0.9 or not n else odd[luck.integers(len(odd))]


def checked():
    """What is read of lines with a checksum, and of other texts as such."""
    luck, said = np.random.default_rng(12), []
    with TemporaryDirectory() as folder, mock.patch.object(checked_lines, "_BLOCK_BYTES", 400):
        path = Path(folder, "in.txt")
        for _ in range(60):
            path.write_text(mostly(luck, "\n", "\r\n").join([*_checked(luck), ""]))
            said.append(str(checked_lines.checked_lines(path) is not None))
            said.append(attempt(_read, checked_lines.checked_lines, path))
            said += checked_lines.checked_lines(path).mapping
    return {"checked": said}


def _cut(path, rows, folder):
    """Name, lines and bytes of each part, a line each."""
    held = [(part.name, part.read_bytes()) for part in cut(path, rows, folder)]
    return "\n".join(f"{name} {len(text.splitlines())} {len(text)}" for name, text in held)


def cuts():
    """Into which files texts are cut, and how many lines and bytes each has."""
    luck, said = np.random.default_rng(13), []
    with TemporaryDirectory() as folder:
        for number in range(80):
            path = Path(folder, mostly(luck, "in.csv", "in.csv.gz", "in"))
            text = (_text(luck) + mostly(luck, "", _text(luck))).encode()
            path.write_bytes(gzip.compress(text) if path.suffix == ".gz" else text)
            rows = luck.choice([1, 2, 5, 14, 20, 31, 40], mostly(luck, 1, 2)).tolist()
            said += attempt(_cut, path, rows, Path(folder, f"parts{number}")).split("\n")
    return {"cuts": said}


TEXTS = {f"imported {of.__name__}": of for of in (texts, records, checked, cuts)}
