"""Small files that claim or unpack to gigabytes: no reader takes more than 600 MB for any."""

import gzip
import json
import os
import struct
import subprocess
import sys
import zlib

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="its limits are Linux's")
MOST_MB = 600
_UNPACKED_MB = 1600
_RUN = """
import resource, sys
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import Options, import_recording
from zerorate_tools.recordings import open_recording
what, source, out = sys.argv[1:]
try:
    if what == "import":
        import_recording(source, out, options=Options(hz=100), units={"gyro": "dps"})
    else:
        for batch in open_recording(source).batches():
            pass
    print("read")
except ZerorateError as error:
    print(error)
# ru_maxrss of this process would be that of the one that began it
own = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(int(own.split()[1]) + resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def taken(what, source, tmp_path):
    """(what it said, MB at most) of reading a file in a process of its own and its children's."""
    command = [sys.executable, "-c", _RUN, what, str(source), str(tmp_path / "out.parquet")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    *said, peak_kb = done.stdout.splitlines()
    assert len(said) == 1
    bomb = os.environ["PYTEST_CURRENT_TEST"].partition("::test_")[2].partition("[")[0]
    print(f"\n{bomb.partition(' ')[0]}, {what}: at most {int(peak_kb) / 1024:.0f} MB", end="")
    return said[0], int(peak_kb) / 1024


def packed(path, start, repeated, megabytes=_UNPACKED_MB):
    """A gzip of `start` and then of as many megabytes of what is repeated."""
    block = gzip.compress(repeated * ((16 << 20) // len(repeated)))
    path.write_bytes(gzip.compress(start) + block * (megabytes // 16))
    path.with_name(path.name.replace(".csv.gz", ".json")).write_text(
        json.dumps({"sensor": "X", "odr_hz": 100, "gyro_lsb_per_dps": 131})
    )
    return path


@pytest.mark.parametrize("what", ["import", "open"])
@pytest.mark.parametrize(
    ("start", "complaint"),
    [
        (b"t_us,gx", "no line ends within the first"),
        (b"t_us,gx,gy,gz\n1,2,3,4\n2,", "a row is longer than"),
    ],
)
def test_a_line_without_an_end(tmp_path, what, start, complaint):
    source = packed(tmp_path / "x.csv.gz", start, b"a")
    assert source.stat().st_size < 7_000_000
    said, peak_mb = taken(what, source, tmp_path)
    assert complaint in said
    assert peak_mb < MOST_MB


@pytest.mark.parametrize("what", ["import", "open"])
def test_rows_without_an_end(tmp_path, what):
    source = packed(tmp_path / "x.csv.gz", b"t_us,gx,gy,gz\n", b"1,2,3,4\n", megabytes=160)
    said, peak_mb = taken(what, source, tmp_path)
    assert said == "read"
    assert peak_mb < MOST_MB


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A Parquet file with one page a column, that of its times of half a gigabyte."""
    path = tmp_path_factory.mktemp("page") / "x.parquet"
    zeros = pa.array(np.zeros(1 << 26, np.int64))
    table = pa.table({"t_us": zeros} | dict.fromkeys(("gx", "gy", "gz"), zeros.cast(pa.int8())))
    scales = b'{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}'
    pq.write_table(
        table.replace_schema_metadata({b"zerorate": scales}), path,
        compression="zstd", use_dictionary=False, data_page_size=1 << 31, row_group_size=1 << 30,
        write_batch_size=1 << 28, column_encoding=dict.fromkeys(table.column_names, "PLAIN"),
        max_rows_per_page=1 << 30,
    )  # fmt: skip
    return path


@pytest.mark.parametrize("what", ["import", "open"])
def test_a_page_of_parquet_that_unpacks_to_half_a_gigabyte(tmp_path, page, what):
    said, peak_mb = taken(what, page, tmp_path)
    assert "a page of it takes more than" in said
    assert peak_mb < MOST_MB


def test_a_mat_that_unpacks_to_a_gigabyte(tmp_path):
    rows = 100_000_000
    array = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, rows, 1)
    array += struct.pack("<II", 1, 1) + b"g" + bytes(7) + struct.pack("<II", 9, rows * 8)
    packer = zlib.compressobj(1)
    body = packer.compress(struct.pack("<II", 14, len(array) + rows * 8) + array)
    block = bytes(16 << 20)
    body += b"".join(packer.compress(block) for _ in range(rows * 8 // len(block))) + packer.flush()
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
    (tmp_path / "x.mat").write_bytes(header + struct.pack("<II", 15, len(body)) + body)
    said, peak_mb = taken("import", tmp_path / "x.mat", tmp_path)
    assert "needs more than 400 MB to be read; cut it into parts" in said
    assert peak_mb < MOST_MB


def test_a_sidecar_of_gigabytes(tmp_path):
    (tmp_path / "x.csv").write_text("t_us,gx,gy,gz\n1,2,3,4\n")
    with open(tmp_path / "x.json", "wb") as file:
        file.truncate(4 << 30)
    said, peak_mb = taken("open", tmp_path / "x.csv", tmp_path)
    assert "more than 1 MiB" in said
    assert peak_mb < MOST_MB
