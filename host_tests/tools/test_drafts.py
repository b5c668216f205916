"""What killed runs leave: drafts go, switches are finished, and nothing else is touched."""

import errno
import fcntl
import json
import os
import signal
import subprocess
import sys
import threading

import pytest
from zerorate_tools.errors import InFile
from zerorate_tools.recordings import drafts
from zerorate_tools.recordings.atomic import all_written_together, written_beside, written_together
from zerorate_tools.recordings.drafts import clear_left_over, drop_all, settle

from .test_atomic import contents

MARKED = ".zerorate-0123456789abcdef.partial"


def a_draft(folder, mark=MARKED, **files):
    draft = folder / mark
    draft.mkdir(parents=True)
    for name, text in files.items():
        (draft / name).write_text(text)
    return draft


@pytest.mark.parametrize(
    "name",
    [
        ".1.partial.o", ".00000000-1.partial", ".1.partial", ".x.partial.o", "1.partial.o",
        ".zerorate-1.partial", ".zerorate-0123456789abcdef.partial.o", "run.partial.csv",
        ".zerorate-0123456789ABCDEF.partial", MARKED,
    ],
)  # fmt: skip
def test_what_is_no_draft_of_ours_stays(tmp_path, name):
    (tmp_path / name).write_text("a file, not a folder")
    (tmp_path / "other").mkdir()
    if name != MARKED:
        (tmp_path / "other" / name).mkdir()
        (tmp_path / "other" / name / "x").write_text("somebody's")
    else:
        (tmp_path / "theirs").mkdir()
        (tmp_path / "other" / name).symlink_to(tmp_path / "theirs")
    before = sorted(tmp_path.rglob("*"))
    for folder in (tmp_path, tmp_path / "other"):
        clear_left_over(folder)
        with written_beside(folder / "o"):
            pass
        (folder / "o").unlink()
    assert sorted(tmp_path.rglob("*")) == before


def locked(folder):
    """A descriptor that holds the folder's lock until it is closed."""
    held = os.open(folder, os.O_RDONLY)
    fcntl.flock(held, fcntl.LOCK_EX)
    return held


def test_what_another_program_writes_now_stays_whatever_its_number(tmp_path):
    """Of another container its process number means nothing here; a lock does."""
    draft = a_draft(tmp_path, o="being written")
    held = locked(draft)
    clear_left_over(tmp_path)
    assert contents(draft) == {"o": "being written"}
    os.close(held)
    clear_left_over(tmp_path)
    assert not draft.exists()


@pytest.mark.parametrize("without", ["the system", "the file system"])
def test_without_locks_no_draft_is_removed_and_all_is_written(tmp_path, monkeypatch, without):
    if without == "the system":
        monkeypatch.setattr(drafts, "fcntl", None)
    else:
        error = OSError(errno.ENOLCK, "no locks")
        monkeypatch.setattr(fcntl, "flock", lambda *_: (_ for _ in ()).throw(error))
    draft = a_draft(tmp_path, o="perhaps being written")
    with written_together(tmp_path) as inside:
        (inside / "a").write_text("new")
        (inside / "b").write_text("new")
    assert contents(tmp_path) == {"a": "new", "b": "new", f"{MARKED}/o": "perhaps being written"}
    assert len(list(tmp_path.iterdir())) == 3 and draft.exists()


def test_a_draft_that_is_cleaned_away_before_it_is_locked_is_made_again(tmp_path, monkeypatch):
    lock, lost = drafts._lock, []

    def lock_late(folder):
        if not lost:
            lost.append(folder)
            folder.rmdir()
        return lock(folder)

    monkeypatch.setattr(drafts, "_lock", lock_late)
    with written_beside(tmp_path / "o") as temporary:
        assert temporary.parent != lost[0]
    assert (tmp_path / "o").exists()


def test_an_end_drops_what_this_process_writes_and_no_other(tmp_path):
    other = a_draft(tmp_path, o="another's")
    held = locked(other)
    with written_beside(tmp_path / "o") as mine, written_together(tmp_path / "out") as draft:
        drop_all()
        assert not mine.exists() and not draft.exists() and other.exists()
        mine.parent.mkdir()
        mine.touch()
        draft.mkdir(parents=True)
    assert not drafts._mine
    os.close(held)


def test_a_fork_drops_nothing_of_its_parent_s(tmp_path):
    with written_beside(tmp_path / "o") as temporary:
        if (child := os.fork()) == 0:
            drop_all()
            os._exit(0)
        os.waitpid(child, 0)
        assert temporary.exists()


