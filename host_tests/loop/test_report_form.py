"""report.json has the form of `LoopReport`, whatever was found."""

import json
from dataclasses import replace
from types import NoneType, SimpleNamespace, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints, is_typeddict

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools import LoopReport
from zerorate_tools.loop import analyse as loop
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.fit.free_curve import draw
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.motion.scales_and_timing import InMotion, Timing
from zerorate_tools.loop.read.gate import GateReport, TooLittleRest
from zerorate_tools.loop.report import report as form
from zerorate_tools.loop.report import unexplained
from zerorate_tools.loop.report.motion_effects import interference, motion_effects
from zerorate_tools.loop.report.unexplained import measure_next

from . import dense
from .power_ons import MPU, at_rest


def breaches(value, form, where="report"):
    """Where a value has not the form of a type, in words."""
    inside, required = get_args(form), getattr(form, "__required_keys__", frozenset())
    if is_typeddict(form) or get_origin(form) is dict:
        if not isinstance(value, dict):
            return [f"{where} is no object"]
        named = get_type_hints(form) if is_typeddict(form) else dict.fromkeys(value, inside[-1])
        absent = [f"{where} lacks {k}" for k in required - value.keys()]
        absent += [f"{where}.{k} is in no type" for k in value.keys() - named.keys()]
        return absent + [
            b for k, v in value.items() if k in named for b in breaches(v, named[k], f"{where}.{k}")
        ]
    if get_origin(form) is list:
        if not isinstance(value, list):
            return [f"{where} is no list"]
        return [b for i, v in enumerate(value) for b in breaches(v, inside[0], f"{where}[{i}]")]
    if get_origin(form) in (Union, UnionType):
        every = [breaches(value, one, where) for one in inside]
        return min(every, key=len)
    if get_origin(form) is Literal:
        return [] if value in inside else [f"{where} is {value!r}, none of {inside}"]
    fine = isinstance(value, {float: (int, float), Any: object, None: NoneType}.get(form, form))
    return [] if fine else [f"{where} is {value!r}, no {form}"]


@pytest.fixture(scope="module")
def written(closed):
    return json.loads((closed[1] / "report.json").read_text())


def test_every_entry_is_there_and_of_its_kind(written):
    assert breaches(written, LoopReport) == []


def test_effects_keep_their_old_name_for_a_version(written):
    assert written["steps"] == written["effects"]


def test_coefficients_are_three_for_every_source_of_an_effect(written):
    for effect in written["effects"]:
        assert set(effect["coefficients"]) <= set(effect["sources"])
        assert {len(of_axes) for of_axes in effect["coefficients"].values()} == {3}


def test_nothing_is_left_half_written(closed):
    names = {path.name for path in closed[1].iterdir()}
    wanted = {"report.html", "report.json", "model.json", "model.bin", "corrected.parquet"}
    assert names == wanted


def test_what_an_import_declares_a_reference_is_no_channel(closing):
    declared = replace(MPU, more={"channels": {"moving": {"role": "reference"}, "odd": None}})
    wander = np.cumsum(np.random.default_rng(5).normal(0, 3, 3000)).astype(np.int32)
    every = [at_rest(i, n=3000, swing_degc=4.0, moving=wander) for i in range(3)]
    analysis = closing(every, *[declared] * 3)
    assert "moving" not in analysis.sessions[0].sources and analysis.gate.dropped == {}


@pytest.mark.parametrize(
    ("course", "asked"),
    [
        ([52, -18, 74, 36], None),
        ([20, 60], "record a cool-down as fast as the warm-up"),
        ([60, 20], "record a warm-up as fast as the cool-down"),
        ([20, 60, 50], "record a cool-down as fast as the warm-up"),
        ([20, 60, 40], None),
    ],
)
def test_a_course_that_is_there_is_not_asked_for(course, asked):
    places, at = np.linspace(0, 1, len(course)), np.linspace(0, 1, 60)
    session = dense.made(1, 60, names=("temp",))
    session.sources["temp"] = np.interp(at, places, course)
    asks = unexplained._other_way([session])
    assert [ask.split(",")[0] for ask in asks] == ([asked] if asked else [])


POSE = {f"acc_{axis}": np.linspace(0.0, 1.0, 160) for axis in "xyz"}
FULL = {"temp": np.sin(np.arange(160.0) / 9), **POSE, "vdd_mv": np.zeros(160)}


