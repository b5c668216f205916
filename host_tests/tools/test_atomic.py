"""Outputs appear whole or not at all: full disks, ends by a signal, and what killed runs left."""

import errno
import os
import signal
import subprocess
import sys
import threading
import time

import pytest
from zerorate_tools import cli, closing
from zerorate_tools.ending import noted_signals, undisturbed
from zerorate_tools.errors import InFile
from zerorate_tools.recordings import write_recording
from zerorate_tools.recordings.atomic import all_written_together, written_beside, written_together
from zerorate_tools.simulate import simulate_to_files

from host_tests.tools.killed_recorders import MOST_S, trials
from host_tests.tools.killed_writers import Trials

from .test_recordings import a_recording
from .test_simulate import device


def full(*arguments, **options):
    raise OSError(errno.ENOSPC, "No space left on device")


def contents(folder):
    return {str(p.relative_to(folder)): p.read_text() for p in folder.rglob("*") if p.is_file()}


@pytest.fixture
def old(tmp_path):
    """A folder with what an earlier run wrote."""
    (tmp_path / "out").mkdir()
    for name in ("model.json", "report.html"):
        (tmp_path / "out" / name).write_text("old")
    return tmp_path / "out"


def write_some(draft):
    (draft / "plots").mkdir()
    for name in ("model.json", "plots/a.png", "report.html"):
        (draft / name).write_text("new")


def test_a_folder_is_replaced_when_all_its_files_are_there(old):
    with written_together(old) as draft:
        write_some(draft)
        assert set(contents(old).values()) == {"old", "new"}
    assert contents(old) == dict.fromkeys(("model.json", "plots/a.png", "report.html"), "new")
    assert sorted(p.name for p in old.iterdir()) == ["model.json", "plots", "report.html"]


