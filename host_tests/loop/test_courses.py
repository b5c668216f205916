"""What the firmware makes of an analysis: which models are run over which sessions, and pruned."""

from copy import copy
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_tools.loop.motion.scales_and_timing import InMotion
from zerorate_tools.loop.verify import courses, run_kernels
from zerorate_tools.loop.verify.analysis import model_of
from zerorate_tools.loop.verify.power_on import TurnOn
from zerorate_tools.model import Slot, drafted
from zerorate_tools.model.term import Term, first_order_lag

from . import dense
from .dense import A, B
from .power_ons import MPU, PER, powered_on, with_volts
from .selections import analysed, found, selected

VOLTS = Term("vdd_mv", 4900.0, 5100.0, 5000.0)
WARM = Term("temp", -20.0, 30.0, 5.0, power=2)


class Counting:
    """A device that subtracts its number and, learning, one LSB more for every sample it lives."""

    def __init__(self, scales, model, channels=()):
        self.number = 0 if model is None else model
        self.lived, self.on, self.offset = 0, 0, np.zeros(3, int)

    def copy(self):
        return copy(self)

    def power_on(self):
        self.on += 1

    def set_offset(self, offset_q8):
        self.offset = np.array(offset_q8)

    def run(self, frames, learn=True):
        bias = np.full((len(frames), 3), 256 * self.number) + self.offset
        if learn:
            bias = bias + 256 * (self.lived + np.arange(len(frames)))[:, None]
            self.lived += len(frames)
        return bias


@pytest.fixture
def lived(answers, monkeypatch, tmp_path):
    """lived(*models): devices that have lived through session a; b is held out."""
    monkeypatch.setattr(courses, "Firmware", Counting)
    answers(courses, turn_on=TurnOn(np.array([128, 0, -128]), 3))
    pair = [powered_on(tmp_path, with_volts(i, 6), name=n) for i, n in enumerate("ab")]

    def live(*models, inside=None):
        runs = courses.SessionRuns(pair, ["a"], ["b"], models, MPU, inside or {})
        runs.learn()
        return runs

    return live


def nothing(name, frames, biases):
    pass


#: By the middle of each block.
LEARNED_LSB = 9.5 + 20 * np.arange(6)


def x_lsb(course, way):
    return course.bias[way][:, 0] * 131


def test_devices_live_through_the_training_and_are_run_frozen_over_what_is_held_out(lived):
    runs, seen = lived(None, 1, 2), []
    assert [(d.lived, d.on) for d in runs.devices] == [(120, 1)] * 3
    note = lambda name, frames, biases: seen.append((name, len(frames), {*biases}))  # noqa: E731
    course = runs.course("b", False, note)
    ways = {"before", "after_1", "after", "online_before", "online"}
    assert set(course.residual) == ways and seen == [("b", 120, ways)]
    assert set(course.offset_dps) == {"before", "after_1", "after"}
    assert course.time_s.tolist() == [2, 6, 10, 14, 18, 22]
    assert course.offset_dps["after"] * 131 == pytest.approx([0.5, 0, -0.5])
    for way, number in (("before", 0), ("after_1", 1), ("after", 2)):
        assert course.bias[way][0] * 131 == pytest.approx([number + 0.5, number, number - 0.5])
    left = runs.power_ons["b"].rate_dps - course.bias["after"]
    assert np.isnan(course.residual["after"][:3]).all()
    assert course.residual["after"][3:] == pytest.approx(left[3:])
    # learning, it goes on from what the training taught
    assert x_lsb(course, "online_before") == pytest.approx(120 + LEARNED_LSB)
    assert x_lsb(course, "online") == pytest.approx(122 + LEARNED_LSB)
    assert [d.lived for d in runs.devices] == [120] * 3


def test_over_what_was_fitted_only_before_and_after_are_run_and_online_as_it_began(lived):
    runs = lived(None, 1, 2)
    assert set(runs.course("a", False, nothing).residual) == {"before", "after"}
    course = runs.course("a", True, nothing)
    assert set(course.residual) == {"before", "after", "online_before", "online"}
    assert x_lsb(course, "online") == pytest.approx(2 + LEARNED_LSB)
    assert x_lsb(course, "online_before") == pytest.approx(LEARNED_LSB)


@pytest.mark.parametrize(
    ("few", "single", "inside"), [(True, False, ["a", "b"]), (True, True, []), (False, False, [])]
)
def test_where_few_were_fitted_pieces_of_them_are_left_out_too(few, single, inside):
    train = [SimpleNamespace(name=name) for name in "ab"]
    assert run_kernels._inside(SimpleNamespace(train=train, few=few, single=single)) == inside


def test_models_are_none_those_of_the_first_effects_and_the_whole_one(supplied):
    analysis = analysed(supplied, found(VOLTS), found(WARM))
    whole = model_of(analysis, MPU)
    none, first, last = run_kernels.models_of(analysis, whole, MPU)
    assert none is None and last is whole and len(last.slots) == 2
    alone = analysis.selection.regression.fit([VOLTS]).coefficients[0]
    assert first.slots[0].coefficient_dps == pytest.approx(alone, rel=0.02)
    bare = analysed(supplied)
    assert run_kernels.models_of(bare, model_of(bare, MPU), MPU) == [None]
    scales = SimpleNamespace(found=True, fastest_dps=np.ones(3), deployed=np.eye(3) / 99, kind="x")
    moved = replace(analysis, motion=InMotion(scales))
    models = run_kernels.models_of(moved, whole, MPU)
    assert [len(m.slots) for m in models[1:]] == [1, 2, 2] and models[-1] is whole


