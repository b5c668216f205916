"""What the firmware's integers cannot hold is left out and said, and the rest is deployed."""

from dataclasses import replace

import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.verify.slots import deployable

from .power_ons import SCALES


@pytest.fixture
def analysis():
    device = simulate(13, [("thermal-hysteresis", 3.0), ("supply-voltage", 3.0)])
    return analyse(device.sessions)


def kinds(analysis):
    return [f.candidate.kind for f in analysis.selection.found]


def test_what_fits_stays_as_it_is(analysis):
    assert len(kinds(analysis)) == 2
    assert deployable(analysis, SCALES) is analysis


def test_an_effect_beyond_the_integers_is_left_out_and_said(analysis):
    [supply] = [f for f in analysis.selection.found if f.candidate.kind == "supply-voltage"]
    [term] = supply.candidate.terms
    supply.candidate = replace(supply.candidate, terms=(replace(term, lag_s=1e9, lag_mode="lag"),))
    left = deployable(analysis, SCALES)
    assert kinds(left) == ["thermal-hysteresis"]
    assert len(left.judgement.gains) == 1
    assert any(note.startswith("found but left out: ") for note in left.gate.notes)