@pytest.mark.parametrize("blocked", ["out/run.csv", "truth/t.parquet"])
def test_a_simulation_is_written_to_both_of_its_folders_or_to_none(tmp_path, blocked):
    (tmp_path / blocked).mkdir(parents=True)
    places = tmp_path / "out" / "run.csv", tmp_path / "truth" / "t.parquet"
    for place in places:
        place.parent.mkdir(exist_ok=True)
    with pytest.raises(InFile, match=f"{blocked}: "):
        simulate_to_files(device(0.1), places[0], truth=places[1])
    assert not contents(tmp_path)
    (tmp_path / blocked).rmdir()
    simulate_to_files(device(0.1), places[0], truth=places[1])
    found = {"out/run.csv", "out/run.json", "truth/t.parquet"}
    assert {str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*.*")} == found


def test_two_folders_may_be_one(old):
    with all_written_together([old, old / ".." / "out"]) as drafts:
        (drafts[0] / "model.json").write_text("new")
        (drafts[1] / "x").write_text("new")
    assert contents(old) == {"model.json": "new", "report.html": "old", "x": "new"}


def test_a_disk_that_fills_leaves_the_folder_as_it_was_and_names_it(old):
    before = contents(old)
    with pytest.raises(InFile, match="out: cannot be written: No space left"):
        with written_together(old) as draft:
            write_some(draft)
            full()
    assert contents(old) == before and len(list(old.iterdir())) == 2


def test_a_file_that_cannot_take_its_place_brings_back_those_before_it(old):
    (old / "report.html").unlink()
    (old / "report.html").mkdir()
    with pytest.raises(InFile, match="Is a directory; all is as it was"):
        with written_together(old) as draft:
            write_some(draft)
    assert contents(old) == {"model.json": "old"}


def test_a_folder_that_was_not_there_is_not_there_after_a_failure(tmp_path):
    with pytest.raises(ValueError), written_together(tmp_path / "new") as draft:
        write_some(draft)
        raise ValueError
    assert not list(tmp_path.iterdir())


def test_a_full_disk_names_the_file_that_has_no_room(tmp_path):
    with pytest.raises(InFile, match="o.parquet: cannot be written: No space left.*make room"):
        with written_beside(tmp_path / "o.parquet"):
            full()
    with pytest.raises(InFile, match="out/o.parquet: cannot be written"):
        with written_together(tmp_path / "out") as draft, written_beside(draft / "o.parquet"):
            full()


@pytest.mark.parametrize("length", [1, 200, 255])
def test_a_name_of_any_length_that_fits_is_written(tmp_path, length):
    name = ("x" * 255 + ".csv.gz")[-length:]
    with written_beside(tmp_path / name) as temporary:
        assert temporary.name == name
        temporary.write_text("new")
    assert [p.name for p in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("number", ["ENOSPC", "EDQUOT", "EFBIG", "EIO", "EROFS", "EPERM", "EBUSY"])
def test_a_disk_that_takes_no_more_is_told_from_any_other_error(tmp_path, number):
    number = getattr(errno, number)
    told = (
        (InFile, os.strerror(number))
        if number not in (errno.EPERM, errno.EBUSY)
        else (OSError, "said")
    )
    for write in (written_beside, written_together):
        with pytest.raises(told[0], match=told[1]) as caught, write(tmp_path / "o"):
            raise OSError(number, "said by the system")
        assert isinstance(caught.value, InFile) is (told[0] is InFile)
    assert not list(tmp_path.iterdir())


def test_a_name_that_does_not_fit_is_refused_and_leaves_nothing(tmp_path):
    with pytest.raises(InFile, match="longer than 255 bytes; give it a shorter one"):
        with written_beside(tmp_path / ("µ" * 128)):
            pass
    assert not list(tmp_path.iterdir())


def test_close_leaves_the_folder_as_it_was_where_its_report_has_no_room(old, monkeypatch):
    before = contents(old)
    monkeypatch.setattr(closing, "load", lambda *arguments: None)
    monkeypatch.setattr(closing, "run_and_prune", lambda *arguments: (None, None))
    monkeypatch.setattr(closing, "write_model", lambda _, folder: write_some(folder))
    monkeypatch.setattr(closing, "report", full)
    with pytest.raises(InFile, match="No space left"):
        closing.close(["x"], old)
    assert contents(old) == before


@pytest.mark.skipif(os.name == "nt", reason="a process is ended there without a word")
def test_the_end_by_a_signal_leaves_nothing_half_written(tmp_path):
    write_recording(a_recording(60000), tmp_path / "x.parquet")
    out = tmp_path / "out"
    out.mkdir()
    command = [sys.executable, "-m", "zerorate_tools.cli", "replay", str(tmp_path / "x.parquet")]
    run = subprocess.Popen([*command, "--runtime", "cpython", "--out", str(out / "o.parquet")])
    until = time.monotonic() + 60
    while not list(out.iterdir()) and time.monotonic() < until:
        time.sleep(0.02)
    assert list(out.iterdir()) and run.poll() is None
    run.send_signal(signal.SIGTERM)
    assert run.wait(60) == -signal.SIGTERM
    assert not list(out.iterdir())


NUMBERS = [signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)]


@pytest.fixture
def handled(monkeypatch):
    """What the program's own handlers got."""
    got = []
    before = {n: signal.signal(n, lambda number, _: got.append(number)) for n in NUMBERS}
    yield got
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", NUMBERS)
def test_a_signal_is_noted_and_its_handler_is_back_afterwards(handled, number):
    with noted_signals() as came:
        signal.raise_signal(number)
        assert came == [number] and not handled
    signal.raise_signal(number)
    assert came == handled == [number]


@pytest.mark.parametrize("error", [None, ValueError])
def test_a_signal_comes_once_when_the_block_has_ended(handled, error):
    with pytest.raises(error or ZeroDivisionError):
        with undisturbed():
            for number in NUMBERS:
                signal.raise_signal(number)
            assert not handled
            raise (error or ZeroDivisionError)
    assert handled == NUMBERS[:1]


def test_what_is_ignored_stays_ignored(handled):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    with noted_signals() as came:
        signal.raise_signal(signal.SIGTERM)
    assert not came and signal.getsignal(signal.SIGTERM) is signal.SIG_IGN


def test_in_another_thread_nothing_is_noted(handled):
    def work():
        with noted_signals() as came, undisturbed():
            signal.raise_signal(signal.SIGTERM)
            seen.append(came)

    seen = []
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [[]] and handled == [signal.SIGTERM]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes do not fork there")
@pytest.mark.parametrize("ignored", [True, False])
def test_the_program_ends_by_a_hang_up_unless_nohup_ignores_it(ignored, monkeypatch):
    monkeypatch.setattr("sys.argv", ["zerorate", "--version"])
    if (child := os.fork()) == 0:
        signal.signal(signal.SIGHUP, signal.SIG_IGN if ignored else signal.SIG_DFL)
        try:
            cli.main()
        except SystemExit:
            signal.raise_signal(signal.SIGHUP)
        os._exit(0)
    status = os.waitpid(child, 0)[1]
    assert os.WIFEXITED(status) if ignored else os.WTERMSIG(status) == signal.SIGHUP, status


if sys.platform == "win32":
    pytest.skip("processes fork and have limits there", allow_module_level=True)


def test_a_recorder_killed_at_a_random_moment_loses_two_seconds_at_most():
    fallen, most_s, ends = trials(24, seed=1)
    assert not fallen and most_s <= MOST_S
    assert ends["run"] >= 8 and ends["recovered"] >= 2


@pytest.mark.parametrize("name", ["CSV", "Parquet", "model", "simulate"])
def test_killed_at_each_rename_and_write_it_leaves_the_old_or_the_new_whole(tmp_path, name):
    done = Trials(name, tmp_path).all(sizes=3)
    assert done.tried >= 7 and not done.fallen
