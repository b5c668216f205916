"""The benchmark's own arithmetic."""

import json

import pytest
from zerorate_tools.bench.loop import Device, Outcome, devices, look, markdown, tables
from zerorate_tools.bench.loop_real import hipnuc


def test_a_device_is_looked_at_and_judged():
    outcome = look(Device("5x", 1, (("thermal-lag", 5.0),)))
    assert outcome.named("thermal-lag") and outcome.tied_to(("temp",))
    assert outcome.after < 1.2 < outcome.before


def test_tables_count_what_was_found_named_and_made_worse():
    effect = Device("2x", 1, (("vibration", 2.0),))
    outside = Device("outside", 1, (("load-kink", 2.0),))
    outcomes = [
        Outcome(Device("null", 1)),
        Outcome(Device("null", 2), ["time-drift"], [["time"]], [[]], ["tentative"], after=1.5),
        Outcome(effect, ["supply-voltage"], [["vdd_mv"]], [["vibration"]], ["confirmed"]),
        Outcome(effect),
        Outcome(outside, ["channel-kink(load)"], [["load"]], [[]], ["confirmed"]),
    ]
    result = json.loads(json.dumps(tables(outcomes)))
    assert result["false_alarms"]["null"]["found_percent"] == 50.0
    assert result["false_alarms"]["null"]["confirmed_percent"] == 0.0
    assert result["effects"]["2x"]["vibration"]["found_percent"] == 50.0
    assert result["effects"]["2x"]["vibration"]["named_percent"] == 100.0
    assert result["outside"]["load-kink"]["tied_to_right_channel_percent"] == 100.0
    assert result["made_worse_percent"] == 20.0
    assert "load-kink" in markdown(result)


def test_the_whole_benchmark_has_the_numbers_asked_for():
    every = devices(200, 20, ["rest.npy"])
    rows = [d.row for d in every]
    assert rows.count("null") == 200 and rows.count("real noise") == 200
    assert sum(r.startswith("null, ") for r in rows) >= 200
    assert len({d.effects[0][0] for d in every if d.row == "2x"}) == 16
    assert len({(d.row, d.seed, d.effects) for d in every}) == len(every)


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
