"""The compiled kernels of a replay: where they are made and kept, and what runs without them."""

import errno
import tempfile
from concurrent.futures import ThreadPoolExecutor
from unittest.mock import Mock

import pytest
from zerorate import Corrector
from zerorate.model import EffectModel
from zerorate.storage.learned_store import LearnedStore
from zerorate_fakes.memory import FakeMemory
from zerorate_tools.cli import main
from zerorate_tools.errors import InFile, MissingRuntime, ZerorateError
from zerorate_tools.kernels import library as library_module
from zerorate_tools.kernels.library import library as compiled_library
from zerorate_tools.layout import STATE
from zerorate_tools.model import build_model, encoded
from zerorate_tools.replay import engines, replay
from zerorate_tools.replay.replaying import state_bytes
from zerorate_tools.replay.state_in_words import Word, in_words, words_of_file
from zerorate_tools.simulate import simulate

from ..tools.test_model import SCALES, SLOTS
from .test_replay import DESCRIPTION


@pytest.fixture(scope="module")
def minute():
    return simulate(DESCRIPTION)[0].between(0, 3000)


@pytest.fixture
def untried(monkeypatch):
    """As in a process that has not asked for the compiled kernels yet."""
    engines.compiled.cache_clear()
    library_module._library.cache_clear()
    yield monkeypatch
    engines.compiled.cache_clear()
    library_module._library.cache_clear()


@pytest.mark.parametrize(
    ("at", "name", "problem"),
    [
        (engines, "library", MissingRuntime("no C compiler here")),
        (library_module, "compile_library", OSError(errno.ENOSPC, "No space left on device")),
    ],
)
def test_where_nothing_compiles_the_replay_runs_on_cpython_and_says_so_once(
    minute, tmp_path, untried, capsys, at, name, problem
):
    untried.setenv("ZERORATE_CACHE", str(tmp_path))
    untried.setattr(at, name, Mock(side_effect=problem))
    plain = replay(minute, runtime="cpython").state
    assert [replay(minute, runtime="native").state for _ in range(2)] == [plain, plain]
    said = capsys.readouterr().err
    assert said.count(f"{problem.args[-1]}; the replay runs on plain CPython") == 1


def test_a_library_is_compiled_anew_where_no_cache_can_be_written(tmp_path, untried, capsys):
    (tmp_path / "file").write_text("")
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    untried.setattr(tempfile, "tempdir", str(scratch))
    untried.setenv("ZERORATE_CACHE", str(tmp_path / "file"))
    assert compiled_library().zerorate_run
    assert capsys.readouterr().err.count("no cache can be kept (Not a directory)") == 1
    assert not list(scratch.iterdir())


def test_threads_that_ask_together_compile_it_once(tmp_path, untried):
    compile_, compiled = library_module.compile_library, []

    def counted(command, text, target):
        compiled.append(target)
        compile_(command, text, target)

    untried.setenv("ZERORATE_CACHE", str(tmp_path))
    untried.setattr(library_module, "compile_library", counted)
    with ThreadPoolExecutor(4) as threads:
        found = {id(library) for library in threads.map(lambda _: compiled_library(), range(4))}
    assert (len(found), len(compiled)) == (1, 1)


def test_a_library_that_the_full_cache_has_no_room_to_link_is_compiled_elsewhere(
    tmp_path, untried, capsys
):
    compile_ = library_module.compile_library

    def no_room_in_the_cache(command, text, target):
        if tmp_path in target.parents:
            raise ZerorateError("the kernels do not compile here: ld: No space left on device")
        compile_(command, text, target)

    untried.setenv("ZERORATE_CACHE", str(tmp_path))
    untried.setattr(library_module, "compile_library", no_room_in_the_cache)
    assert compiled_library().zerorate_run
    assert "compiled for this run" in capsys.readouterr().err


def test_a_wheel_has_a_library_of_each_system_and_no_older_one(tmp_path, untried):
    untried.setattr(library_module, "_PREBUILT", tmp_path / "prebuilt")

    def compiled(text, system, target):
        target.write_text(" ".join(system))
        return target

    untried.setattr(library_module, "cross_compiled", compiled)
    for _ in range(2):
        paths = library_module.prebuild()
        assert paths == sorted((tmp_path / "prebuilt").iterdir())
        (tmp_path / "prebuilt" / "older.so").touch()
    told = {path.name.partition("-")[2]: path.read_text() for path in paths}
    assert told == {
        "linux-x86_64.so": "linux x86_64",
        "linux-aarch64.so": "linux aarch64",
        "darwin-x86_64.dylib": "darwin x86_64",
        "darwin-arm64.dylib": "darwin arm64",
        "win32-amd64.dll": "win32 amd64",
        "win32-arm64.dll": "win32 arm64",
    }


