"""Outputs appear whole or not at all: full disks, ends by a signal, and what killed runs left."""

import errno
import os
import signal
import sys
import threading

import pytest
from zerorate_tools import closing
from zerorate_tools.ending import noted_signals, undisturbed
from zerorate_tools.errors import InFile
from zerorate_tools.importers import import_recording
from zerorate_tools.importers.samples import spool
from zerorate_tools.recordings.atomic import all_written_together, written_beside, written_together

from host_tests.tools.killed_recorders import MOST_S, trials
from host_tests.tools.killed_writers import WRITERS, Trials


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


def test_two_folders_may_be_one(old):
    with all_written_together([old, old / ".." / "out"]) as drafts:
        (drafts[0] / "model.json").write_text("new")
        (drafts[1] / "x").write_text("new")
    assert contents(old) == {"model.json": "new", "report.html": "old", "x": "new"}


def test_a_file_that_cannot_take_its_place_brings_back_those_before_it(old):
    (old / "report.html").unlink()
    (old / "report.html").mkdir()
    with pytest.raises(InFile, match="Is a directory; all is as it was"):
        with written_together(old) as draft:
            write_some(draft)
    assert contents(old) == {"model.json": "old"}


@pytest.mark.parametrize("number", ["ENOSPC", "EDQUOT", "EFBIG", "EIO", "EROFS", "EPERM", "EBUSY"])
def test_a_disk_that_takes_no_more_is_told_from_any_other_error(tmp_path, number):
    is_full = number not in ("EPERM", "EBUSY")
    error = OSError(getattr(errno, number), "said by the system")
    said = f"o: cannot be written: {os.strerror(error.errno)}; .*make room" if is_full else "said"
    for write in (written_beside, written_together):
        with pytest.raises(InFile if is_full else OSError, match=said), write(tmp_path / "o"):
            raise error
    with pytest.raises(InFile if is_full else OSError, match=said.replace("o:", "out/o:")):
        with written_together(tmp_path / "out") as draft, written_beside(draft / "o"):
            raise error
    assert not list(tmp_path.iterdir())


def test_a_name_of_255_bytes_is_written_and_a_longer_one_refused(tmp_path):
    name = "x" * 248 + ".csv.gz"
    with written_beside(tmp_path / name) as temporary:
        assert temporary.name == name
        temporary.write_text("new")
    with pytest.raises(InFile, match="longer than 255 bytes; give it a shorter one"):
        with written_beside(tmp_path / ("µ" * 128)):
            pass
    with pytest.raises(InFile, match="cannot be written.*name a folder that exists"):
        with written_beside(tmp_path / "nowhere" / "x"):
            pass
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_close_and_import_leave_the_folder_as_it_was_where_there_is_no_room(old, monkeypatch):
    before = contents(old)
    monkeypatch.setattr(closing, "load", lambda *arguments: None)
    monkeypatch.setattr(closing, "run_and_prune", lambda *arguments: (None, None))
    monkeypatch.setattr(closing, "write_model", lambda _, folder: write_some(folder))
    monkeypatch.setattr(closing, "report", full)
    with pytest.raises(InFile, match="No space left"):
        closing.close(["x"], old)
    assert contents(old) == before
    (old / "run.csv").write_text("t_s,gx_dps,gy_dps,gz_dps\n0,1,2,3\n")
    monkeypatch.setattr(spool.Spool, "append", full)
    with pytest.raises(InFile, match="o.csv: cannot be written: No space left.*make room"):
        import_recording(old / "run.csv", old / "o.csv")


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


if sys.platform == "win32":
    pytest.skip("processes fork and have limits there", allow_module_level=True)


def test_a_recorder_killed_at_a_random_moment_loses_two_seconds_at_most():
    fallen, most_s, ends = trials(14, seed=1)
    assert not fallen and most_s <= MOST_S
    assert ends["run"] >= 8 and ends["recovered"] >= 2


KILLED = ("CSV", "Parquet", "model", "simulate")


@pytest.mark.parametrize("name", KILLED)
def test_killed_at_each_rename_and_write_it_leaves_the_old_or_the_new_whole(tmp_path, name):
    done = Trials(name, tmp_path).all(sizes=3)
    assert done.tried >= 7 and not done.fallen


@pytest.mark.parametrize("name", sorted(WRITERS.keys() - set(KILLED)))
def test_every_other_writer_that_make_attacks_kills_writes(tmp_path, name):
    assert Trials(name, tmp_path).changes