class TestSwitch:
    def test_is_finished_by_who_reads_next(self, tmp_path):
        (tmp_path / "run.csv").write_text("new")
        (tmp_path / "run.json").write_text("old")
        a_draft(tmp_path, ".zerorate-switch", **{"run.json": "new"})
        settle(tmp_path)
        assert contents(tmp_path) == {"run.csv": "new", "run.json": "new"}
        assert len(list(tmp_path.iterdir())) == 2

    def test_is_waited_for_while_its_writer_lives(self, tmp_path, monkeypatch):
        switch = a_draft(tmp_path, ".zerorate-switch", o="new")
        threading.Timer(0.2, os.close, [locked(switch)]).start()
        settle(tmp_path)
        assert contents(tmp_path) == {"o": "new"}

    def test_that_never_ends_is_said(self, tmp_path, monkeypatch):
        monkeypatch.setattr(drafts, "_PATIENCE_S", 0.1)
        held = locked(a_draft(tmp_path, ".zerorate-switch"))
        with pytest.raises(InFile, match="being replaced, which cannot be finished: another"):
            settle(tmp_path)
        os.close(held)

    def test_of_several_folders_is_finished_from_either(self, tmp_path):
        for first in ("a", "b"):
            root = tmp_path / first
            lead = a_draft(root / "a", ".zerorate-switch", run="new")
            other = a_draft(root / "b", truth="new")
            (lead / ".zerorate-others").write_text(json.dumps([str(other)]))
            (other / ".zerorate-lead").write_text(json.dumps(str(root / "a")))
            (root / "b" / "truth").write_text("old")
            clear_left_over(root / first)
            assert (root / "a" / "run").read_text() == (root / "b" / "truth").read_text() == "new"
            clear_left_over(root / "b")
            assert not list(root.rglob(".zerorate*"))

    def test_does_not_move_what_does_not_say_it_is_part_of_it(self, tmp_path):
        """A folder from elsewhere could name any other."""
        lead = a_draft(tmp_path / "a", ".zerorate-switch")
        home = a_draft(tmp_path / "b", thesis="mine")
        plain = tmp_path / "c" / "home"
        plain.mkdir(parents=True)
        (plain / "thesis").write_text("mine")
        (plain / ".zerorate-lead").write_text(json.dumps(str(tmp_path / "a")))
        (lead / ".zerorate-others").write_text(json.dumps([str(home), str(plain)]))
        settle(tmp_path / "a")
        assert (home / "thesis").exists() and (plain / "thesis").exists()

    def test_that_is_a_link_is_none(self, tmp_path):
        (tmp_path / "home").mkdir()
        (tmp_path / "home" / "thesis").write_text("mine")
        (tmp_path / "here").mkdir()
        (tmp_path / "here" / ".zerorate-switch").symlink_to(tmp_path / "home")
        settle(tmp_path / "here")
        assert (tmp_path / "home" / "thesis").exists()

    @pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
    def test_that_cannot_be_finished_is_said(self, tmp_path):
        a_draft(tmp_path, ".zerorate-switch", o="new")
        tmp_path.chmod(0o500)
        with pytest.raises(InFile, match="cannot be finished: Permission denied"):
            settle(tmp_path)
        tmp_path.chmod(0o700)

    @pytest.mark.parametrize("links", [True, False])
    @pytest.mark.parametrize("fails_at", range(4))
    def test_that_fails_anywhere_brings_all_back(self, tmp_path, monkeypatch, fails_at, links):
        for folder in ("a", "b"):
            (tmp_path / folder).mkdir()
            (tmp_path / folder / "old").write_text("old")
        replace, calls, others = os.replace, [], []

        def failing(source, target):
            calls.append(target)
            others.extend(drafts._others(tmp_path / "a" / ".zerorate-switch"))
            if len(calls) - 1 == fails_at:
                raise PermissionError(errno.EPERM, "immutable", str(source), None, str(target))
            replace(source, target)

        if not links:
            monkeypatch.setattr(os, "link", no_links)
        with pytest.raises(InFile, match="(old|new): cannot be written: .*; all is as it was"):
            with all_written_together([tmp_path / "a", tmp_path / "b"]) as inside:
                for draft in inside:
                    (draft / "old").write_text("new")
                    (draft / "new").mkdir()
                    (draft / "new" / "x").write_text("new")
                monkeypatch.setattr(os, "replace", failing)
        assert contents(tmp_path) == {"a/old": "old", "b/old": "old"}
        assert not list(tmp_path.rglob(".zerorate*"))
        assert {draft.parent for draft in others} == {tmp_path / "b"}, "a kill would part them"


def no_links(*arguments, **options):
    raise OSError(errno.EPERM, "no links here")


SIGNALLED = """
import os, signal, sys, threading
from zerorate_tools import cli
from zerorate_tools.recordings import drafts
from zerorate_tools.recordings.atomic import written_together

def send(event, arguments, number=int(sys.argv[2])):
    if event == "os.rename" and sys.argv[1] in str(arguments[1]):
        # to any thread, as the system does where the main one does not take it
        other = threading.Thread(target=lambda: signal.pthread_kill(threading.get_ident(), number))
        other.start()
        other.join()

threading.Thread(target=threading.Event().wait, daemon=True).start()
for number in (signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, cli._end)
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background ignores it
sys.addaudithook(send)
with written_together("out") as draft:
    for name in ("a", "b", "c"):
        (draft / name).write_text("new")
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
@pytest.mark.parametrize("at", ["zerorate-switch", "out/a", "out/b", "out/c"])
def test_a_signal_at_any_rename_ends_the_program_when_all_are_done(tmp_path, number, at):
    (tmp_path / "out").mkdir()
    for name in ("a", "b"):
        (tmp_path / "out" / name).write_text("old")
    run = subprocess.run(
        [sys.executable, "-c", SIGNALLED, at, str(int(number))], cwd=tmp_path, capture_output=True
    )
    assert run.returncode == -number, run.stderr
    assert contents(tmp_path) == {"out/a": "new", "out/b": "new", "out/c": "new"}
    assert not list(tmp_path.rglob(".zerorate*"))


def test_a_draft_that_somebody_removed_is_dropped_all_the_same(tmp_path):
    draft = drafts.make_draft(tmp_path)
    draft.rmdir()
    drafts.drop(draft)
    assert draft not in drafts._mine and not list(tmp_path.iterdir())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_while_a_draft_is_made_leaves_none(tmp_path, monkeypatch, number):
    locked = drafts._lock

    def signalled(folder):
        signal.raise_signal(number)
        return locked(folder)

    def ended(number, frame):
        drop_all()
        raise KeyboardInterrupt

    monkeypatch.setattr(drafts, "_lock", signalled)
    before = signal.signal(number, ended)
    try:
        with pytest.raises(KeyboardInterrupt):
            drafts.make_draft(tmp_path)
    finally:
        signal.signal(number, before)
    assert not list(tmp_path.iterdir())