def test_a_library_for_windows_is_made_here_and_shows_what_python_calls(tmp_path):
    text = library_module.text_of("sample.c", "rows.c")  # which no C library helps there
    made = tmp_path / "kernels.dll"
    data = library_module.cross_compiled(text, ("win32", "arm64"), made).read_bytes()
    at = int.from_bytes(data[60:64], "little")
    assert (data[:2], data[at : at + 4]) == (b"MZ", b"PE\0\0")
    assert int.from_bytes(data[at + 4 : at + 6], "little") == 0xAA64
    assert b"\0zerorate_run\0" in data and b"begin_traversal" not in data


@pytest.fixture
def corrector():
    return Corrector()


def by_name(path, **options):
    return {word.name: word for word in words_of_file(path, options)}


def test_words_are_shown_in_their_units_and_codes_by_name():
    words = [
        Word("state", 4, "FRAME[0]", 3, "LSB"),
        Word("state", 63, "OUT_Q8[1]", -384, "LSB"),
        Word("state", 80, "SOURCE[0]", 4, "code SOURCE"),
        Word("state", 81, "SOURCE[1]", 99, "code SOURCE"),
        Word("motion", 0, "MEAN_Q14", 8192, ""),
        Word("motion", 1, "WORK", 7, ""),
    ]
    assert [" ".join(line.split()) for line in in_words(words).splitlines()] == [
        "state: word, name, raw, in its unit",
        "4 FRAME[0] 3 3 LSB",
        "63 OUT_Q8[1] -384 -1.5 LSB",
        "80 SOURCE[0] 4 IN_MOTION",
        "81 SOURCE[1] 99 no such code",
        "motion: word, name, raw, in its unit",
        "0 MEAN_Q14 8192 0.5",
        "1 WORK 7",
    ]


def test_the_words_of_a_model_are_those_of_its_slots(tmp_path, corrector):
    model = EffectModel()
    model.load(encoded(build_model(SLOTS, SCALES)), corrector.sensor)
    corrector.use_model(model)
    (tmp_path / "s.bin").write_bytes(state_bytes(corrector))
    assert by_name(tmp_path / "s.bin")["SLOTS[0].SLOT_POWER"].raw == 2


def test_of_a_store_the_newest_whole_record_counts(tmp_path, corrector, capsys):
    memory = FakeMemory(1 << 16)
    store = LearnedStore(memory, b"\x68\0\0\0", corrector)
    for value in (256, 512):
        corrector.state[STATE.OUT_Q8] = value
        assert store.save()
    path = tmp_path / "learned.bin"
    path.write_bytes(memory.bytes)
    assert main(["state", "show", str(path), "--find", "out_q8[0]"]) == 0
    shown = [str(STATE.OUT_Q8), "OUT_Q8[0]", "512", "2", "LSB"]
    assert capsys.readouterr().out.split()[-5:] == shown
    assert main(["state", "show", str(path), "--find", "nosuch"]) == 2
    assert "nosuch" in capsys.readouterr().err
    assert store.save_model(b"ZRM")  # a record of another kind
    path.write_bytes(memory.bytes)
    assert by_name(path)["WINDOW"].raw == 32  # of the settings, which are stored, too
    damaged = bytearray(memory.bytes)
    damaged[store.state.slot_bytes + 100] ^= 1
    path.write_bytes(damaged)
    assert by_name(path)["OUT_Q8[0]"].raw == 256
    damaged[100] ^= 1
    path.write_bytes(damaged)
    with pytest.raises(InFile, match="no state of this store is whole"):
        words_of_file(path)


def test_a_file_of_another_size_says_what_to_do(tmp_path, capsys):
    (tmp_path / "s.bin").write_bytes(bytes(40))
    assert main(["state", "show", str(tmp_path / "s.bin")]) == 2
    assert f"40 bytes where a state with these settings has {4 * len(Corrector().state)}" in (
        capsys.readouterr().err
    )
