"""What is known of what remains, and what to record next."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_tools.loop.report import unexplained
from zerorate_tools.loop.report.unexplained import measure_next

from . import dense
from .selections import found


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
