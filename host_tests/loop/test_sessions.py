"""Blocks of a session: cause and effect are of one time."""

import numpy as np
from zerorate_tools.loop.read.sessions import Session


def session(weight):
    return Session("s", 4.0, 4, np.zeros((2, 3)), np.ones(2), tick_weight=weight)


def test_a_source_is_averaged_over_the_ticks_that_the_rate_is():
    shaken = np.array([1.0, 1, 9, 9, 2, 2, 2, 6])
    still = np.array([25.0, 25, 0, 0, 25, 25, 25, 25])
    assert session(still).block_mean(shaken).tolist() == [1.0, 3.0]


def test_a_block_without_a_rate_has_the_mean_of_all_its_ticks():
    values = np.array([1.0, 1, 9, 9, 2, 2, 2, 6])
    assert session(np.zeros(8)).block_mean(values).tolist() == [5.0, 3.0]
    assert session(None).block_mean(values).tolist() == [5.0, 3.0]
