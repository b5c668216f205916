"""A burst of frames in one call leaves what the same frames leave one by one."""

from array import array
from pathlib import Path

import numpy as np
import pytest
from zerorate import Corrector
from zerorate.bursts import Bursts
from zerorate.native import rest
from zerorate.others import join
from zerorate.rest import block
from zerorate_bench.native.parts import BURST
from zerorate_tools.layout import SETTINGS, STATE

from . import trace
from .trace_on_host import corrector_for, frames

ON_BOARD = Path(__file__).parent / "on_micropython" / "trace_without_heap.py"


@pytest.fixture(scope="module", params=sorted(trace.MODES))
def one_by_one(request):
    """(mode, final state, eight words a frame: verdict and the corrected sample), bytes."""
    corrector, words = corrector_for(request.param), array("i")
    rows, dt_us = frames(trace.UPDATES[request.param])
    for row, dt in zip(rows.tolist(), dt_us.tolist()):
        frame = array("i", row)
        words.append(corrector.update(frame, dt))
        words.extend(frame)
    return request.param, corrector.state.tobytes(), words.tobytes()


def whole_trace(mode):
    rows, dt_us = frames(trace.UPDATES[mode])
    return [array("i", [dt, *row]) for row, dt in zip(rows.tolist(), dt_us.tolist())]


def test_the_kernel_gives_what_single_updates_give(one_by_one):
    mode, state, words = one_by_one
    corrector, done, room = corrector_for(mode), array("i"), array("i", [0] * 7)
    rows = whole_trace(mode)
    for first in range(0, len(rows), 73):
        burst = array("i", b"".join(row.tobytes() for row in rows[first : first + 73]))
        block.block(corrector.state, burst, corrector.settings, room, len(burst) // 8)
        done.extend(burst)
    assert done.tobytes() == words
    assert corrector.state.tobytes() == state


def odd_frames(count, seed):
    """A rest in which every tenth frame is odd: at an edge of what is taken at one look."""
    draw = np.random.default_rng(seed)
    frames = np.zeros((count, 8), int)
    frames[:, 0] = 10_000
    frames[:, 1:] = np.rint(
        draw.normal([10, -20, 16384, 700, 120, -80, 40], [9, 9, 9, 3, 5, 5, 5], (count, 7))
    )
    jump, leap_us = (Corrector().settings[at] for at in (SETTINGS.JUMP_LSB, SETTINGS.LEAP_US))
    for n in np.flatnonzero(draw.random(count) < 0.1)[1:]:
        row, kind = frames[n], draw.integers(8)
        axis, by = draw.integers(3), draw.choice([-1, 0, 1])
        if kind == 0:
            row[0] = draw.choice([0, -1, 1, leap_us + by, 3 * leap_us])
        elif kind == 1:
            row[4] = frames[n - 1, 4] + draw.choice([-1, 1]) * (jump + by)
        elif kind == 2:
            row[5:] = frames[n - 1, 5:]
            row[5 + axis] += by
        elif kind == 3:
            row[5:] = draw.choice([0, -1, row[5]])
            row[5 + axis] += by
        elif kind == 4:
            row[5 + axis] = draw.choice([-1, 1]) * draw.choice([32000 + by, 32766 + by])
        elif kind == 5:
            row[1 + draw.integers(7)] += draw.choice([-1, 1]) * (512 + by)
        elif kind == 6:
            row[1:] = draw.choice([0, -1])
        else:
            row[1:4] += draw.integers(-3000, 3000, 3)
    return [array("i", row.tolist()) for row in frames]


@pytest.mark.parametrize("seed", range(6))
def test_odd_frames_within_a_burst_are_judged_as_by_themselves(seed):
    rows, expected = odd_frames(900, seed), array("i")
    single, burst = (Corrector(motion=False, gravity=False) for _ in range(2))
    for row in rows:
        frame = row[1:]
        expected.append(single.update(frame, row[0]))
        expected.extend(frame)
    words, room = array("i", b"".join(row.tobytes() for row in rows)), array("i", [0] * 7)
    block.block(burst.state, words, burst.settings, room, len(rows))
    assert list(words) == list(expected)
    assert list(burst.state) == list(single.state)


def test_a_corrector_without_machine_code_gives_the_same(one_by_one):
    mode, state, words = one_by_one
    corrector, rows = corrector_for(mode), whole_trace(mode)
    burst = array("i", b"".join(row.tobytes() for row in rows))
    Bursts(corrector).update(burst, len(rows))
    assert (corrector.state.tobytes(), burst.tobytes()) == (state, words)


def test_a_burst_reaches_the_other_sources_too():
    single, burst = Corrector(motion=True), Corrector(motion=True)
    rows = whole_trace("default")[:300]
    words = array("i", b"".join(row.tobytes() for row in rows))
    for row in rows:
        single.update(row[1:], row[0])
    Bursts(burst).update(words, len(rows))
    assert list(burst.motion) == list(single.motion) != list(Corrector(motion=True).motion)


def test_a_source_that_joins_later_sees_the_bursts_that_machine_code_took(monkeypatch):
    def machine_code(state, settings, frames, what):
        room = array("i", [0] * 7)
        block.block(state, frames, settings, room, what - BURST)

    monkeypatch.setattr(rest, "run", machine_code)
    monkeypatch.setattr(rest, "step", machine_code)
    monkeypatch.setattr(rest, "address", lambda words: words, raising=False)
    corrector = corrector_for("default")
    bursts = Bursts(corrector)
    words = array("i", b"".join(row.tobytes() for row in whole_trace("default")[:300]))
    bursts.update(array("i", words), 300)
    assert corrector.state[STATE.COUNTS] > 290
    monkeypatch.undo()
    seen = []
    join(corrector)
    corrector._with_others = lambda sample, dt_us: seen.append(dt_us) or 0
    bursts.update(words, 300)
    assert len(seen) == 300


def on_board(runtime, mode, repository):
    return runtime.run(
        ON_BOARD,
        [mode, trace.UPDATES[mode], "bursts"],
        modules=[repository / "firmware", ON_BOARD.parents[1]],
        files_out=["state.bin", "frames.bin"],
        check=True,
    ).files


# Single updates are compared on all, at several times the time of this one's.
def test_bytecode_gives_the_same_and_allocates_nothing(one_by_one, find_runtime, repository):
    mode, state, words = one_by_one
    files = on_board(find_runtime("x86"), mode, repository)
    assert (files["state.bin"], files["frames.bin"]) == (state, words)
