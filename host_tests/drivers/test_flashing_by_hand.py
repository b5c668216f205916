"""What flashing sends, byte by byte: its programs run on this host, in a folder of their own."""

import os
import pty
import re
from contextlib import nullcontext, redirect_stdout
from functools import cache
from io import StringIO
from pathlib import Path, PurePosixPath
from types import SimpleNamespace

import pytest
from zerorate_tools import cli
from zerorate_tools.boards import compiling, flashing
from zerorate_tools.boards.connection import BoardError, BoardFacts, ask, connected, listening
from zerorate_tools.boards.parts import REST, chosen_parts, heap_needed, needs, part_files
from zerorate_tools.errors import ZerorateError
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

mpremote = pytest.importorskip("mpremote.transport")

FACTS = BoardFacts("a board", (1, 24, 0), (6, 3), "x64", 100_000, 1_000_000)
MAIN = PurePosixPath("main.py")


class HostBoard:
    """A raw REPL that is this host; programs: what was sent."""

    def __init__(self, has_crc):
        self._names, self._has_crc, self.programs = {}, has_crc, []

    def exec_raw(self, program, timeout):
        assert timeout == 120
        self.programs.append(program)
        with redirect_stdout(StringIO()) as said:
            exec(program, self._names)
        if not self._has_crc:
            self._names["crc32"] = None
        return said.getvalue().encode(), b""

    def fs_readfile(self, path):
        assert not self._has_crc, "what a board works out is not read back"
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
        run.said = []
        installer = flashing.Installer(board, "port", run.said.append)
        return installer.install(chosen_parts(parts), extra or {}, only), board.programs

    return run


def there():
    return {
        PurePosixPath(path): path.stat().st_size for path in Path().rglob("*") if path.is_file()
    }


def test_every_file_is_there_and_was_counted_once(flashed):
    done, _ = flashed()
    for _ in range(2):  # written, and the same already
        told = (re.match(r" *(\d+)  (lib/\S+)  \w", line) for line in flashed.said)
        assert {PurePosixPath(one[2]): int(one[1]) for one in told if one} == done.files
        flashed()
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
    assert Path(MAIN).read_bytes() == data + b"x"
    flashed(extra={MAIN: b"another"})  # the first one was the user's own
    assert Path("main.old.py").read_bytes() == data and len(there()) == len(more.files) + 1


def test_a_dry_run_writes_nothing_and_counts_what_would_be_there(flashed, monkeypatch, tmp_path):
    monkeypatch.setattr(flashing, "connected", lambda port: nullcontext(HostBoard(True)))
    slot = Slot(Term("temp", 20, 45, 32.5, power=2), (0.001, -0.002, 0.0003))
    scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
    own = tmp_path.with_name("own")
    readable, binary = write_model(build_model([slot], scales), own)
    main, said = own / "a program.py", []
    main.write_bytes(b"1" * 99)
    options = {"main": main, "model": readable, "say": said.append, "parts": ["bursts"]}
    dry = flashing.flash("port", dry_run=True, **options)
    assert there() == {} and dry.sent == []
    done = flashing.flash("port", **options)
    assert there() == done.files == dry.files and done.files[MAIN] == 99
    assert Path("model.bin").read_bytes() == binary.read_bytes()
    assert {Path("lib/zerorate/bursts.py"), Path("lib/zerorate/model.py")} <= {*map(Path, there())}
    assert f"{dry.total:,}" in "".join(said) and f"{FACTS.heap_free:,}" in "".join(said)


