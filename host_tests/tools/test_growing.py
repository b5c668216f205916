"""A recording being made is whole to its last batch, and stays until it is finished."""

import errno
import os
import signal

import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import BadRecording, InFile
from zerorate_tools.recordings import (
    growing,
    growing_recording,
    read_recording,
    recover,
    write_recording,
)
from zerorate_tools.recordings.drafts import clear_left_over
from zerorate_tools.recordings.growing import left_over

from .test_recordings import a_recording


def part(first, last):
    return a_recording(100).between(first, last).columns


@pytest.fixture
def new(tmp_path):
    """Begin a recording of that name."""

    def begin(name="run.parquet"):
        recording = a_recording()
        return growing_recording(tmp_path / name, recording.column_names, recording.scales)

    return begin


@pytest.fixture
def killed(tmp_path, new):
    """What a recorder left that was killed behind 70 rows; text is put behind it."""

    def kill(name="run.parquet", text=b""):
        if (child := os.fork()) == 0:
            with new(name) as file:
                file.append(part(0, 50))
                file.append(part(50, 70))
                os.kill(os.getpid(), signal.SIGKILL)
        assert os.waitpid(child, 0)[1] == signal.SIGKILL
        left = max(tmp_path.glob("*.partial*.csv"), key=lambda path: path.stat().st_mtime_ns)
        with left.open("ab") as file:
            file.write(text)
        return left

    return kill


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("name", ["run.parquet", "run.csv", "run.csv.gz"])
def test_when_it_ends_it_has_its_name_and_all_rows(tmp_path, new, name):
    with new(name) as file:
        assert file.path == tmp_path / "run.partial.csv"
        for first in range(0, 100, 20):
            file.append(part(first, first + 20))
    read, expected = read_recording(tmp_path / name), a_recording(100)
    assert read.scales == expected.scales
    assert all((read.columns[n] == expected.columns[n]).all() for n in expected.columns)
    assert not list(tmp_path.glob("*.partial*"))


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, OSError])
def test_whatever_ends_it_what_was_appended_is_kept(tmp_path, new, error):
    with pytest.raises(error), new() as file:
        file.append(part(0, 70))
        raise error
    assert len(read_recording(tmp_path / "run.parquet")) == 70 and len(names(tmp_path)) == 1


def test_without_a_row_nothing_is_written_and_the_older_one_stays(tmp_path, new):
    (tmp_path / "run.parquet").write_bytes(b"older")
    with new():
        pass
    assert (tmp_path / "run.parquet").read_bytes() == b"older" and len(names(tmp_path)) == 1


def test_a_killed_one_is_an_ordinary_recording_and_nothing_removes_it(tmp_path, killed, new):
    left = killed()
    clear_left_over(tmp_path)
    write_recording(a_recording(), tmp_path / "other.csv")
    with new() as file:
        assert file.path.name == "run.partial-2.csv"
        file.append(part(0, 30))
    assert len(read_recording(left)) == 70 and len(read_recording(tmp_path / "run.parquet")) == 30
    assert left_over(tmp_path / "run.parquet") == [left]


@pytest.mark.parametrize("text", [b"", b"1,2", b"1,2,3,4,5,6,7,8", b"\0" * 200_000])
def test_it_is_recovered_without_the_row_that_was_cut_off(tmp_path, killed, text):
    assert recover(killed(text=text)) == tmp_path / "run.parquet"
    read, expected = read_recording(tmp_path / "run.parquet"), a_recording(100)
    assert len(read) == 70 and read.scales == expected.scales
    assert (read.columns["gz"] == expected.columns["gz"][:70]).all()
    assert names(tmp_path) == ["run.parquet"]


def test_it_is_not_written_over_another_unless_that_is_named(tmp_path, killed):
    left = killed("run.csv")
    (tmp_path / "run.parquet").write_bytes(b"older")
    with pytest.raises(BadRecording, match="run.parquet is there already; name another by --out"):
        recover(left)
    assert recover(left, tmp_path / "new.csv") == tmp_path / "new.csv"
    assert names(tmp_path) == ["new.csv", "new.json", "run.parquet"]


