"""The compiled kernels of a replay: where they are made and kept, and what runs without them."""

import errno
import tempfile
from concurrent.futures import ThreadPoolExecutor

import pytest
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.kernels import library as library_module
from zerorate_tools.kernels.library import library as compiled_library
from zerorate_tools.replay import engines, replay
from zerorate_tools.simulate import simulate

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


def test_without_a_compiler_the_replay_runs_on_cpython_and_says_so_once(minute, untried, capsys):
    def none():
        raise MissingRuntime("no C compiler here")

    untried.setattr(engines, "library", none)
    plain = replay(minute, runtime="cpython").state
    assert [replay(minute, runtime="native").state for _ in range(2)] == [plain, plain]
    assert capsys.readouterr().err.count("no C compiler here; the replay runs on plain CPy") == 1


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
    compile_, compiled = library_module._compile, []

    def counted(command, text, target):
        compiled.append(target)
        compile_(command, text, target)

    untried.setenv("ZERORATE_CACHE", str(tmp_path))
    untried.setattr(library_module, "_compile", counted)
    with ThreadPoolExecutor(4) as threads:
        found = {id(library) for library in threads.map(lambda _: compiled_library(), range(4))}
    assert (len(found), len(compiled)) == (1, 1)


def test_without_a_place_to_compile_the_replay_runs_on_cpython(minute, tmp_path, untried, capsys):
    def full(*arguments):
        raise OSError(errno.ENOSPC, "No space left on device")

    untried.setenv("ZERORATE_CACHE", str(tmp_path))
    untried.setattr(library_module, "_compile", full)
    assert replay(minute, runtime="native").state == replay(minute, runtime="cpython").state
    assert capsys.readouterr().err.count("No space left on device; the replay runs on plain") == 1


def test_a_library_that_the_full_cache_has_no_room_to_link_is_compiled_elsewhere(
    tmp_path, untried, capsys
):
    compile_ = library_module._compile

    def no_room_in_the_cache(command, text, target):
        if tmp_path in target.parents:
            raise ZerorateError("the kernels do not compile here: ld: No space left on device")
        compile_(command, text, target)

    untried.setenv("ZERORATE_CACHE", str(tmp_path))
    untried.setattr(library_module, "_compile", no_room_in_the_cache)
    assert compiled_library().zerorate_run
    assert "compiled for this run" in capsys.readouterr().err


@pytest.mark.parametrize(("machine", "number"), [("amd64", 0x8664), ("arm64", 0xAA64)])
def test_a_library_for_windows_is_made_here_and_shows_what_python_calls(tmp_path, machine, number):
    head = library_module.own_text("rows.c").split("SHOWN void")[0]
    text = f"#include <stdint.h>\n{head}SHOWN int32_t shown(int32_t a) {{ return 3 * a; }}\n"
    text += "int32_t hidden(int32_t a) { return a; }\n"
    made = tmp_path / "kernels.dll"
    data = library_module.cross_compiled(text, ("win32", machine), made).read_bytes()
    at = int.from_bytes(data[60:64], "little")
    assert (data[:2], data[at : at + 4]) == (b"MZ", b"PE\0\0")
    assert int.from_bytes(data[at + 4 : at + 6], "little") == number
    assert b"\0shown\0" in data and b"hidden" not in data