def test_a_package_that_arrives_damaged_replaces_nothing(flashed, monkeypatch):
    flashed()
    before = {path: path.read_bytes() for path in Path("lib").rglob("*.py")}
    with monkeypatch.context() as patch:
        patch.setattr(flashing, "b64encode", lambda data: b"AAAA")
        with pytest.raises(BoardError, match="did not arrive whole and nothing was replaced"):
            flashed(["motion"])
    assert {path: path.read_bytes() for path in Path("lib").rglob("*.py")} == before
    done, _ = flashed(["motion"])
    assert there() == done.files and len(done.files) > len(before)


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
    Path("lib/zerorate").rename("zerorate")  # it was not put in place any more
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
        (0x1305, (5, 3), "armv6m"),
        (0x2E06, (6, 2), "rv32imc"),
        (0x0006, (6, 0), ""),
        (0x3506, (6, 1), ""),
        (0x3E06, (6, 2), ""),
        (0, (0, 0), ""),
    ],
)
def test_a_board_says_what_it_loads_by_one_number(number, mpy, architecture):
    said = repr(("Pico", (1, 24, 1), number, 190_000, 800_000)).encode()
    facts = ask(SimpleNamespace(exec_raw=lambda program, timeout: (said, b"")))
    assert facts == BoardFacts("Pico", (1, 24, 1), mpy, architecture, 190_000, 800_000)
    assert re.findall(r"\d+(?:\.\d+)+", str(facts)) == ["1.24.1", "{}.{}".format(*mpy)]


@pytest.mark.parametrize("short", [0, 1])
def test_a_board_with_too_little_memory_is_told(short):
    needed = heap_needed(["rest"], "")
    facts = BoardFacts(version=(1, 24, 0), heap_free=needed - short)
    lines = flashing.room(facts, ["rest"], 40_000)
    assert any("more heap than" in line for line in lines) == bool(short)
    assert not any("flash" in line for line in lines)


@pytest.mark.parametrize("runs", [True, False])
def test_machine_code_that_does_not_run_is_done_without(flashed, monkeypatch, runs):
    asked, files = [], texts(("rest",))
    facts = BoardFacts("a board", (1, 24, 0), compiling.mpy_version(), "armv6m")
    monkeypatch.setattr(flashing, "ask", lambda board: facts)
    monkeypatch.setattr(
        *(flashing, "board_files"),
        lambda parts, facts, code: (
            asked.append(code) or {n: files[n] for n in sorted(files)[code == "" :]}
        ),
    )
    monkeypatch.setattr(flashing, "_TRIAL", "pass" if runs else "print('why')")
    done, _ = flashed()
    assert asked == (["thumb"] if runs else ["thumb", ""])
    assert there() == done.files and len(files) - len(there()) == (not runs)
    assert done.sent_bytes == sum(map(len, files.values()))


@pytest.mark.parametrize(
    ("mpy", "architecture", "told"),
    [((6, 1), "armv6m", True), ((6, 2), "rv32imc", True), ((6, 3), "armv6m", False)]
    + [((6, 2), "xtensawin", False), ((5, 0), "armv6m", False), ((6, 4), "armv6m", False)],
)
def test_a_micropython_too_old_for_machine_code_is_told(mpy, architecture, told):
    facts = BoardFacts(version=(1, 22, 0), mpy=mpy, architecture=architecture)
    lines = flashing.older(facts)
    assert bool(lines) == told
    assert compiling.machine_code(facts) == ("thumb" if mpy == (6, 3) else "")
    cycles = needs()["cycles"]
    slower = cycles["bytecode"] / cycles["median"]
    for line in lines:
        assert re.findall(r"\d+\.\d+", line) == ["{}.{}".format(*compiling.mpy_version()), "1.23"]
        assert float(re.search(r"(\d+) times", line)[1]) == pytest.approx(slower, abs=5)


@pytest.mark.parametrize("option", ["main", "model"])
def test_a_file_that_is_not_there_is_one_line_before_anything_is_written(option):
    with pytest.raises(ZerorateError, match="nowhere.*: (no such file|cannot be read)"):
        flashing.flash("/dev/no-such-port", **{option: Path("nowhere")})


@pytest.mark.parametrize("data", [b"imu = (", b"PAR1\0\xff"])
def test_a_main_that_is_no_program_reaches_no_board(tmp_path, data):
    path = tmp_path / "run.parquet"
    path.write_bytes(data)
    with pytest.raises(ZerorateError, match="run.parquet: no Python"):
        flashing.flash("/dev/no-such-port", main=path)


@pytest.mark.parametrize("version", [5, 7])
def test_a_board_of_another_mpy_version_gets_the_source(version):
    found = compiling.board_files([REST], BoardFacts(mpy=(version, 0)))
    assert {name.suffix for name in found} == {".py"}


