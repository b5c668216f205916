"""Watching a recording that somebody else is writing."""

import os
import signal
import subprocess
import sys
import threading
import tty
from contextlib import suppress
from io import StringIO

import numpy as np
import pytest
from rich.console import Console
from rich.live import Live as RichLive
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_tools.boards.bus import stream_bus
from zerorate_tools.cli import main
from zerorate_tools.errors import BadRecording
from zerorate_tools.recordings import growing_recording, write_recording
from zerorate_tools.replay import replay
from zerorate_tools.replay.replaying import state_bytes
from zerorate_tools.simulate import simulate
from zerorate_tools.watch import watch
from zerorate_tools.watch.live import Live, OwnOutput
from zerorate_tools.watch.screen import Area, Lines, WatchOptions, screen
from zerorate_tools.watch.watching import CsvTail, Watcher, is_device

DESCRIPTION = {
    "name": "run",
    "seed": 4,
    "sensor": {"odr_hz": 25.0},
    "bias": {"b0": [1.5, -2.0, 0.5]},
    "every_session": {"temperature": [{"to": 30.0, "minutes": 1}]},
}

_RESTS = {"motion": False, "gravity": False}  # as fast as can be, on a busy machine


@pytest.fixture(scope="module")
def recording():
    return simulate(DESCRIPTION)[0]


@pytest.fixture
def log(tmp_path, recording):
    """A whole CSV and its scales; tests write parts of it elsewhere."""
    path = tmp_path / "whole" / "run.csv"
    path.parent.mkdir()
    write_recording(recording, path)
    return path


def test_every_row_is_read_once_wherever_the_writer_was_interrupted(log, recording):
    text, parts = log.read_bytes(), []
    log.write_bytes(text[:1000])
    tail = CsvTail(log)
    for end in [*range(1777, len(text), 777), len(text)]:
        parts.append(tail.read())
        log.write_bytes(text[:end])
    parts = [columns for columns in (*parts, tail.read()) if columns]
    together = {name: np.concatenate([p[name] for p in parts]) for name in tail.column_names}
    for name, values in recording.columns.items():
        assert (together[name] == values).all()
    assert tail.read() is None


def test_a_file_begun_anew_is_a_new_power_on_and_one_that_goes_away_is_said(log):
    tail = CsvTail(log)
    first = tail.read()
    log.write_bytes(log.read_bytes()[:500])
    second = tail.read()
    assert tail.restarts == 1
    assert second["t_us"][0] == first["t_us"][0]
    log.unlink()
    with pytest.raises(BadRecording, match="gone"):
        tail.read()


def test_rows_that_are_none_are_left_out_and_counted(log, capsys):
    rows = log.read_text().splitlines(keepends=True)
    digits = rows[19].replace(",", "," + "9" * 19 + ",", 1).rpartition(",")[0]
    log.write_text("".join([*rows[:20], "oops,1,2\n", digits + "\n", *rows[20:]]))
    live = watch(str(log), WatchOptions(once=True))
    assert live.samples == len(rows) - 1
    assert "2 rows left out: not 8 integers" in capsys.readouterr().out


@pytest.mark.parametrize("reading", [-(2**31), 2**31, -(10**17)])
def test_readings_of_no_chip_are_at_a_rail(log, reading):
    *rows, last = log.read_text().splitlines(keepends=True)
    names = rows[0].strip().split(",")
    cells = dict(zip(names, last.strip().split(",")), gx=reading, gy=-reading)
    log.write_text("".join([*rows, ",".join(str(cells[n]) for n in names) + "\n"]))
    live = watch(str(log), WatchOptions(once=True))
    assert live.samples == len(rows) and live.bias_dps == pytest.approx([1.5, -2, 0.5], abs=0.02)


def test_the_firmware_is_where_a_replay_of_the_file_leaves_it(log, capsys):
    live = watch(str(log), WatchOptions(once=True))
    assert state_bytes(live.corrector) == replay(log).state
    assert live.bias_dps == pytest.approx([1.5, -2.0, 0.5], abs=0.02)
    assert "x +1." in capsys.readouterr().out


def test_once_prints_one_line_however_long_the_reading_takes(log, capsys, monkeypatch):
    monkeypatch.setattr("zerorate_tools.watch.watching._MOST_BYTES", 4096)
    watch(str(log), WatchOptions(once=True, every_s=0.0))
    assert len(capsys.readouterr().out.splitlines()) == 1


