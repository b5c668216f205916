"""Whatever a board sends, a store or model holds or a name is made of: no traceback, no script."""

import copy
import json
from array import array
from html.parser import HTMLParser

from hypothesis import given
from hypothesis import strategies as st
from zerorate.storage import codes
from zerorate.storage import store as stores
from zerorate_fakes.memory import FakeMemory
from zerorate_tools.boards import port
from zerorate_tools.boards.connection import BoardError
from zerorate_tools.boards.frames import encode
from zerorate_tools.boards.recorder import Recorded, Recorder
from zerorate_tools.model import build_model, encoded, from_json, to_json
from zerorate_tools.recordings import read_recording, write_recording
from zerorate_tools.report.page import _environment, markup, script_json

from ..tools.test_model import SCALES, SLOTS
from .patience import PATIENT
from .test_any_bytes import JSON, reads_or_refuses

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
    batches = []
    recorder = Recorder(batches.append, 10000.0, Recorded())
    ended = port.BoardStream(Sent(pieces), "port").record(recorder, None, lambda seconds: None)
    assert isinstance(ended, BoardError) and "\n" not in str(ended)
    recorder.flush()


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


@PATIENT
@given(ANY_TEXT, ANY_TEXT)
def test_any_names_in_scales(tmp_path, sensor, key):
    scales = {"odr_hz": 1, "gyro_lsb_per_dps": 1, key: sensor, "sensor": sensor}
    (tmp_path / "x.csv").write_text("t_us,gx,gy,gz\n1,2,3,4\n")
    (tmp_path / "x.json").write_text(json.dumps(scales))

    def copied():
        recording = read_recording(tmp_path / "x.csv")
        write_recording(recording, tmp_path / "y.parquet")
        assert script_json(recording.scales.to_json()).encode()
        assert build_model([], recording.scales)

    reads_or_refuses(copied)
