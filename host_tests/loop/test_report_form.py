"""report.json has the form of `LoopReport`, whatever was found."""

import json
from dataclasses import replace
from types import NoneType, SimpleNamespace, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints, is_typeddict

import numpy as np
import pytest
from zerorate_tools import LoopReport
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.fit.smooth import draw
from zerorate_tools.loop.report import report as form

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
