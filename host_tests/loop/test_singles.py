"""One simulated recording or two, judged by the truth."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_bench.loop.single_devices import KINDS, describe
from zerorate_bench.loop.singles import (
    Single,
    _about,
    look_at_singles,
    single_figures,
    tellable,
)
from zerorate_tools.loop.search.steps import Step


def single(kind="nothing", after=1.0, kept=("thermal-lag",), **more):
    errors = dict.fromkeys(("at rest", "in motion", "a further power-on"), (1.0, after))
    return Single(
        kind, 1, 1, errors, list(kept), **{"steps": 0, "listed": 0, "invented": 0, **more}
    )


def figure(name, singles):
    return next(f for f in single_figures(singles) if f.name.startswith(name))


@pytest.mark.parametrize("after, worse", [(1.01, 0.0), (1.03, 100.0)])
def test_what_is_deployed_is_worse_by_more_than_two_percent_or_not(after, worse):
    every = [single(kind, after) for kind in KINDS]
    assert figure("deployed and worse by more than 2 %, at rest", every).value == worse


def test_nothing_deployed_is_nothing_worse():
    every = [single(kind, 2.0, kept=()) for kind in KINDS]
    assert figure("deployed and worse", every).value == 0.0


def test_steps_are_listed_or_invented():
    every = [single("step", steps=1, listed=i < 5, invented=0) for i in range(6)]
    assert figure("steps of 3 floors RMS listed", every).value == pytest.approx(500 / 6)
    assert not figure("steps of 3 floors RMS listed", every).met


def test_an_error_is_about_the_mean_at_rest_of_its_own_stretch():
    error = np.repeat([[1.0], [5.0]], 4, axis=0) * np.ones(3)
    rest = np.array([1, 1, 0, 0, 1, 1, 0, 0], bool)
    error[2:4] += 0.5
    (left,) = _about([error], np.repeat([0, 1], 4), rest, ~rest)
    assert left[:, 0].tolist() == [0.5, 0.5, 0.0, 0.0]


@pytest.mark.parametrize("times, least, most", [(0.05, 0.0, 0.05), (10.0, 0.99, 1.0)])
def test_who_knows_the_noise_lists_large_steps_and_no_small_ones(times, least, most):
    (session,) = simulate(3, sessions=1, bare=True).sessions
    dps = times * np.diff(session.rate_dps, axis=0).std(axis=0)
    chance = tellable(session, {"at_s": session.blocks * session.block_s / 2, "dps": dps})
    assert least <= chance <= most


def test_a_step_that_was_listed_is_not_beside_itself():
    (session,) = simulate(3, sessions=1, bare=True).sessions
    at_s = session.blocks * session.block_s / 2
    dps = np.diff(session.rate_dps, axis=0).std(axis=0)
    found = Step(0, session.blocks // 2, dps, ratio=100.0, p_value=0.0, at_s=at_s)
    listed = replace(session, steps=(found,))
    step = {"at_s": at_s, "dps": dps}
    assert tellable(listed, step) == tellable(session, step)


def test_every_kind_is_described_with_its_effect():
    kinds = {describe(seed)[1]: describe(seed)[0] for seed in range(7)}
    assert list(kinds) == list(KINDS)
    without = [kind for kind, d in kinds.items() if not d["effect"]]
    assert without == ["nothing", "shock"]


def test_a_run_broken_off_goes_on_from_its_file(tmp_path):
    kept, known = tmp_path / "outcomes.jsonl", [replace(single(), seed=i) for i in range(2)]
    kept.write_text("".join(json.dumps(asdict(s)) + "\n" for s in known), encoding="utf-8")
    assert [s.seed for s in look_at_singles(2, resume=kept)] == [0, 1]