def test_what_the_integers_round_is_the_difference_to_the_same_terms_in_floats(tmp_path):
    columns = with_volts(0, 20)
    columns["volt"] = np.rint(5000 + 300 * np.sin(np.arange(400) / 40)).astype(np.int32)
    p = powered_on(tmp_path, columns, ("volt",))
    term = Term("volt", 4000.0, 6000.0, 5000.0, lag_mode="lag", lag_s=8.0)
    told = np.array([[0.001, -0.002, 0.0]])
    model = drafted([Slot(term, tuple(told[0]), "x")], MPU, tick_s=1.0)
    exact = run_kernels.rounding_dps(p, model, [term], told, MPU)
    assert exact[2] == 0 and exact[:2].max() < 2e-3
    wrong = run_kernels.rounding_dps(p, model, [term], told + [[0.001, 0.0, 0.0]], MPU)
    lagged = first_order_lag(p.session.sources["volt"] - 5000.0, 8.0, 1.0)
    held = np.r_[lagged[0], lagged[:-1]].reshape(20, 4).mean(axis=1)
    assert wrong[0] == pytest.approx(0.001 * np.sqrt((held**2).mean()), rel=0.02)


@pytest.mark.parametrize(("alone", "stays"), [(0.95, True), (0.5, False)])
def test_an_effect_in_doubt_is_asked_what_the_others_do_alone(alone, stays):
    def measured(**ways):
        left = {way: np.full((4, 3), dps) for way, dps in ways.items()}
        return courses.Courses({"h": courses.Course(np.arange(4), {}, left)}, ["h"], np.zeros(3))

    two, asked = selected([dense.made(1, 24)], found(A), found(B)), []

    def again(selection):
        asked.append(selection.terms)
        return measured(before=9.0, after_1=alone, after=9.0)

    needed = measured(before=1.0, after_1=1.5, after=0.9)
    less = run_kernels._without_harmful(two, needed, again)
    assert (less is two) == stays and asked[-1] == [B]


@pytest.fixture
def switching(tmp_path):
    """Four power-ons whose bias follows a voltage that switches, and the analysis of it."""
    every = []
    for i, name in enumerate("abcd"):
        columns = with_volts(i, 40)
        columns["volt"] += (400 * (np.arange(800) % 400 > 200)).astype(np.int32)
        columns["gx"] += np.rint((columns["volt"] - 5000) * 0.1).astype(np.int32)
        every.append(powered_on(tmp_path, columns, name=name))
    effect = found(Term("volt", 4000.0, 6000.0, 5000.0))
    return analysed([p.session for p in every], effect), [p.path for p in every], columns


def test_a_whole_device_is_measured_and_written(switching, tmp_path):
    analysis, logs, columns = switching
    out, steps = tmp_path / "corrected.parquet", []
    told, model = run_kernels.run_and_prune(analysis, logs, out, True, steps.append)
    assert len(model.slots) == 1 and steps == [1] * len(steps) and len(steps) % 4 == 0
    assert told.judgement.after_dps[0] < 0.3 * told.judgement.before_dps[0]
    whole = told.measured
    assert (whole.holdout, whole.inside, set(whole.sessions)) == (["d"], [], set("abcd"))
    assert whole.rounding_dps.max() < 1e-3
    table = pq.read_table(out).to_pandas()
    last = table["recording"] == "d.parquet"
    assert set(table[last]["split"]) == {"test"} and set(table[~last]["split"]) == {"train"}
    assert "bias_online_gx" in table
    left = (columns["gx"] - table[last]["bias_after_gx"]).to_numpy()
    blocks = left.reshape(40, PER).mean(axis=1)[15:] / 131
    assert np.sqrt((blocks**2).mean()) == pytest.approx(told.judgement.after_dps[0], rel=0.05)
    other = run_kernels._measured(told, logs, MPU, told.selection.first(0))
    ways = {"before", "after", "online", "online_before"}
    assert other.holdout == ["d"] and set(other.sessions["d"].residual) == ways
    assert other.residuals("before")[0] == pytest.approx(whole.residuals("before")[0], nan_ok=True)
    assert told.gate.notes == []


def test_an_effect_that_no_part_can_deploy_is_left_out(switching, tmp_path, monkeypatch):
    analysis, logs, _ = switching
    measure = run_kernels.run_kernels

    def refuse(of, *more):
        if of.selection.found:
            raise run_kernels.CannotDeploy("too large")
        return measure(of, *more)

    monkeypatch.setattr(run_kernels, "run_kernels", refuse)
    told, model = run_kernels.run_and_prune(analysis, logs, tmp_path / "corrected.parquet")
    assert not model.slots and told.gate.notes == ["found but left out: too large"]
