"""report.json has the form of `LoopReport`, whatever was found."""

import json
from dataclasses import replace
from functools import partial
from types import NoneType, SimpleNamespace, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints, is_typeddict

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools import LoopReport
from zerorate_tools.loop import analyse as loop
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.motion.scales_and_timing import InMotion
from zerorate_tools.loop.read.gate import GateReport
from zerorate_tools.loop.report import unexplained
from zerorate_tools.loop.report.unexplained import measure_next

from . import power_ons
from .power_ons import MPU


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


N = 3000
at_rest = partial(power_ons.at_rest, n=N, swing_degc=4.0)


@pytest.mark.parametrize(
    ("other", "asked"),
    [
        ({"bias_lsb": 160}, "of one device: s2 begins 1.2 dps away from the others"),
        ({"middle_degc": 40.0}, "s2 has 36 to 44 degC, the fitted ones 21 to 29"),
    ],
)
def test_a_recording_unlike_the_others_is_asked_about(closing, other, asked):
    assert asked in measure_next(closing([at_rest(0), at_rest(1), at_rest(2, **other)]))[0]


def test_of_recordings_alike_neither_is_asked(closing):
    asked = " ".join(measure_next(closing([at_rest(i) for i in range(3)])))
    assert "one device" not in asked and "whole range" not in asked


@pytest.mark.parametrize(
    ("lacking", "asked"),
    [(("temp",), "own temperature"), (("ax", "ay", "az"), "record acceleration")],
)
def test_a_sensor_that_was_not_recorded_is_asked_for_first(closing, lacking, asked):
    columns = {name: values for name, values in at_rest(0).items() if name not in lacking}
    first, *rest = measure_next(closing([columns]))
    assert asked in first
    assert not any("own temperature" in r or "record acceleration" in r for r in rest)


def test_what_an_import_declares_a_reference_is_no_channel(closing):
    declared = replace(MPU, more={"channels": {"moving": {"role": "reference"}, "odd": None}})
    wander = np.cumsum(np.random.default_rng(5).normal(0, 3, N)).astype(np.int32)
    analysis = closing([at_rest(i, moving=wander) for i in range(3)], *[declared] * 3)
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
    (session,) = simulate(1, sessions=1).sessions
    places = np.linspace(0, 1, len(course))
    at = np.linspace(0, 1, len(session.sources["temp"]))
    session.sources["temp"] = np.interp(at, places, course)
    asks = [ask for ask in measure_next(analyse([session])) if "as fast as" in ask]
    assert [ask.split(",")[0] for ask in asks] == ([asked] if asked else [])


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


@pytest.mark.parametrize(("count", "at", "fitted"), [(1, 0, [0]), (3, 2, [0, 1]), (3, 0, [1, 2])])
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
