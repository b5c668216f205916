"""Damaged logs: any cut and any other bytes end in rows or in one line, and never in a crash."""

import os
import signal

import numpy as np
import pytest
import scipy.io
from hypothesis import given
from hypothesis import strategies as st
from zerorate_bench.foreign_logs import binary as foreign_files
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import parsed_mapping, read_foreign
from zerorate_tools.importers.logs.apart import written

from .patience import EXAMPLES, PATIENT

_LONGEST_S = 20
DAMAGE = st.tuples(
    st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), max_size=6),
    st.none() | st.floats(0, 1),
)


def ulog(folder):
    stamps, rates = np.arange(20) * 4000, np.ones(20)
    topic = {"timestamp": ("uint64_t", stamps)} | dict.fromkeys("xyz", ("float", rates))
    foreign_files.ulog(folder / "x.ulg", {"sensor_gyro": topic})
    return folder / "x.ulg"


def dataflash(folder):
    foreign_files.dataflash(folder / "x.bin", [(i, 0, *[0.5] * 7) for i in range(20)])
    return folder / "x.bin"


def blackbox(folder):
    foreign_files.blackbox(folder / "x.bbl", [(i * 1000, i, -i, 5, 0, 0, 2048) for i in range(20)])
    return folder / "x.bbl"


def matlab(folder):
    variables = {"w": np.ones((20, 3)), "t": np.arange(20.0)}
    scipy.io.savemat(folder / "x.mat", variables, do_compression=False)
    return folder / "x.mat"


SOUND = {
    "ulog": ulog,
    "dataflash": dataflash,
    "blackbox": blackbox,
    "ros_bag": lambda folder: foreign_files.bag(folder / "bag", "ros1"),
    "mcap_file": lambda folder: foreign_files.bag(folder / "bag", "mcap"),
}


@pytest.fixture(scope="module", params=sorted(SOUND))
def sound(request, tmp_path_factory):
    """(reader, a sound file's bytes, where its damaged kin shall be)."""
    source = SOUND[request.param](tmp_path_factory.mktemp(request.param))
    return request.param, source.read_bytes(), source


@pytest.fixture
def impatient():
    """What takes longer than the child's limit would let it is stopped as there."""

    def stop(number, frame):
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, stop)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@PATIENT
@given(DAMAGE)
def test_any_damage_of_a_log_ends_in_words(sound, impatient, damage):
    reader, whole, source = sound
    source.write_bytes(damaged(whole, damage))
    silent = os.open(os.devnull, os.O_WRONLY)
    signal.alarm(_LONGEST_S)
    words = written(reader, source, 0, silent)
    signal.alarm(0)
    assert set(words) in ({"problem", "do"}, {"dropped", "notes"})
    assert "\n" not in words.get("problem", "") and words.get("do", "no word") != ""


def damaged(whole, damage):
    """Other bytes at some places, and a cut."""
    changes, cut = damage
    content = bytearray(whole)
    for share, byte in changes:
        content[int(share * (len(content) - 1))] = byte
    return bytes(content if cut is None else content[: int(cut * len(content))])


WORDS = [parsed_mapping(w) for w in ("t_us=t:s", "gx=w[0]:dps", "gy=w[1]:dps", "gz=w[2]:dps")]


# of the file's 880 bytes, the first 128 of which are a text: some of them, or all
PLACES = range(128, 880, max(1, 5 * (880 - 128) // EXAMPLES))


@pytest.mark.parametrize("place", [176, *PLACES])
def test_a_mat_of_one_damaged_byte_kills_nobody(tmp_path, place):
    source = matlab(tmp_path)
    content = bytearray(source.read_bytes())
    content[place] = 0 if content[place] else 255
    source.write_bytes(content)
    try:
        recording, _ = read_foreign(source, mapping=WORDS)
        assert len(recording) == 20
    except BadRecording as error:
        assert "\n" not in str(error)


def test_libraries_say_nothing_on_the_terminal(tmp_path, capfd):
    for make in (ulog, dataflash, blackbox):
        source = make(tmp_path)
        content = bytearray(source.read_bytes())
        content[len(content) // 2 : len(content) // 2 + 40] = bytes(range(40))
        source.write_bytes(content)
        try:
            read_foreign(source)
        except BadRecording:
            pass
    assert capfd.readouterr() == ("", "")


STARTS = {
    "x.ulg": b"ULog\x01\x12\x35\x01" + bytes(8),
    "x.mcap": b"\x89MCAP0\r\n",
    "x.bag": b"#ROSBAG V2.0\n",
    "x.bin": b"\xa3\x95\x80",
    "x.bbl": b"H Product:Blackbox flight data\n",
}


@pytest.mark.parametrize("name", [*STARTS, "none.ulg", "none.mcap"])
def test_gigabytes_of_zeros_are_refused_after_their_start(tmp_path, impatient, name):
    with open(tmp_path / name, "wb") as file:
        file.write(STARTS.get(name, b""))
        file.truncate(3 << 30)
    signal.alarm(_LONGEST_S)
    with pytest.raises(BadRecording, match=name):
        read_foreign(tmp_path / name)