@pytest.mark.parametrize(
    ("name", "plot", "said"),
    [
        ("a.parquet", "", "index at its end"),
        ("a.csv.gz", "", "gzip"),
        ("a.csv", "", "no such"),
        (".", "", "is a folder; name a .csv that is being written"),
        ("whole/alone.csv", "", "alone.json"),
        ("a.csv", "bias.txt", "end it in .png"),
        ("a.csv", "none/bias.png", "no folder"),
    ],
)
def test_what_cannot_be_followed_or_drawn_is_said_in_a_line(log, capsys, name, plot, said):
    log.with_name("alone.csv").write_bytes(log.read_bytes())
    folder = log.parents[1]
    more = ["--plot", str(folder / plot)] if plot else []
    assert main(["watch", str(folder / name), *more]) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


def test_without_what_draws_the_watch_does_not_begin(log, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    assert main(["watch", str(log), "--plot", str(log.with_name("bias.png"))]) == 2
    assert "needs matplotlib" in capsys.readouterr().err


def test_ctrl_c_ends_it_well(log):
    command = [sys.executable, "-m", "zerorate_tools.cli", "watch", str(log), "--every", "0.1"]
    # A shell's background job hands on a Ctrl-C that is ignored.
    ignored = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    finally:
        signal.signal(signal.SIGINT, ignored)
    with process:
        first = process.stdout.readline()
        process.send_signal(signal.SIGINT)
        rest = process.stdout.read()
    assert process.returncode == 0
    assert "bias dps" in first and "Traceback" not in rest


@pytest.mark.parametrize("name", ["run.csv", "run.csv.gz", "run.parquet"])
def test_what_record_is_writing_is_found_before_it_has_its_name(tmp_path, recording, name):
    out = tmp_path / name
    with growing_recording(out, recording.column_names, recording.scales) as writing:
        writing.append(recording.between(0, 500).columns)
        assert not out.exists()
        assert len(CsvTail(out).read()["t_us"]) == 500


@pytest.mark.parametrize("name", ["run.parquet", "run.csv.gz"])
def test_a_finished_recording_is_shown_once(tmp_path, recording, name):
    write_recording(recording, tmp_path / name)
    live = watch(str(tmp_path / name), WatchOptions(once=True))
    assert state_bytes(live.corrector) == replay(tmp_path / name).state


def test_on_a_terminal_of_any_letters_an_emulated_chip_is_drawn_anew():
    terminal, shown = os.openpty()
    command = [sys.executable, "-m", "zerorate_tools.cli", "watch", "fake:", "--for", "0.2"]
    letters = {**os.environ, "PYTHONIOENCODING": "ascii", "COLUMNS": "100", "TERM": "xterm"}
    watching = subprocess.Popen(command, stdout=shown, env=letters)
    os.close(shown)
    said = b""
    with suppress(OSError):  # the terminal's end
        while part := os.read(terminal, 4096):
            said += part
    os.close(terminal)
    assert watching.wait() == 0
    assert b"\x1b[1A" in said and b"\\x1b" not in said and b"? one sigma" in said


def test_an_emulated_chip_has_no_pins_to_set_up(tmp_path, capsys):
    (tmp_path / "pins.py").write_text("imu = None")
    for words in ("watch fake: --for 1", f"record fake: --out {tmp_path / 'x.csv'}"):
        assert main([*words.split(), "--setup", str(tmp_path / "pins.py")]) == 2
        assert "--setup" in capsys.readouterr().err


def test_a_terminal_too_narrow_for_the_numbers_gets_lines(monkeypatch):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    for columns, is_narrow in ((69, True), (70, False)):
        monkeypatch.setenv("COLUMNS", str(columns))
        with screen() as shown:
            assert isinstance(shown, Lines) == is_narrow


@pytest.mark.parametrize("columns", [70, 80, 200])
def test_every_number_and_source_is_whole_on_a_terminal(recording, columns):
    console = Console(file=StringIO(), force_terminal=True, width=columns, color_system=None)
    live = Live("run", recording.scales, recording.column_names)
    live.feed(recording.columns)
    with RichLive(console=console, auto_refresh=False) as area:
        Area(area).show(live, [])
    table = [line for line in console.file.getvalue().splitlines() if line.startswith(" g")][-3:]
    assert [line.split()[1:6] for line in table] == [
        [*(f"{value[i]:+.3f}" for value in (live.rate_dps, live.left_dps, live.bias_dps))]
        + [f"{live.quality_dps[i]:.3f}", live.source[i]]
        for i in range(3)
    ]


def test_a_name_is_shown_letter_by_letter_on_a_terminal(recording):
    console = Console(file=StringIO(), force_terminal=True, width=120, color_system=None)
    live = Live("[red]run[/red]", recording.scales, recording.column_names)
    with RichLive(console=console, auto_refresh=False) as area:
        Area(area).show(live, ["a note"])
    shown = console.file.getvalue()
    assert "[red]run[/red]" in shown and "a note" in shown


def test_a_chip_on_a_bus_is_watched():
    samples = ((k % 7, k % 5, 16384, -3000, 40 + k % 3, -20, 10 + k % 2) for k in range(10**6))
    chip = FakeMPU6050(samples)
    clock = FakeClock(chip)
    taken = []

    def take(scales):
        taken.append(Watcher("/dev/i2c-1", scales, WatchOptions(every_s=1e9), Lines()))
        return taken[0]

    stream_bus(FakeI2C(chip, clock=clock), take, seconds=20, time_source=clock)
    taken[0].flush()
    live = taken[0].live
    assert live.samples == pytest.approx(2000, abs=60)
    assert live.bias_dps * 131 == pytest.approx([41, -20, 10.5], abs=0.5)


def test_a_bias_that_is_not_known_has_no_sigma(log, capsys):
    log.write_text("".join(log.read_text().splitlines(keepends=True)[:2]))
    watch(str(log), WatchOptions(once=True))
    assert "x none  y none  z none" in capsys.readouterr().out


def test_where_nothing_came_it_is_an_error_that_says_what_to_do(log, capsys):
    log.write_text(log.read_text().splitlines(keepends=True)[0])
    board, port = os.openpty()
    for source in ([str(log), "--once"], [os.ttyname(port), "--own", "--for", "0.1"]):
        assert main(["watch", *source]) == 2
        assert capsys.readouterr().err.startswith(f"zerorate: {source[0]}: ")
    os.close(board)
    os.close(port)


def test_what_a_board_explains_is_read_as_the_firmware_means_it(log):
    live = watch(str(log), WatchOptions(once=True, settings=_RESTS))
    told = OwnOutput("/dev/ttyACM0")
    told.feed(live.corrector.explain().encode() + b"\n")
    assert told.bias_dps == pytest.approx(live.bias_dps, abs=6e-4)
    assert told.quality_dps == pytest.approx(live.quality_dps, abs=6e-4)
    assert told.source == live.source
    assert told.learning() == live.learning()
    told.feed(b"before +0.303 -0.182 +0.084  after +0.003 +0.008 -0.006 dps\r\n")
    assert len(told.history) == 1
    told.feed(b"MPY: soft reboot\r\n")
    assert told.source == ["none"] * 3 and not told.history


@pytest.mark.parametrize("ends", [["--for", "0.5"], ["--once"]])
def test_a_program_that_prints_no_bias_is_watched_and_not_drawn(tmp_path, capsys, ends):
    board, port = os.openpty()
    tty.setraw(board)
    (tmp_path / "tty-a").symlink_to(os.ttyname(port))
    assert is_device(str(tmp_path / "tty-a"))
    (tmp_path / "tty-a").unlink()
    ended = threading.Event()

    def program():
        for _ in range(1000):  # a watch that does not end loses its board
            os.write(board, b"yaw without +0.14  with +0.01 deg\n")
            if ended.wait(0.02):
                return
        os.close(board)

    running = threading.Thread(target=program)
    running.start()
    own = ["watch", os.ttyname(port), "--own", *ends]
    codes = [main(own), main([*own, "--plot", str(tmp_path / "bias.png")])]
    ended.set()
    running.join()
    said = capsys.readouterr()
    assert codes == [0, 2] and not list(tmp_path.iterdir())
    assert "with +0.01 deg" in said.out and "no bias came to be drawn" in said.err
