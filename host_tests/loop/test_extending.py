"""A row added to the effects is all that finding, deploying and telling it needs."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search.catalogue import candidates
from zerorate_tools.loop.search.select import straight_line
from zerorate_tools.model import Slot, build_model, decoded, effects, encoded
from zerorate_tools.model.effects import ANY_CHANNEL, Effect
from zerorate_tools.recordings import Scales
from zerorate_tools.report import sentences
from zerorate_tools.simulate import simulate as simulated_device

ROOT = Effect("square-root", ANY_CHANNEL, "its square root", "It follows the root.", curve=np.sqrt)
SCALES = Scales("MPU-6050", 25.0, 131.0, 16384.0, 340.0, 36.53)
AXES = np.array([0.05, -0.025, 0.035])


@pytest.fixture(autouse=True)
def rows(monkeypatch):
    monkeypatch.setattr(effects, "EFFECTS", (*effects.EFFECTS, ROOT))


@pytest.fixture(scope="module")
def sessions():
    """The bias follows the root of the load, and nothing of the sort is in the catalogue."""
    return [
        replace(s, rate_dps=s.rate_dps + np.outer(s.block_mean(np.sqrt(s.sources["load"])), AXES))
        for s in simulate(11).sessions[:3]
    ]


def best(sessions):
    """The candidate of the load that explains most."""
    pool = [c for c in candidates(sessions) if c.sources == ["load"]]
    gains = Regression(sessions).gains(list(straight_line(sessions)), [c.terms for c in pool])
    return pool[int(gains.sum(axis=1).argmax())]


def test_it_explains_the_bias_better_than_any_other_form_of_the_channel(sessions):
    assert best(sessions).kind == "square-root"


def test_it_is_deployed_as_nine_points(sessions):
    slot = Slot(best(sessions).terms[0], tuple(AXES), "square-root")
    model = decoded(encoded(build_model([slot], SCALES, tick_s=1.0)))
    assert np.allclose(model.slots[0].term.table, slot.term.table, atol=1e-6)
    assert max(map(abs, slot.term.table)) == 1


def test_it_is_told_in_words(sessions):
    assert sentences.title("square-root(load)") == "load, its square root"
    assert sentences.meaning("square-root(load)").startswith("It follows the root.")
    assert "curve" in sentences.per_unit(best(sessions).terms[0].to_dict())


def test_it_is_no_candidate_where_it_has_no_value(sessions):
    below = [replace(s, sources={**s.sources, "load": s.sources["load"] - 2}) for s in sessions]
    assert "square-root" not in {c.kind for c in candidates(below) if c.sources == ["load"]}


def test_it_can_be_simulated():
    wave = {"kind": "channel", "source": "load", "row": "square-root", "dps": [0.1, 0.0, 0.0]}
    described = {
        **{"sensor": {"odr_hz": 10}, "bias": {}, "noise": {}, "session": [{"s": 20.0}]},
        **{
            "channels": {"load": {"kind": "square", "low": 4.0, "high": 9.0, "period_s": 30.0}},
            "effect": [wave],
        },
    }
    _, truth = simulated_device(described)
    bias = truth.bias_lsb[:, 0] / 131
    assert np.ptp(bias) == pytest.approx(0.1 * (3 - 2), rel=0.05)