def test_what_is_being_recorded_is_not_recovered(tmp_path, new):
    with new() as file:
        file.append(part(0, 10))
        with pytest.raises(BadRecording, match="still being recorded; end that first"):
            recover(file.path)
        assert left_over(tmp_path / "run.parquet") == []
    assert len(read_recording(tmp_path / "run.parquet")) == 10


@pytest.mark.parametrize(
    "name, content, said",
    [
        ("run.csv", "t_us,gx,gy,gz\n0,1,2,3\n", "nothing that `zerorate record` leaves"),
        ("x.partial.csv", None, "x.partial.csv: cannot be opened: No such file"),
        ("x.partial.csv", "t_us,gx,gy,gz\n1,2", "no sample was recorded; delete it"),
        ("x.partial.csv", "", "no sample was recorded; delete it"),
        ("x.partial.csv", "t_us,gx,gy,gz\n0,1,2,3\n", "x.parquet what one LSB means is unknown"),
    ],
)
def test_what_cannot_be_recovered_stays(tmp_path, name, content, said):
    if content is not None:
        (tmp_path / name).write_text(content)
    before = names(tmp_path)
    with pytest.raises(BadRecording if "LSB" not in said else InFile, match=said):
        recover(tmp_path / name)
    assert names(tmp_path) == before


def test_a_name_of_unfinished_recordings_is_refused(tmp_path, new, killed):
    with pytest.raises(BadRecording, match="recordings that are not finished; leave out .partial"):
        with new("run.partial.csv"):
            pass
    with pytest.raises(BadRecording, match="not finished"):
        left_over(tmp_path / "run.partial.csv")
    left = killed()
    with pytest.raises(BadRecording, match="not finished"):
        recover(left, left)
    assert len(read_recording(left)) == 70


def no_room(*arguments):
    raise InFile("run.parquet", "cannot be written: No space left on device", do="make room")


def test_where_the_disk_has_no_room_to_finish_the_rows_stay_and_are_named(
    tmp_path, new, monkeypatch
):
    monkeypatch.setattr(growing, "recording_writer", no_room)
    said = r"run.partial.csv: is all that was recorded, .*No space left on device; make room, then "
    with pytest.raises(InFile, match=said + "zerorate record --recover .*run.partial.csv"):
        with new() as file:
            file.append(part(0, 70))
    with pytest.raises(InFile, match=said):
        recover(tmp_path / "run.partial.csv")
    monkeypatch.undo()
    assert len(read_recording(recover(tmp_path / "run.partial.csv"))) == 70


def test_a_batch_for_which_there_is_no_room_is_left_out_whole(tmp_path, new, monkeypatch):
    class Full(growing.FileIO):
        def write(self, data):
            if self.tell() > 2000:
                super().write(data[:7])
                raise OSError(errno.ENOSPC, "said by the system")
            return super().write(data)

    monkeypatch.setattr(growing, "FileIO", Full)
    with pytest.raises(InFile, match="no more can be written: .*; the 50 samples before are kept"):
        with new() as file:
            file.append(part(0, 50))
            file.append(part(50, 70))
    assert len(read_recording(tmp_path / "run.parquet")) == 50 and len(names(tmp_path)) == 1


def test_no_room_for_the_first_byte_leaves_nothing(tmp_path, new, monkeypatch):
    class Full(growing.FileIO):
        def write(self, data):
            raise OSError(errno.ENOSPC, "said by the system")

    monkeypatch.setattr(growing, "FileIO", Full)
    with pytest.raises(InFile, match="run.parquet: cannot be written: No space left"), new():
        pass
    assert names(tmp_path) == []


def test_a_disk_that_fails_later_is_said(tmp_path, new, monkeypatch):
    def failing(descriptor):
        raise OSError(errno.EIO, "said by the system")

    with pytest.raises(InFile, match="no more can be written: Input/output error"), new() as file:
        file.append(part(0, 50))
        monkeypatch.setattr(os, "fsync", failing)
        for first in range(50, 70):
            file.append(part(first, first + 1))
            file._synced.exception()
    assert len(read_recording(tmp_path / "run.parquet")) >= 50


def test_a_command_names_it_where_the_recording_is_asked_for(tmp_path, killed, capsys):
    left = killed()
    assert main(["allan", str(tmp_path / "run.parquet")]) == 2
    said = f"no such file; {left} is there: zerorate record --recover {left}"
    assert said in capsys.readouterr().err
