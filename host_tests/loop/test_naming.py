"""The name of what was found, and what else it may be."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.read.earth import Earth
from zerorate_tools.loop.search import naming
from zerorate_tools.model.term import Term

from . import dense
from .dense import A, B
from .selections import candidate, found

LAGGED = Term("a", lag_s=0.1, lag_mode="lag")
LATE = candidate(LAGGED, kind="channel-lag", family="generic")
SHAKEN, SUPPLIED = candidate(A), candidate(B, kind="supply-voltage")


@pytest.fixture
def regression(sessions):
    """Three sessions whose bias follows a source, and another that is all but the same."""
    for s in sessions:
        s.sources["twin"] = s.sources["a"] * 1.0001
    return Regression([dense.following(s) for s in sessions])


def test_groups_alike_share_the_posterior_by_the_levels_of_their_families(regression):
    twin = candidate(Term("twin"), kind="channel", family="generic")

    def posterior(chosen, *every):
        ratios = regression.gains([], [c.terms for c in every]).sum(axis=1)
        return naming.posterior(regression, [], chosen, every, ratios)

    told = posterior(LATE, LATE, twin, SHAKEN, SUPPLIED)
    assert told[0][0] is SHAKEN and SUPPLIED not in [c for c, _ in told]
    nats = {c.label: n for c, n in told}
    assert nats["vibration"] - nats["channel(twin)"] == pytest.approx(np.log(50), abs=0.1)
    # a group of two places has half the weight where one of them alone fits
    again = dict(posterior(twin, SHAKEN, candidate(B), twin))
    assert again[SHAKEN] - again[twin] == pytest.approx(np.log(25), abs=0.1)


def test_the_likeliest_is_named_with_what_else_it_may_be(regression):
    twin = candidate(replace(A, centre=1.0), kind="channel", family="generic")
    pool = [SHAKEN, SUPPLIED]

    def named(effect, pool=pool, bends=0, passes=True):
        may = lambda own, others: passes or own.terms != (A,)  # noqa: E731
        naming.name_found(regression, (), [effect], pool, bends, may)
        return effect.candidate.kind

    late = found(LAGGED, kind="channel-lag", family="generic")
    assert named(late, passes=False) == "channel-lag", "the likelier one does not pass"
    assert named(late) == "vibration" and late.confounded_with == []
    assert late.probabilities["vibration"] > 0.95
    kept = found(LAGGED, kind="channel-lag", family="generic", rivals={"other": 0.0})
    assert named(kept, [*pool, twin], bends=1) == "channel-lag"
    assert set(kept.rivals) == {"other", "vibration"}
    slope = found(Term("temp", 10.0, 40.0), kind="temperature-polynomial")
    assert named(slope) == "temperature-polynomial"


@pytest.mark.parametrize(
    ("kind", "dps", "known", "named"),
    [
        ("linear-acceleration", 0.002, True, ["earth-rotation"]),
        ("squared-acceleration", 0.002, True, ["earth-rotation"]),
        ("linear-acceleration", 50.0, True, []),
        ("vibration", 0.002, True, []),
        ("linear-acceleration", 0.002, False, []),
    ],
)
def test_earth_is_named_beside_what_follows_a_pose_and_is_no_larger(
    sessions, kind, dps, known, named
):
    for s in sessions:
        s.sources["acc_x"] = np.sign(s.sources["a"])
        s.earth = Earth(np.zeros((s.blocks, 3)), 0.004, "") if known else None
    pose = Term("acc_x")
    effect = found(pose, kind=kind)
    deployed = np.array([[9.0] * 3, [dps, 0, 0]])
    naming.name_earth([effect], [B, pose], deployed, Regression(sessions))
    assert effect.confounded_with == named
