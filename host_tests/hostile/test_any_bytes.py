"""Whatever bytes a file holds, it ends in a recording or in one line: never in a traceback."""

import copy
import json
import os
import subprocess
import sys
from array import array
from contextlib import suppress
from html.parser import HTMLParser
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.database import DirectoryBasedExampleDatabase
from zerorate.storage import codes
from zerorate.storage import store as stores
from zerorate_bench.foreign_logs.world import World
from zerorate_fakes.memory import FakeMemory
from zerorate_tools.boards import port
from zerorate_tools.boards.connection import BoardError
from zerorate_tools.boards.port import encode
from zerorate_tools.boards.recorder import Recorder
from zerorate_tools.errors import BadRecording, ZerorateError
from zerorate_tools.importers import Options, import_recording, read_foreign
from zerorate_tools.model import build_model, encoded, from_json, to_json
from zerorate_tools.recordings import (
    read_recording,
)
from zerorate_tools.report.page import _environment, markup, script_json
from zerorate_tools.simulate import simulate

from ..tools.test_model import SCALES, SLOTS
from .many_logs import FORMATS

#: How long the fuzz targets try: briefly among the tests, for hours by `make fuzz`.
EXAMPLES = int(os.environ.get("ZERORATE_FUZZ", "30"))
# what once failed is kept in seeds/ and tried first
PATIENT = settings(
    max_examples=EXAMPLES,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    database=DirectoryBasedExampleDatabase(Path(__file__).parent / "seeds"),
)
NAMES = ("t_us", "gx", "gy", "gz")
CELLS = st.one_of(
    st.integers(-(10**12), 10**12).map(str),
    st.floats().map(str),
    st.sampled_from(["", " ", "nan", "-", "1e3", '"', "0x10", "1,2", "\t", "\x00", "é"]),
)


def reads_or_refuses(read, *arguments, **options):
    """Run it: what it raises must be one line of ours."""
    try:
        read(*arguments, **options)
    except ZerorateError as error:
        assert "\n" not in str(error)


@PATIENT
@given(st.lists(st.lists(CELLS, min_size=3, max_size=5), max_size=5))
def test_any_cells_in_a_csv(tmp_path, rows):
    text = "\n".join([",".join(NAMES), *(",".join(row) for row in rows)])
    (tmp_path / "x.csv").write_text(text)
    (tmp_path / "x.json").write_text('{"sensor": "X", "odr_hz": 1, "gyro_lsb_per_dps": 1}')
    reads_or_refuses(read_recording, tmp_path / "x.csv")
    reads_or_refuses(
        import_recording, tmp_path / "x.csv", tmp_path / "y.csv", units={"gyro": "dps"}
    )


@PATIENT
@given(st.binary(max_size=300), st.sampled_from(["x.csv", "x.csv.gz", "x.parquet"]))
def test_any_bytes_as_a_recording(tmp_path, content, name):
    (tmp_path / name).write_bytes(content)
    (tmp_path / "x.json").write_bytes(content[:50])
    reads_or_refuses(read_recording, tmp_path / name)


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
)


@PATIENT
@given(JSON | st.fixed_dictionaries({"sensor": JSON, "odr_hz": JSON, "gyro_lsb_per_dps": JSON}))
def test_any_json_as_scales(tmp_path, scales):
    (tmp_path / "x.csv").write_text(",".join(NAMES) + "\n1,2,3,4\n")
    (tmp_path / "x.json").write_text(json.dumps(scales))
    reads_or_refuses(read_recording, tmp_path / "x.csv")


LETTERS = st.text('0123456789.,;|\t\n #$*-+:eETZgxyzt_us"', max_size=400)


@PATIENT
@given(LETTERS, st.sampled_from(["utf-8", "utf-16", "latin-1"]), st.sampled_from([None, 10.0]))
def test_any_text_as_a_foreign_table(tmp_path, text, encoding, hz):
    head = "t_us,gx_dps,gy_dps,gz_dps\n1,2,3,4\n" if len(text) % 2 else ""
    (tmp_path / "x.csv").write_bytes((head + text).encode(encoding))
    out = tmp_path / "out.parquet"
    reads_or_refuses(import_recording, tmp_path / "x.csv", out, options=Options(hz=hz))


FOREIGN = ["x.csv", "x.tsv", "x.csv.gz", "x.parquet", "x"]


@PATIENT
@given(st.binary(min_size=1, max_size=300), st.sampled_from(FOREIGN))
def test_any_bytes_as_a_foreign_recording(tmp_path, content, name):
    (tmp_path / name).write_bytes(content)
    reads_or_refuses(
        import_recording, tmp_path / name, tmp_path / "out.csv", options=Options(hz=10)
    )


@PATIENT
@given(
    st.dictionaries(
        st.sampled_from(["sensor", "bias", "noise", "session", "effect", "channels", "seed", "x"]),
        JSON,
    )
)
def test_any_description(tmp_path, entries):
    reads_or_refuses(simulate, {"every_session": {"s": 1.0}, **entries})