@pytest.mark.parametrize(
    ("lacking", "change", "asked"),
    [
        ((), {}, []),
        (("temp",), {}, ["own temperature"]),
        (tuple(POSE), {}, ["record acceleration", "six orientations"]),
        (("vdd_mv",), {}, ["supply voltage"]),
        ((), {"still": True}, ["six orientations"]),
        ((), {"count": 4}, ["6 or more"]),
        ((), {"blocks": 149}, ["an hour"]),
        ((), {"blocks": 150}, []),
        ((), {"kind": "time-drift"}, ["constant temperature, one of them"]),
        ((), {"kind": "power-on-transient"}, ["constant temperature, one of them"]),
        ((), {"left": True}, ["log humidity and board temperature beside"]),
        ((), {"left": True, "more": ("hum",)}, ["log board temperature beside"]),
        ((), {"left": True, "more": ("Humidity", "pcb_temp")}, ["loosen"]),
        ((), {"away_dps": 0.51}, ["of one device"]),
        ((), {"away_dps": 0.5}, []),
    ],
)
def test_what_to_record_next_is_what_the_recordings_lack(lacking, change, asked):
    def of(blocks=160, count=5, still=False, kind="vibration", left=False, away_dps=0.1, more=()):
        named = {**FULL, **dict.fromkeys(more, np.zeros(160))}
        own = {n: v[:blocks] * (not (still and n in POSE)) for n, v in named.items()}
        own = {n: v for n, v in own.items() if n not in lacking}
        every = [replace(dense.made(k, blocks), sources=own) for k in range(count)]
        found = [SimpleNamespace(candidate=SimpleNamespace(kind=kind))]
        judgement = SimpleNamespace(residual_test=SimpleNamespace(left=left))
        judgement.offsets_dps = [np.array([0.0, -away_dps, 0.0])]
        return SimpleNamespace(
            **{"sessions": every, "train": every[:-1], "holdout": every[-1:], "measured": None},
            **{"selection": SimpleNamespace(found=found), "judgement": judgement},
            single=count == 1,
        )

    told = measure_next(of(**change))
    assert len(told) == len(asked) and all(part in one for part, one in zip(asked, told))


STEPPED = replace(simulate(1, sessions=1).sessions[0], steps=("a step",))


@pytest.mark.parametrize(("whole_dps", "kept"), [(0.9, False), (1.1, True)])
def test_of_one_recording_steps_stay_in_it_where_less_is_left_then(monkeypatch, whole_dps, kept):
    def look(sessions, at, gate, *_):
        assert at == 0 and gate.notes == []
        return SimpleNamespace(steps=sessions[0].steps, listed=sessions[0].listed)

    monkeypatch.setattr(loop, "_look", look)
    monkeypatch.setattr(loop, "remove_steps", lambda sessions: [STEPPED])
    monkeypatch.setattr(loop, "_left_dps", lambda one, *_: 1.0 if one.steps else whole_dps)
    found = analyse([replace(STEPPED, steps=())])
    assert (found.steps, found.listed) == ((("a step",), ()) if kept else ((), ("a step",)))


def test_of_two_recordings_what_is_without_steps_stands(monkeypatch):
    monkeypatch.setattr(loop, "_look", lambda sessions, *_: sessions)
    monkeypatch.setattr(loop, "remove_steps", lambda sessions: [STEPPED, STEPPED])
    assert all(s is STEPPED for s in analyse([STEPPED, STEPPED]))


@pytest.mark.parametrize(
    ("left", "dps"), [([[3.0, 4.0, 0.0]] * 2, 5.0), ([[np.nan, 1.0, 1.0]], np.inf)]
)
def test_what_is_left_of_pieces_is_the_root_of_all_axes_squares(monkeypatch, left, dps):
    pieces = SimpleNamespace(residual=lambda straight, terms, axes: np.array(left))
    monkeypatch.setattr(loop, "_on_pieces", lambda *of: pieces)
    selection = SimpleNamespace(straight=[], terms=[], applied=[])
    one = SimpleNamespace(selection=selection, sessions=[STEPPED])
    assert loop._left_dps(one, None, None) == pytest.approx(dps)


