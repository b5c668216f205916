"""Signals that end a program wait while something must not be left half done."""

import os
import signal
import sys
import threading

import pytest
from zerorate_tools import cli
from zerorate_tools.ending import noted_signals, undisturbed

from host_tests.tools.killed_recorders import MOST_S, trials
from host_tests.tools.killed_writers import Trials

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
