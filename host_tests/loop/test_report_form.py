"""report.json has the form of `LoopReport`, whatever was found; what is known of what remains, and
what to record next."""

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
from zerorate_tools.loop.report import unexplained
from zerorate_tools.loop.report.unexplained import measure_next

from . import dense
from .power_ons import MPU, at_rest
from .selections import found


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
        judgement = SimpleNamespace(residual_test=SimpleNamespace(left=left))
        judgement.offsets_dps = [np.array([0.0, -away_dps, 0.0])]
        parts = {
            "train": every[:-1],
            "holdout": every[-1:],
            "selection": SimpleNamespace(found=[found(kind=kind)]),
        }
        return SimpleNamespace(
            sessions=every, single=False, measured=None, judgement=judgement, **parts
        )

    told = measure_next(of(**change))
    assert len(told) == len(asked) and all(part in one for part, one in zip(asked, told))


@pytest.mark.parametrize(
    ("middle_degc", "asked"), [(20.0, 0), (20.9, 0), (21.2, 1), (19.1, 0), (18.8, 1)]
)
def test_temperatures_are_unseen_a_degree_beyond_what_was_fitted(middle_degc, asked):
    fitted, held = dense.made(1, 40, names=("temp",)), dense.made(2, 4, names=("temp",))
    fitted.sources["temp"] = np.linspace(18.0, 22.0, 40)
    held.sources["temp"] = middle_degc + np.array([-2.0, -2.0, 2.0, 2.0])
    analysis = SimpleNamespace(
        single=False, sessions=[fitted, held], train=[fitted], holdout=[held]
    )
    assert len(unexplained._other_temperatures(analysis)) == asked


@pytest.mark.parametrize(("times", "said"), [(3.0, "looks like sensor noise"), (3.1, "3.1 times")])
def test_up_to_three_times_the_floor_a_residual_without_a_form_is_noise(times, said):
    judgement = SimpleNamespace(residual_test=SimpleNamespace(left=False))
    analysis = SimpleNamespace(judgement=judgement, floor_dps=np.array([0.5, 1.0, 0.0]))
    told = unexplained.what_is_known(analysis, np.array([times * 0.5, 1.0, 0.0]))
    assert said in told and ("follows no recorded channel" in told) is (times > 3)
