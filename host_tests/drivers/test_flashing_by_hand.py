"""What flashing sends, byte by byte: its programs run on this host, in a folder of their own."""

from contextlib import redirect_stdout
from functools import cache
from io import StringIO
from pathlib import Path, PurePosixPath
from types import SimpleNamespace

import pytest
from zerorate_tools.boards import flashing
from zerorate_tools.boards.connection import BoardFacts, ask
from zerorate_tools.boards.parts import chosen_parts, heap_needed, part_files

FACTS = BoardFacts("a board", (1, 24, 0), (6, 3), "x64", 100_000, 1_000_000)
MAIN = PurePosixPath("main.py")


class HostBoard:
    """A raw REPL that is this host; programs: what was sent."""

    def __init__(self, has_crc):
        self._names, self._has_crc, self.programs = {}, has_crc, []

    def exec_raw(self, program, timeout):
        self.programs.append(program)
        with redirect_stdout(StringIO()) as said:
            exec(program, self._names)
        if not self._has_crc:
            self._names["crc32"] = None
        return said.getvalue().encode(), b""

    def fs_readfile(self, path):
        return bytearray(Path(path).read_bytes())


@cache
def texts(parts):
    return {name: path.read_bytes() for name, path in part_files(parts).items()}


@pytest.fixture(params=[True, False], ids=["crc", "no crc"])
def flashed(request, tmp_path, monkeypatch):
    """flashed(parts, only, **extra files) -> what came of it and the programs that did it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(flashing, "ask", lambda board: FACTS)
    monkeypatch.setattr(flashing, "board_files", lambda parts, facts, code: texts(tuple(parts)))

    def run(parts=(), only=False, extra=None):
        board = HostBoard(request.param)
        installer = flashing.Installer(board, "port", lambda line: None)
        return installer.install(chosen_parts(parts), extra or {}, only), board.programs

    return run


def there():
    return {
        PurePosixPath(path): path.stat().st_size for path in Path().rglob("*") if path.is_file()
    }


def test_every_file_is_there_and_was_counted_once(flashed):
    done, _ = flashed()
    assert there() == done.files
    assert sorted(done.sent) == sorted(done.files)
    assert done.sent_bytes == done.total == sum(there().values())
    assert all(name.parts[0] == "lib" for name in done.files)


@pytest.mark.parametrize("size", [0, 1, 1535, 1536, 1537, 5000])
def test_a_file_of_any_size_arrives_byte_by_byte(flashed, size):
    data = bytes(at % 251 for at in range(size))
    done, _ = flashed(extra={MAIN: data})
    assert Path(MAIN).read_bytes() == data and done.files[MAIN] == size
    again, _ = flashed(extra={MAIN: data})
    assert (again.sent, again.sent_bytes) == ([], 0)
    more, _ = flashed(extra={MAIN: data + b"x"})
    assert (more.sent, more.sent_bytes) == ([MAIN], size + 1)
    assert Path(MAIN).read_bytes() == data + b"x" and there() == more.files


def test_one_changed_byte_is_sent_anew_and_the_rest_of_its_package_is_copied(flashed):
    first, _ = flashed()
    name = max(first.files, key=first.files.get)
    before = Path(name).read_bytes()
    Path(name).write_bytes(before[:-1] + bytes([before[-1] ^ 1]))
    again, _ = flashed()
    assert (again.sent, again.sent_bytes) == ([name], len(before))
    assert Path(name).read_bytes() == before and there() == first.files


def test_what_an_attempt_left_is_used_and_what_it_should_not_have_sent_goes(flashed):
    first, _ = flashed()
    Path("zerorate.new").mkdir()
    Path("lib/zerorate").rename("zerorate.new/zerorate")
    Path("zerorate.new/zerorate/other.py").write_text("of another version")
    again, _ = flashed()
    assert again.sent == [] and there() == first.files


def test_a_part_that_is_not_named_stays_and_goes_with_only(flashed):
    both = {*flashed(["bursts"])[0].files}
    assert {*flashed()[0].files} == both == {*there()}
    rest = {*flashed(only=True)[0].files}
    assert rest < both and {*there()} == rest


def test_no_command_is_too_long_for_a_small_board(flashed):
    _, programs = flashed(extra={MAIN: bytes(20_000)})
    puts = [program for program in programs[1:] if "put(" in program]
    assert max(map(len, puts)) < 4000 and len(puts) < 400


@pytest.mark.parametrize(
    ("number", "mpy", "architecture"),
    [
        (0x1306, (6, 3), "armv6m"),
        (0x2E06, (6, 2), "rv32imc"),
        (0x0006, (6, 0), ""),
        (0x3506, (6, 1), ""),
        (0, (0, 0), ""),
    ],
)
def test_a_board_says_what_it_loads_by_one_number(number, mpy, architecture):
    said = repr(("Pico", (1, 24, 1), number, 190_000, 800_000)).encode()
    facts = ask(SimpleNamespace(exec_raw=lambda program, timeout: (said, b"")))
    assert facts == BoardFacts("Pico", (1, 24, 1), mpy, architecture, 190_000, 800_000)


@pytest.mark.parametrize("short", [0, 1])
def test_a_board_with_too_little_heap_is_told(short):
    needed = heap_needed(["rest"], "")
    facts = BoardFacts(version=(1, 24, 0), heap_free=needed - short)
    lines = flashing.room(facts, ["rest"], 40_000)
    assert any("more heap than" in line for line in lines) == bool(short)
    assert not any("flash" in line for line in lines)
