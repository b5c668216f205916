"""The benchmark's own arithmetic."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from zerorate_bench.loop import variants
from zerorate_bench.loop.added_effects import PRANDTL_ISHLINSKII, PRANDTL_ISHLINSKII_TOLD
from zerorate_bench.loop.devices import (
    CATALOGUE,
    KINDS,
    MANY_WIDTHS,
    NULL,
    TOLD,
    Device,
    describe,
    devices,
)
from zerorate_bench.loop.figures import figures, share
from zerorate_bench.loop.real import hipnuc
from zerorate_bench.loop.run_trial import Outcome, run_trial
from zerorate_bench.loop.simulated import simulate
from zerorate_bench.loop.singles import (
    Single,
    _about,
    look_at_singles,
    single_figures,
    tellable,
)
from zerorate_bench.loop.trials import looked_at, markdown, renewed
from zerorate_tools.loop.search.steps import Step
from zerorate_tools.recordings import Recording, Scales

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


def _recording(samples=1000):
    at = np.arange(samples, dtype=np.int64) * 10_000
    axes = ("gx", "gy", "gz", "ax", "ay", "az")
    columns = {"t_us": at, **{n: np.zeros(samples, np.int32) for n in axes}}
    return Recording(columns, Scales("MPU-6050", 100.0, 131.0, 16384.0))


def test_halves_are_all_of_a_recording_once():
    halves = variants.VARIANTS["two halves, as two recordings"](_recording())
    assert np.array_equal(
        np.concatenate([h.columns["t_us"] for h in halves]), _recording().columns["t_us"]
    )


def test_a_step_put_in_has_its_size_on_every_axis():
    stepped = variants._with_step(_recording(100_000), 0.05)
    change = [np.diff([np.split(stepped.columns[g], [60_000])[i].mean() for i in (0, 1)])[0]
              for g in ("gx", "gy", "gz")]  # fmt: skip
    assert np.allclose(np.array(change) / 131.0, 0.05 * np.array([1.0, -0.7, 0.5]), atol=1e-4)


def test_a_step_counts_as_listed_near_its_place_alone():
    recording = _recording()
    assert variants._is_listed([{"t_us": 6_050_000}], recording)
    assert not variants._is_listed([{"t_us": 8_000_000}], recording)


def test_the_page_counts_what_is_worse_and_names_it_on_the_other_half():
    row = {"recording": "a.csv", "variant": variants.FIRST, "found": "thermal-lag"}
    rows = [
        {**row, "before_mdps": 10.0, "after_mdps": 10.5}
        | {"other_before_mdps": 10.0, "other_after_mdps": 12.0},
        {**row, "recording": "b.csv", "refused": "too short"},
    ]
    said = variants.in_words(rows)
    assert "| its first half | 1 | 1 | 1 | 1 | 1.05 |" in said
    assert "By its first half alone, worse on the second of 1: a.csv." in said


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
    kept.write_text(
        "".join(json.dumps([str(s.seed), asdict(s)]) + "\n" for s in known), encoding="utf-8"
    )
    assert [s.seed for s in look_at_singles(2, resume=kept)] == [0, 1]
