"""The tables of `bench motion` say what each figure must be, and whether it is."""

import pytest
from zerorate_bench.motion_table import LIMITS_MDPS, in_markdown


@pytest.fixture
def found():
    """What the bench finds, every demand met."""

    def row(*errors, within=()):
        return {"rms_mdps": list(errors), "learned": 0, "wrong": 0, "within": list(within)}

    simulated = {
        name: {"in motion": row(25.0), "decision": row(5.0, 6.0, within=[0.9, 1.0])}
        for name in LIMITS_MDPS
    }
    settling = {"default": {"seconds": 40.0, "ripple_mdps": 9.0, "mean_mdps": 1.0}}
    cost = {name: {"cycles": 900.0, "cycles_worst": 9000.0} for name in ("in_motion", "gravity")}
    flicker = {"rests-30": {"firmware": [1.0, 0.96, 0.94, 0.93]}}
    return {"simulated": simulated, "flicker": flicker, "settling": settling, "cost": cost}


def verdicts(found):
    (line,) = (line for line in in_markdown(found).splitlines() if "is it?" in line)
    return [cell.strip() for cell in line.split("|")[2:-1]]


def refused(found):
    return [name for name, said in zip(LIMITS_MDPS, verdicts(found)) if said == "**no**"]


def test_every_demand_that_is_met_is_said_to_be(found):
    assert set(verdicts(found)) == {"yes"}


@pytest.mark.parametrize(
    ("scene", "way", "row", "met"),
    [
        ("trembling", "decision", {"rms_mdps": [5.0, 30.1]}, False),  # one seed is one too many
        ("never-rests", "decision", {"rms_mdps": [5.0, 14.9, 29.0]}, True),  # by the median
        ("never-rests", "decision", {"rms_mdps": [5.0, 15.1, 15.2]}, False),
        ("turntable", "in motion", {"wrong": 1}, False),
    ],
)
def test_a_demand_that_is_not_met_is_said(found, scene, way, row, met):
    found["simulated"][scene][way] |= row
    assert refused(found) == ([] if met else [scene])


def test_honesty_is_counted_in_percent_and_by_flicker_noise_too(found):
    assert "| rests-30, firmware | 100 % | 96 % | 94 % | 93 % |" in in_markdown(found)
    assert "| decision |" + " 95 % |" * len(LIMITS_MDPS) in in_markdown(found)


def test_the_decision_is_judged_beside_vqf_on_whole_trials(found):
    def rows(error):
        return {"trial": {"rms_mdps": [error] * 3}}

    ways = {"vqf": rows(11.0), "decision": rows(3.0)}
    found["broad"] = {"whole": ways, "motion": ways, "trials": {}}
    assert "at or below vqf on the whole trial: yes" in in_markdown(found)
    ways["decision"] = rows(12.0)
    assert "at or below vqf on the whole trial: **no**" in in_markdown(found)