@pytest.mark.parametrize(("count", "at", "fitted"), [(1, 0, [0]), (2, 1, [0]), (3, 0, [1, 2])])
def test_what_is_fitted_is_what_is_not_held_out(monkeypatch, count, at, fitted):
    every, asked = simulate(1, sessions=3).sessions[:count], []
    selection = SimpleNamespace(straight=[], terms=[], found=[])
    judgement = SimpleNamespace(whole=None)
    monkeypatch.setattr(loop, "select", lambda *of: asked.append(of) or selection)
    monkeypatch.setattr(loop, "prune_by_holdout", lambda s, held: (s, judgement))
    for name in ("floor_dps", "name_earth", "periodic"):
        monkeypatch.setattr(loop, name, lambda *of: None)
    monkeypatch.setattr(loop, "deployed", lambda s: ([], None))
    found = loop._look(every, at, GateReport(), InMotion(), None)
    [(train, taken, on_pieces, others)] = asked
    assert [every.index(s) for s in train] == fitted and found.train == train
    assert (taken, on_pieces is None, others) == (0, len(fitted) > 1, count > 1)
    assert found.holdout == [every[at]] and found.sessions == every


@pytest.mark.parametrize(
    ("middle_degc", "asked"), [(20.0, 0), (20.9, 0), (21.2, 1), (19.1, 0), (18.8, 1)]
)
def test_temperatures_are_unseen_a_degree_beyond_what_was_fitted(middle_degc, asked):
    fitted = SimpleNamespace(name="a", degc=np.linspace(18.0, 22.0, 40))
    held = SimpleNamespace(name="b", degc=middle_degc + np.linspace(-2.0, 2.0, 4))
    for one in (fitted, held):
        one.sources, one.available = {"temp": one.degc}, np.ones(len(one.degc), bool)
        one.block_mean = np.array
    analysis = SimpleNamespace(
        single=False, sessions=[fitted, held], train=[fitted], holdout=[held]
    )
    held.degc[1:3] = held.degc[[0, 3]]  # half of it lies at an end
    assert len(unexplained._other_temperatures(analysis)) == asked


@pytest.mark.parametrize(
    ("moving", "found", "notes"),
    [
        ([], False, ["a note"]),
        (["s"], True, ["a note"]),
        (["s"], False, ["a note", "found: nothing in motion; gravity sees 2.50 g"]),
    ],
)
def test_what_motion_shows_is_asked_of_what_is_fitted_and_noted(monkeypatch, moving, found, notes):
    shown = SimpleNamespace(notes=["a note"], found=found, before=2.5, unit="g", reference="")
    asked, gate = [], GateReport(moving=moving)
    monkeypatch.setattr(loop, "in_motion", lambda *of: asked.append(of) or InMotion(shown))
    monkeypatch.setattr(loop, "remove_steps", lambda sessions: sessions)
    monkeypatch.setattr(loop, "_look", lambda sessions, at, *_: at)
    one, two, three = every = simulate(1, sessions=3).sessions
    assert analyse(every, 1, gate, {}) == 1 and analyse(every, gate=GateReport()) == 2
    assert analyse([one]) == 0
    assert [note.split(",")[0] for note in gate.notes] == notes
    trained = [[s.name for s in train] for train, *_ in asked]
    assert trained == [[one.name, three.name], [one.name, two.name], [one.name]]
    assert [[s.name for s in held] for _, held, *_ in asked] == [[two.name], [three.name], []]
    assert [of[2:] for of in asked] == [({}, moving), (None, []), (None, [])]


def test_recordings_that_hardly_rest_are_left_out_or_looked_at_in_motion(monkeypatch):
    calls, faults = [], {"jumps": 1}
    ticks = [SimpleNamespace(name=n, faults=faults, extra={"temp": 0, "load": 0}) for n in "abc"]

    def enough(name):
        if name in rests_not:
            raise TooLittleRest(f"{name} is short")

    for name in ("readable", "same_settings", "without_long_gaps", "shaken", "usable_channels"):
        monkeypatch.setattr(loop, name, lambda *of, name=name: calls.append((name, of[0])))
    monkeypatch.setattr(loop, "sessions_from", lambda of: [t.name for t in of])
    monkeypatch.setattr(loop, "enough", enough)
    monkeypatch.setattr(loop, "may_show_motion", lambda name: name == "b")
    rests_not = "bc"
    kept, gate = loop.sessions_of(ticks)
    assert kept == ["a"] and gate.moving == ["b"] and gate.faults == dict.fromkeys("abc", faults)
    assert gate.notes == ["looked at in motion alone: b is short", "left out: c is short"]
    assert list(gate.dropped) == ["temp"] and "rename" in gate.dropped["temp"]
    before = [(name, ticks) for name in ("readable", "same_settings", "without_long_gaps")]
    assert calls == [*before, ("shaken", ["a"]), ("usable_channels", ["a"])]
    rests_not = "abc"
    with pytest.raises(TooLittleRest, match="a is short; b is short; c is short"):
        loop.sessions_of(ticks)


