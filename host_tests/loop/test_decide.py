"""The locks that an effect must open."""

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.search.decide import effective, predicts
from zerorate_tools.loop.search.select import Search


@pytest.mark.parametrize(
    ("nats", "speaks"),
    [
        ([5.0, 4.0, 2.0], True),
        ([60.0, 60.0, -1.5], True),
        ([60.0, 60.0, -4.0], False),
        ([5.0, 3.5, -0.5], False),
        ([60.0, -1.0, -1.0], False),
        ([1.0, 0.5, 0.5], False),
        ([9.0, -1.0], False),
        ([9.0], True),
    ],
)
def test_sessions_left_out_must_speak_for_it_and_none_clearly_against(nats, speaks):
    assert predicts(np.array(nats)) is speaks


def test_columns_that_are_alike_are_paid_for_once():
    rng = np.random.default_rng(1)
    one = rng.normal(size=(500, 1))
    alike = np.hstack([one + 0.01 * rng.normal(size=(500, 1)) for _ in range(6)])
    assert effective(alike) < 1.6
    assert effective(rng.normal(size=(500, 6))) > 5.5


def test_the_shares_of_a_family_add_up_to_its_level():
    search = Search(simulate(1).sessions[:-1])
    for family in ("catalogue", "generic"):
        kinds = {c.kind: c for c in search.pool if c.family == family}
        shares = [search.testing.grid(kind) / search.testing.tried(c) for kind, c in kinds.items()]
        assert sum(shares) == pytest.approx(1.0)
