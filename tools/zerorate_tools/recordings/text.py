"""A text file's bytes as UTF-8, whatever it is packed or encoded in, never more than a block."""

import codecs
import io
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pyarrow as pa
import pyarrow.csv

from ..errors import BadRecording

_BLOCK_BYTES = 1_048_576
_NO_VALUE = ["", "nan", "NaN", "NA", "null", "None"]
_PACKED = {
    b"\x1f\x8b": "gzip",
    b"BZh": "bz2",
    b"\x28\xb5\x2f\xfd": "zstd",
    b"\x04\x22\x4d\x18": "lz4",
}
_MARKS = {
    b"\xff\xfe\x00\x00": "utf-32",
    b"\x00\x00\xfe\xff": "utf-32",
    b"\xff\xfe": "utf-16",
    b"\xfe\xff": "utf-16",
    b"\xef\xbb\xbf": "utf-8",
}
#: Of no ASCII: Chinese ones have two bytes each, accents stand alone.
_LETTERS = re.compile(rb"[\x80-\xff]+(?=[\0-\x7f])")


def open_text(path: Path, encoding: str = "utf-8") -> tuple[pa.NativeFile, Callable[[], int]]:
    """The text as UTF-8 bytes, and how many bytes of the file itself were read so far."""
    raw = pa.OSFile(str(path))
    stream = raw
    packed = _packed(path)
    if packed is not None:
        stream = pa.CompressedInputStream(raw, packed)
    if encoding != "utf-8":
        decoder = codecs.getincrementaldecoder(encoding)("replace")  # a line may be torn
        stream = pa.TransformInputStream(stream, lambda block: decoder.decode(block).encode())
    return stream, raw.tell


def lines_of(path: Path, encoding: str) -> Iterator[bytes]:
    """The lines of the text as UTF-8, each with its end."""
    return io.BufferedReader(open_text(path, encoding)[0], _BLOCK_BYTES)


def line_blocks(
    path: Path, encoding: str, advance: Callable[[float], None], size: int
) -> Iterator[bytes]:
    """The text as UTF-8 in blocks of whole lines; the last line may lack its end.

    advance: called with the bytes of the file that were read since. Raises BadRecording.
    """
    stream, told = open_text(path, encoding)
    rest, read = b"", 0
    while block := _read(path, stream, size):
        text = rest + block
        cut = max(text.rfind(b"\n"), text.rfind(b"\r")) + 1
        rest = text[cut:]
        if len(rest) >= size:
            problem = f"a row is longer than {size >> 20} MiB"
            raise BadRecording(path, problem, do="name a table with a sample on each line")
        if cut:
            yield text[:cut]
        advance(told() - read)
        read = told()
    if rest:
        yield rest


def rows_of(
    lines: bytes,
    names: list[str],
    kind: pa.DataType,
    skip: int,
    take_odd: Callable[[pyarrow.csv.InvalidRow], str] | None = None,
    delimiter: str = ",",
    wanted: list[str] | None = None,
) -> pa.Table:
    """The cells of whole lines but the first `skip`, by column. A block at a time: a reader of the
    whole file reads ahead in a thread, which aborts the process where it calls Python while that
    ends. Raises pa.ArrowInvalid."""
    return pyarrow.csv.read_csv(
        pa.BufferReader(lines or b"\n"),
        read_options=pyarrow.csv.ReadOptions(
            block_size=len(lines) + 1, column_names=names, skip_rows=skip, use_threads=False
        ),
        parse_options=pyarrow.csv.ParseOptions(delimiter=delimiter, invalid_row_handler=take_odd),
        convert_options=pyarrow.csv.ConvertOptions(
            column_types=dict.fromkeys(names, kind),
            include_columns=wanted,
            null_values=_NO_VALUE,
            strings_can_be_null=True,
            check_utf8=False,
        ),
    )


def _read(path: Path, stream: pa.NativeFile, size: int) -> bytes:
    try:
        return stream.read(size)
    except (OSError, EOFError, pa.ArrowException) as error:
        raise damaged(path) from error


def head(path: Path, size: int) -> tuple[bytes, str]:
    """The first `size` bytes, unpacked, and the encoding that they are in. Raises BadRecording."""
    try:
        content = open_text(path)[0].read(size)
    except (OSError, EOFError, pa.ArrowException) as error:
        raise damaged(path) from error
    return content, _encoding(content)


def damaged(path: Path) -> BadRecording:
    """What to raise where a packed file cannot be unpacked."""
    kind = _packed(path) or "file"
    return BadRecording(path, f"the {kind} data is cut off or damaged", do="copy the file again")


def _packed(path: Path) -> str | None:
    with open(path, "rb") as file:
        start = file.read(4)
    return next((name for mark, name in _PACKED.items() if start.startswith(mark)), None)


def _encoding(content: bytes) -> str:
    for mark, name in _MARKS.items():
        if content.startswith(mark):
            return name
    sample = content[:4096]
    if sample[1::2].count(0) > 0.4 * len(sample):
        return "utf-16-le"
    if sample[::2].count(0) > 0.4 * len(sample):
        return "utf-16-be"
    try:
        # to be continued: a letter cut in two at the end is no sign of another encoding
        codecs.getincrementaldecoder("utf-8")().decode(content)
    except UnicodeDecodeError:
        in_pairs = all(len(run) % 2 == 0 for run in _LETTERS.findall(content))
        return "gb18030" if in_pairs else "latin-1"
    return "utf-8"
