"""One analysis, decision by decision: what is fitted, looked at in motion, and left out."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop import analyse as loop
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.motion.scales_and_timing import InMotion
from zerorate_tools.loop.read.gate import GateReport, TooLittleRest

#: A step is a word here: nothing looks into it.
STEPPED = replace(simulate(1, sessions=1).sessions[0], steps=("a step",))


@pytest.fixture(scope="module")
def three():
    return simulate(1, sessions=3).sessions


@pytest.mark.parametrize(
    ("whole_dps", "steps", "said"), [(0.9, (), ("a step",)), (1.1, ("a step",), ())]
)
def test_of_one_recording_steps_stay_in_it_where_less_is_left_then(
    monkeypatch, answers, whole_dps, steps, said
):
    def look(sessions, at, gate, *_):
        assert at == 0 and gate.notes == []
        return SimpleNamespace(steps=sessions[0].steps, listed=sessions[0].listed)

    answers(loop, remove_steps=[STEPPED])
    monkeypatch.setattr(loop, "_look", look)
    monkeypatch.setattr(loop, "_left_dps", lambda one, *_: 1.0 if one.steps else whole_dps)
    told = analyse([replace(STEPPED, steps=())])
    assert (told.steps, told.listed) == (steps, said)


def test_of_two_recordings_what_is_without_steps_stands(monkeypatch, answers):
    answers(loop, remove_steps=[STEPPED, STEPPED])
    monkeypatch.setattr(loop, "_look", lambda sessions, *_: sessions)
    assert all(s is STEPPED for s in analyse([STEPPED, STEPPED]))


@pytest.mark.parametrize(
    ("left", "dps"), [([[3.0, 4.0, 0.0]] * 2, 5.0), ([[np.nan, 1.0, 1.0]], np.inf)]
)
def test_what_is_left_of_pieces_is_the_root_of_all_axes_squares(answers, left, dps):
    pieces = SimpleNamespace(residual=lambda straight, terms, axes: np.array(left))
    answers(loop, _on_pieces=pieces)
    selection = SimpleNamespace(straight=[], terms=[], applied=[])
    one = SimpleNamespace(selection=selection, sessions=[STEPPED])
    assert loop._left_dps(one, None, None) == pytest.approx(dps)


@pytest.mark.parametrize(("count", "at", "fitted"), [(1, 0, [0]), (2, 1, [0]), (3, 0, [1, 2])])
def test_what_is_fitted_is_what_is_not_held_out(monkeypatch, answers, three, count, at, fitted):
    every, asked = three[:count], []
    selection = SimpleNamespace(straight=[], terms=[], found=[], regression=None)
    pruned = selection, SimpleNamespace(whole=None)
    answers(loop, prune_by_holdout=pruned, deployed=([], None))
    answers(loop, floor_dps=None, name_earth=None, periodic=None)
    monkeypatch.setattr(loop, "select", lambda *of: asked.append(of) or selection)
    told = loop._look(every, at, GateReport(), InMotion(), None)
    [(train, taken, on_pieces, several)] = asked
    assert [every.index(s) for s in train] == fitted and told.train == train
    assert (taken, on_pieces is None, several) == (0, len(fitted) > 1, count > 1)
    assert told.holdout == [every[at]] and told.sessions == every


@pytest.mark.parametrize(
    ("moving", "found", "notes"),
    [
        ([], False, ["a note"]),
        (["s"], True, ["a note"]),
        (["s"], False, ["a note", "found: nothing in motion; gravity sees 2.50 g"]),
    ],
)
def test_what_motion_shows_is_asked_of_what_is_fitted_and_noted(
    monkeypatch, three, moving, found, notes
):
    shown = SimpleNamespace(notes=["a note"], found=found, before=2.5, unit="g", reference="")
    asked, gate = [], GateReport(moving=moving)

    def in_motion(train, held, *of):
        asked.append(([s.name for s in train], [s.name for s in held], *of))
        return InMotion(shown)

    monkeypatch.setattr(loop, "in_motion", in_motion)
    monkeypatch.setattr(loop, "remove_steps", lambda sessions: sessions)
    monkeypatch.setattr(loop, "_look", lambda sessions, at, *_: at)
    assert analyse(three, 1, gate, {}) == 1 and analyse(three, gate=GateReport()) == 2
    assert analyse(three[:1]) == 0
    assert [note.split(",")[0] for note in gate.notes] == notes
    a, b, c = (s.name for s in three)
    assert asked == [([a, c], [b], {}, moving), ([a, b], [c], None, []), ([a], [], None, [])]


@pytest.fixture
def gated(monkeypatch):
    """gated(those with too little rest): what is kept of a, b and c, and what was asked."""
    calls, faults = [], {"jumps": 1}
    ticks = [SimpleNamespace(name=n, faults=faults, extra={"temp": 0, "load": 0}) for n in "abc"]
    for name in ("readable", "same_settings", "without_long_gaps", "shaken", "usable_channels"):
        monkeypatch.setattr(loop, name, lambda of, *_, name=name: calls.append((name, of)))
    monkeypatch.setattr(loop, "sessions_from", lambda of: [t.name for t in of])
    monkeypatch.setattr(loop, "may_show_motion", lambda name: name == "b")

    def run(rests_not):
        def enough(name):
            if name in rests_not:
                raise TooLittleRest(f"{name} is short")

        monkeypatch.setattr(loop, "enough", enough)
        return *loop.sessions_of(ticks), calls, ticks

    return run


def test_recordings_that_hardly_rest_are_left_out_or_looked_at_in_motion(gated):
    kept, gate, calls, ticks = gated("bc")
    assert kept == ["a"] and gate.moving == ["b"]
    assert gate.faults == dict.fromkeys("abc", {"jumps": 1})
    assert gate.notes == ["looked at in motion alone: b is short", "left out: c is short"]
    assert list(gate.dropped) == ["temp"] and "rename" in gate.dropped["temp"]
    before = [(name, ticks) for name in ("readable", "same_settings", "without_long_gaps")]
    assert calls == [*before, ("shaken", ["a"]), ("usable_channels", ["a"])]
    with pytest.raises(TooLittleRest, match="a is short; b is short; c is short"):
        gated("abc")
