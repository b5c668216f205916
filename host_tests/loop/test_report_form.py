"""report.json has the form of `LoopReport`, whatever was found."""

import json
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints, is_typeddict

import pytest
from zerorate_tools import LoopReport


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
