"""The firmware put on an emulated Pico: stock MicroPython on an emulated RP2040."""

import pytest
from zerorate_tools.boards.connection import BoardError, connected
from zerorate_tools.boards.flashing import flash


def test_the_board_is_asked_what_it_is(pico):
    facts = pico.flashed.facts
    assert (facts.machine, facts.architecture) == ("Raspberry Pi Pico with RP2040", "armv6m")
    assert facts.mpy[0] == 6
    assert facts.heap_free > 200_000 and facts.disk_free > 1_000_000


def test_forty_two_kilobytes_at_most_are_sent(pico):
    assert 10_000 < pico.flashed.sent_bytes <= 42 << 10


def test_flashing_again_sends_nothing(pico):
    assert flash(pico.port, say=lambda line: None).sent_bytes == 0


def test_a_board_with_little_heap_says_so_in_a_sentence(pico):
    hog = "import gc\ngc.collect()\nhog = bytearray(gc.mem_free() - 9000)\n"
    with connected(pico.port, go_on=False) as board:
        board.fs_writefile("boot.py", hog.encode())
    try:
        with pytest.raises(BoardError, match="too little heap free; .*boot.py"):
            flash(pico.port, parts=["motion"], say=lambda line: None)
    finally:
        with connected(pico.port, go_on=False) as board:
            board.exec("import os\nos.remove('boot.py')")


def test_power_cut_while_a_part_is_put_in_place_leaves_a_firmware_that_runs(pico, monkeypatch):
    erased = pico.ask("stat")["erases"]
    pico.cut_power_after(40)
    with monkeypatch.context() as patch:
        patch.setattr("zerorate_tools.boards.connection._LONG_S", 20)
        try:
            flash(pico.port, parts=["self-test"], say=lambda line: None)
        except Exception:  # what the cut does to a serial port is no one error
            pass
    assert pico.ask("stat")["cuts"] == 1 and pico.ask("stat")["erases"] > erased
    with connected(pico.port) as board:
        said = board.exec("from zerorate import Corrector; print(Corrector().source(0))")
    assert said.strip() == b"0"
    assert flash(pico.port, parts=["self-test"], say=lambda line: None).sent_bytes < 10_000
