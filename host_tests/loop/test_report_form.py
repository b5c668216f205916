"""report.json has the form of `LoopReport`, whatever was found."""

import json
from dataclasses import replace
from functools import partial
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints, is_typeddict

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools import LoopReport
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.report.unexplained import _unrecorded, measure_next

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


def test_figures_are_of_three_axes(written):
    for one in (written, *written["effects"]):
        assert [len(one[key]) for key in ("before_mdps", "after_mdps")] == [3, 3]
    assert len(written["floor_mdps"]) == len(written["online"]["after_mdps"]) == 3


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


def test_a_wrong_form_is_noticed(written):
    broken = {**written, "floor_mdps": [1.0, None], "effects": [{}], "new": 1, "verdict": "so"}
    found = " ".join(breaches(broken, LoopReport))
    for said in ("floor_mdps[", "effects[0] lacks effect", "new is in no type", "verdict is 'so'"):
        assert f"report.{said}" in found


N = 3000
at_rest = partial(power_ons.at_rest, n=N, swing_degc=4.0)


@pytest.mark.parametrize(
    ("other", "asked"),
    [
        ({"bias_lsb": 160}, "of one device: s2 begins 1.2 dps away from what the others taught"),
        ({"middle_degc": 40.0}, "s2 goes from 36 to 44 degC, what was fitted from 21 to 29"),
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


def test_one_recording_alone_speaks_of_its_pieces(closing):
    result = report(closing([at_rest(0)]))
    assert not any("sessions" in why for _, why in result["gate"]["considered_and_refused"])


@pytest.mark.parametrize(
    ("course", "asked"),
    [
        ([52, -18, 74, 36], None),
        ([20, 60], "a cool-down at the same rate as the warm-up"),
        ([60, 20], "a warm-up at the same rate as the cool-down"),
    ],
)
def test_a_course_that_is_there_is_not_asked_for(course, asked):
    (session,) = simulate(1, sessions=1).sessions
    places = np.linspace(0, 1, len(course))
    at = np.linspace(0, 1, len(session.sources["temp"]))
    session.sources["temp"] = np.interp(at, places, course)
    told = [t for t in measure_next(analyse([session])) if "at the same rate" in t]
    assert [t.split(" (")[0] for t in told] == ([asked] if asked else [])


def test_a_humidity_that_is_there_is_not_asked_for():
    assert "humidity" in _unrecorded(["temp"]) and "board temperature" in _unrecorded(["temp"])
    assert _unrecorded(["temp", "humidity_mpct", "aht_temp_mdegc"]) == "one screw loosened"