@pytest.fixture
def pseudo_terminal():
    """(the board's end, the name of the port)."""
    board, slave = pty.openpty()
    os.set_blocking(board, False)
    yield board, os.ttyname(slave)
    os.close(board)
    os.close(slave)


def refused(capsys, port):
    """The line in which `flash` says why the port does not open."""
    assert cli.main(["flash", str(port)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    return line


def test_a_port_that_does_not_open_says_why(capsys, monkeypatch, tmp_path, pseudo_terminal):
    (tmp_path / "a-file").write_text("")
    assert "is not there" in refused(capsys, "/dev/no-such-port")
    assert "is no serial port" in refused(capsys, tmp_path / "a-file")
    assert "is no serial port" in refused(capsys, tmp_path)
    with listening(pseudo_terminal[1]):
        assert "another program has it open" in refused(capsys, pseudo_terminal[1])

    def not_of_its_group(*args, **options):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("serial.Serial.open", not_of_its_group)
    assert "dialout" in refused(capsys, "/dev/ttyACM0")


def test_who_listens_has_the_port_alone_and_sends_nothing(pseudo_terminal):
    board, port = pseudo_terminal
    with listening(port) as serial:
        assert (serial.baudrate, serial.timeout) == (115200, 0.2)
        with pytest.raises(BoardError), listening(port):
            pass
        with pytest.raises(BlockingIOError):
            os.read(board, 1)


class Port:
    """mpremote's transport of a board that answers after some tries; told: what it was told."""

    def __init__(self, tries):
        self.tries, self.patience_s, self.told, self.closed = tries, [], b"", False
        self.serial = SimpleNamespace(write=self.write, flush=lambda: None)

    def write(self, data):
        self.told += data

    def close(self):
        self.closed = True

    def enter_raw_repl(self, soft_reset, timeout_overall):
        self.patience_s.append(timeout_overall)
        if len(self.patience_s) <= self.tries:
            raise mpremote.TransportError("silent")


@pytest.fixture
def port(monkeypatch):
    def made(tries=0):
        port = Port(tries)
        monkeypatch.setattr("mpremote.transport_serial.SerialTransport", lambda *a, **more: port)
        return port

    return made


@pytest.mark.parametrize("tries", range(5))
def test_a_board_is_tried_for_longer_each_time_and_given_up_at_last(port, tries):
    board, used = port(tries), []
    try:
        with connected("port") as transport:
            used.append(transport)
    except BoardError:
        assert tries > 2
    assert used == [board] * (tries < 3) and board.closed
    assert board.patience_s == [3, 10, 30][: tries + 1]


@pytest.mark.parametrize("go_on", [True, False])
def test_a_board_is_left_to_its_own_program_unless_told_otherwise(port, go_on):
    board = port()
    with connected("port", go_on):
        assert board.told == b""
    keys = [key for key in board.told if key != 13]  # Ctrl-C stops, Ctrl-B and Ctrl-D restart
    assert keys == ([3, 3, 2, 4] if go_on else []) and board.closed


@pytest.mark.parametrize(
    ("last", "words"),
    [
        ("MemoryError: memory allocation failed", "docs/boards.md"),
        ("OSError: [Errno 28] ENOSPC", "mpremote rm"),
        ("OSError: 28", "mpremote rm"),
        ("OSError: 5", "OSError: 5$"),
        ("ImportError: no module named 'zerorate_i2c'", "'zerorate_i2c'; zerorate flash sends it"),
    ],
)
def test_the_last_line_of_what_a_program_met_is_told_with_a_remedy(port, last, words):
    port()
    with pytest.raises(BoardError, match=words), connected("port"):
        raise mpremote.TransportExecError(b"", f"Traceback:\n  File x\n{last}\n\n")


def test_a_file_that_does_not_compile_is_told_by_its_name_and_line(tmp_path):
    file = tmp_path / "wrong.py"
    file.write_text("a = 1\nb = (\n")
    with pytest.raises(ZerorateError, match=r"wrong\.py.*SyntaxError"):
        compiling.compiled(file, "wrong")
