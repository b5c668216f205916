"""The benchmark's own arithmetic."""

import json

import numpy as np
import pytest
from zerorate_bench.loop.added_effects import PRANDTL_ISHLINSKII, PRANDTL_ISHLINSKII_TOLD
from zerorate_bench.loop.bin_tables import hipnuc
from zerorate_bench.loop.devices import CATALOGUE, MANY_WIDTHS, NULL, TOLD, Device, devices
from zerorate_bench.loop.figures import figures, share
from zerorate_bench.loop.run_trial import Outcome, run_trial
from zerorate_bench.loop.simulated import simulate
from zerorate_bench.loop.trials import looked_at, markdown, renewed

_AND_WITHDRAWN = "found, or found and withdrawn"


def test_a_device_is_looked_at_and_judged():
    outcome = run_trial(Device("5x", 1, (("thermal-lag", 5.0),)))
    assert outcome.named("thermal-lag") and outcome.tied_to(("temp",))
    assert outcome.after < 1.2 < outcome.before


def test_told_a_loop_an_offset_is_left_once_the_temperature_has_swept_it():
    kind = PRANDTL_ISHLINSKII_TOLD
    left, noise = (simulate(302_001, e, 2).sessions[-1].rate_dps for e in ([(kind, 5.0)], []))
    warm = slice(*(int(f * len(left)) for f in (0.6, 1.0)))
    assert np.ptp(left - noise, axis=0).min() > 1e-3
    assert np.ptp((left - noise)[warm], axis=0).max() < 1e-9


def test_who_is_told_a_loop_leaves_less_unless_its_start_misleads():
    seeds = range(302_000, 302_004)
    loop = ((PRANDTL_ISHLINSKII, 5.0),)
    told = [run_trial(Device(TOLD, seed, loop, sessions=3)) for seed in seeds]
    assert all(o.after <= o.before and o.after <= o.unpruned for o in told)
    assert np.mean([o.after for o in told]) < 0.8 * np.mean([o.before for o in told])


def test_figures_count_what_was_found_named_and_made_worse():
    effect = Device("2x", 1, (("vibration", 2.0),))
    outside = Device("outside", 1, (("load-kink", 2.0),))
    outcomes = [
        Outcome(Device("nothing", 1)),
        Outcome(Device("nothing", 2), ["time-drift"], [["time"]], [[]], ["tentative"], after=1.5),
        Outcome(effect, ["supply-voltage"], [["vdd_mv"]], [["vibration"]], ["confirmed"]),
        Outcome(effect),
        Outcome(outside, ["channel-kink(load)"], [["load"]], [[]], ["confirmed"]),
    ]
    by_name = {f.name: f for f in figures(outcomes)}
    assert (by_name["found in nothing"].value, by_name["found in nothing"].met) == (50.0, False)
    assert (by_name["2x vibration: found"].value, by_name["2x vibration: found"].met) == (50, False)
    assert by_name["2x, named rightly of those found"].met
    assert by_name["outside, 2x load-kink: tied to load"].value == 100.0
    assert by_name["held-out error made worse by more than 2 %"].value == 20.0


def test_what_was_found_and_withdrawn_is_counted_beside_what_was_kept():
    gone, kept = ({"withdrawn": ["thermal-hysteresis"]}, {"found": ["thermal-hysteresis"]})
    for row, name in ((f"{MANY_WIDTHS}, 2", "2x hysteresis of many widths"), (NULL, "nothing")):
        outcomes = [Outcome(Device(row, i), **some) for i, some in enumerate((gone, kept, {}, {}))]
        counted = [
            f.value for f in figures(outcomes) if _AND_WITHDRAWN in f.name and name in f.name
        ]
        assert counted and set(counted) == {50.0}


def test_every_size_counts_alike_in_what_is_left():
    outcomes = [Outcome(Device("2x", i, (("vibration", 2.0),)), after=1.0) for i in range(3)]
    outcomes.append(Outcome(Device("5x", 1, (("vibration", 5.0),)), after=2.0))
    by_name = {f.name: f for f in figures(outcomes)}
    for what in ("vibration", "all fourteen"):
        assert by_name[f"2x-5x {what}: error after, mean"].value == 1.5
    assert by_name["2x-5x vibration: error after, rms"].value == pytest.approx(2.5**0.5)


def test_a_share_of_none_of_two_hundred_may_still_be_two_percent():
    none = share("found", [None] * 200, bool, 0.5)
    assert none.low == 0.0 and none.high == pytest.approx(1.88, abs=0.01)


def test_the_whole_benchmark_has_the_numbers_asked_for():
    every = devices(200, 20, ["rest.npy"])
    rows = [d.row for d in every]
    assert rows.count("nothing") == 200 and rows.count("real noise") == 100
    assert sum(r.startswith("nothing, ") for r in rows) >= 300
    twice = {d.effects[0][0] for d in every if d.row == "2x"}
    assert set(CATALOGUE) < twice and len(CATALOGUE) == 14
    lags = [d.row for d in every if d.effects[:1] and d.effects[0][0] == "thermal-lag"]
    assert [lags.count(f"{size}x") for size in (2, 3, 5)] == [50, 20, 20]
    assert len({d.key for d in every}) == len(every)


def test_a_run_broken_off_is_taken_up_where_it_ended(tmp_path):
    kept = tmp_path / "outcomes.jsonl"
    every = [Device("nothing", seed) for seed in (1, 2, 3)]
    whole = list(looked_at(every, kept=kept))
    lines = kept.read_text().splitlines(keepends=True)
    kept.write_text("".join(lines[:2]))
    again = list(looked_at(every, kept=kept))
    assert [o.found for o in again] == [o.found for o in whole]
    assert kept.read_text().count("\n") == len(lines) == 3


def test_figures_are_readable_with_limit_and_verdict():
    rows = figures([Outcome(Device("nothing", 1), ["time-drift"]), Outcome(Device("nothing", 2))])
    result = {"devices": 2, "figures": [f.to_dict() for f in rows]}
    text = markdown(json.loads(json.dumps(result)))
    assert "| found in nothing, all kinds | 50.0 |" in text
    assert "| found in nothing | 50.0 | at most 0.5 | NO | 9.5-90.5 | 2 |" in text


def test_a_page_is_renewed_row_by_row():
    def rows(*names, found=()):
        made = figures([Outcome(Device(n, 1), list(found)) for n in names], whole=False)
        return [f.to_dict() for f in made if "all kinds" not in f.name]

    page = markdown({"devices": 2, "figures": rows("nothing")})
    page = renewed(page, rows("nothing", "real noise", found=["time-drift"]))
    assert "| found in nothing | 100.0 |" in page and page.count("| found in nothing |") == 1
    assert "| found in real noise | 100.0 | at most 2 | NO |" in page
    assert "Missed: found in nothing; found in real noise." in page


def test_a_curved_table_is_bent_and_a_straight_one_is_not(tmp_path):
    def written(bend):
        rows = [
            f"BIN_DATA: {i}, {t}, 5000, 0.1, 0.1, 9.8, "
            + ", ".join([f"{1e-5 * t + bend * t * t:.8f}"] * 3)
            for i, t in enumerate(range(0, 40, 2))
        ]
        path = tmp_path / f"unitB_{bend}.log"
        path.write_text("\n".join(rows), encoding="utf-8")
        return hipnuc(path)

    curved, straight = written(1e-6), written(0.0)
    assert curved["after_mdps"] < 0.1 * curved["before_mdps"]
    assert straight["before_mdps"] == pytest.approx(0.0, abs=0.01)