@pytest.mark.parametrize(("times", "said"), [(3.0, "looks like sensor noise"), (3.1, "3.1 times")])
def test_up_to_three_times_the_floor_a_residual_without_a_form_is_noise(times, said):
    judgement = SimpleNamespace(residual_test=SimpleNamespace(left=False))
    analysis = SimpleNamespace(judgement=judgement, floor_dps=np.array([0.5, 1.0, 0.0]))
    told = unexplained.what_is_known(analysis, np.array([times * 0.5, 1.0, 0.0]))
    assert said in told and ("follows no recorded channel" in told) is (times > 3)


def line(hz):
    return SimpleNamespace(hz=hz, amplitude_dps=np.ones(3), p_value=1e-9, in_holdout=True)


@pytest.mark.parametrize(
    ("found", "moved", "hz", "left", "said"),
    [
        ([], False, (), False, "nothing-found"),
        ([], False, (0.5, 2.0), False, "nothing-found"),
        ([], False, (0.5,), True, "unexplained-residual"),
        ([1], False, (), True, "effects-found"),
        ([], True, (), True, "effects-found"),
        ([], False, (2.0, 0.49), True, "effects-found"),
    ],
)
def test_a_verdict_is_by_what_is_in_the_bias(found, moved, hz, left, said):
    analysis = SimpleNamespace(
        selection=SimpleNamespace(found=found),
        motion=InMotion(timing=Timing(1.0, 0.1, 1e-9, (1.0,)) if moved else None),
        lines=[line(one) for one in hz],
        judgement=SimpleNamespace(residual_test=SimpleNamespace(left=left)),
        few=False,
    )
    assert form.verdict(analysis) == said
    told = [one["effect"] for one in motion_effects(analysis, [1.0, 2.0, 3.0])]
    slow = [one for one in hz if one < 0.5]
    assert told == ["sample-timing"] * moved + ["periodic-interference"] * len(slow)
    assert [one["hz"] for one in interference(analysis.lines)] == [h for h in hz if h >= 0.5]


@pytest.mark.parametrize(
    ("table", "beside", "told"),
    [((0.5,) * 9, (), True), (None, (), False), ((0.5,) * 9, (1,), False)],
)
def test_what_a_curve_s_one_form_loses_is_told_of_a_single_slot(table, beside, told):
    term = replace(dense.A, lo=-4.0, hi=4.0, table=table)
    regression = Regression([dense.made(1, 40), dense.made(2, 40)])
    rest = SimpleNamespace(straight=[dense.B], terms=[dense.C])
    selection = SimpleNamespace(regression=regression, without=[rest].__getitem__)
    selection.found = [SimpleNamespace(candidate=SimpleNamespace(terms=[term, *beside]))]
    lost = form._lost(selection, 0)
    assert (list(lost) == ["lost_by_projection"]) is told
    if told:
        every = draw(regression, [dense.B, dense.C], term)[1]
        assert list(lost.values()) == [pytest.approx(every, abs=6e-5)]


def test_coefficients_are_named_by_source_power_and_the_place_of_a_bend():
    bend, square = replace(dense.A, knot=2.5, centre=30.0), replace(dense.A, power=2)
    for terms, names in (
        ([dense.A, dense.B], ["a", "b"]),
        ([dense.A, square, dense.B], ["a^1", "a^2", "b"]),
        ([dense.A, bend], ["a^1", "a>32.5"]),
    ):
        own = [SimpleNamespace(term=term) for term in terms]
        assert [form._name(slot, own) for slot in own] == names