def test_any_damage_of_a_log_ends_in_words(repository):
    words = ["-m", "host_tests.hostile.many_logs", "--times", str(-(-EXAMPLES // 3)), "--seed", "1"]
    done = subprocess.run([sys.executable, *words], cwd=repository, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("name", ["ulog", "dataflash", "blackbox"])
def test_libraries_say_nothing_on_the_terminal(tmp_path, capfd, name):
    source = FORMATS[name][0](tmp_path, World(60))
    content = bytearray(source.read_bytes())
    middle = len(content) // 2
    content[middle : middle + 40] = bytes(range(40))
    source.write_bytes(content)
    with suppress(BadRecording):
        read_foreign(source)
    assert capfd.readouterr() == ("", "")


STARTS = {
    "x.ulg": b"ULog\x01\x12\x35\x01" + bytes(8),
    "x.mcap": b"\x89MCAP0\r\n",
    "x.bag": b"#ROSBAG V2.0\n",
    "x.bin": b"\xa3\x95\x80",
    "x.bbl": b"H Product:Blackbox flight data\n",
}


def processor_s():
    """Seconds of processor that this process and its children have taken."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


@pytest.mark.parametrize("name", [*STARTS, "none.ulg", "none.mcap"])
def test_gigabytes_of_zeros_are_refused_after_their_start(tmp_path, name):
    with open(tmp_path / name, "wb") as file:
        file.write(STARTS.get(name, b""))
        file.truncate(3 << 30)
    began_s = processor_s()
    with pytest.raises(BadRecording, match=name):
        read_foreign(tmp_path / name)
    assert processor_s() - began_s < 20, "a child alone may take a minute"


ANY_TEXT = st.text(st.characters())  # halves of characters, too, which JSON can hold
HEADER = {"odr_hz": 100, "gyro_lsb_per_dps": 131, "accel_lsb_per_g": 1, "temp_lsb_per_degc": 1}
HEADER |= {"temp_offset_degc": 0, "part": "X"}
ANY_HEADER = st.dictionaries(st.sampled_from([*HEADER, "binding"]), JSON).map(HEADER.__or__)
PAYLOADS = (JSON | ANY_HEADER).map(lambda v: json.dumps(v).encode()[:255]) | st.binary(max_size=30)
FRAMES = st.builds(encode, st.sampled_from([1, 1, 2, 2, 3, 9]), PAYLOADS)
SAMPLES = st.builds(encode, st.just(1), st.binary(min_size=21, max_size=21))


class Sent:
    """A serial port on which these pieces come, and then nothing."""

    def __init__(self, pieces):
        self.pieces = list(pieces)

    @property
    def in_waiting(self):
        return len(self.pieces[0]) if self.pieces else 0

    def read(self, count):
        return self.pieces.pop(0) if self.pieces else b""


@PATIENT
@given(st.lists(FRAMES | SAMPLES | st.binary(min_size=1, max_size=40), max_size=8))
def test_any_bytes_from_a_board(monkeypatch, pieces):
    monkeypatch.setattr(port, "_SILENCE_S", 0.0)
    reads_or_refuses(port.BoardStream(Sent(pieces), "port").scales)
    recorder = Recorder([], 10000.0)
    ended = port.BoardStream(Sent(pieces), "port").record(recorder, None, lambda seconds: None)
    assert isinstance(ended, BoardError) and "\n" not in str(ended)


def anywhere(draw, values):
    """A place in nested values, as (container, key)."""
    while True:
        keys = list(values) if isinstance(values, dict) else range(len(values))
        key = draw(st.sampled_from(sorted(keys)))
        if not (isinstance(values[key], dict | list) and values[key] and draw(st.booleans())):
            return values, key
        values = values[key]


@PATIENT
@given(st.data())
def test_any_value_anywhere_in_a_model(data):
    values = copy.deepcopy(MODEL)
    for _ in range(data.draw(st.integers(1, 3))):
        container, key = anywhere(data.draw, values)
        container[key] = data.draw(JSON | ANY_TEXT | st.integers())
    reads_or_refuses(lambda: encoded(from_json(json.dumps(values))))


MODEL = json.loads(to_json(build_model(SLOTS, SCALES)))


@PATIENT
@given(st.binary(min_size=160, max_size=160), st.binary(max_size=8), st.integers(0, 255))
def test_any_bytes_in_a_store_behind_a_right_beginning(noise, start, version):
    memory, payload = FakeMemory(200), array("i", [99] * 12)
    memory.bytes[:160] = noise
    memory.bytes[72 : 76 + len(start)] = b"ZRS\x01" + start
    store = stores.Store(memory, b"\x68\0\0\3", 48, version)
    assert store.load(payload) != codes.LOADED and set(payload) == {99}
    assert store.save(array("i", range(12))) and store.load(payload) == codes.LOADED


class Elements(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, [name for name, _ in attributes]))


@PATIENT
@given(st.text() | st.text("<>&'\"/ =!-{}%$scriptonlad\u2028\u2029"))
def test_any_name_on_a_page(name):
    page = '<p title="{{ name }}">{{ name }}</p><script>{{ data|safe }}</script><b>'
    text = _environment().from_string(page).render(name=name, data=script_json([name]))
    assert Elements(text).found == [("p", ["title"]), ("script", []), ("b", [])]
    assert Elements(markup(name)).found == []
