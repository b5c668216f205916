"""Recordings from which little can be learned end in a sentence that helps; nothing is invented."""

import json
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from zerorate_tools.closing import close, load
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.recordings import Recording

from .power_ons import MPU, at_rest, written

N = 6000


def invented(analysis):
    return [f.candidate.kind for f in analysis.selection.found] + analysis.lines


def wander(seed, n=N):
    return np.cumsum(np.random.default_rng(seed + 50).normal(0, 3, n)).astype(np.int32)


def test_an_extra_channel_with_gaps_is_bridged(tmp_path):
    paths = []
    for i in range(4):
        one = {**at_rest(i), "hum": wander(i).astype(object)}
        one["hum"][1000:2500] = one["hum"][::7] = ""
        paths.append(tmp_path / f"s{i}.csv")
        rows = zip(*one.values())
        text = "\n".join([",".join(one), *(",".join(map(str, row)) for row in rows)])
        paths[-1].write_text(text + "\n")
        paths[-1].with_suffix(".json").write_text(json.dumps(MPU.to_json()))
    analysis = load(paths)
    assert np.isfinite(analysis.sessions[0].sources["hum"]).all() and invented(analysis) == []


@pytest.mark.parametrize(
    ("readings", "sentence"),
    [
        (32767, "100 % of its samples are clipped; .* choose a wider range"),
        ("held", "100 % of its samples are repeated; the rates never change"),
    ],
)
def test_a_sensor_that_reads_nothing_is_told_what_it_needs(closing, readings, sentence):
    one = at_rest(1)
    for name in one:
        if name != "t_us":
            one[name] = np.full(N, 7 if readings == "held" else readings, np.int32)
    if readings != "held":
        one["az"] = at_rest(1)["az"]
    with pytest.raises(CannotClose, match=sentence):
        closing([one])


def test_beside_an_hour_a_short_one_is_told_why_it_needs_more_than_alone(closing):
    analysis = closing([*(at_rest(i, 60 * 60 * 5) for i in range(2)), at_rest(4, 1400)])
    (note,) = analysis.gate.notes
    assert "s2: 4.6 minutes are too short; 5 minutes at rest are needed (15 blocks of 20 s" in note


def test_motion_without_acceleration_is_told_what_would_tell_of_it(tmp_path):
    one = {name: values for name, values in at_rest(0).items() if name not in ("ax", "ay", "az")}
    one["gz"] = np.rint(131 * 60 * np.sin(np.arange(N) / 2)).astype(np.int32)
    logs = written(tmp_path, [Recording(one, replace(MPU, accel_lsb_per_g=None), "s0")])
    with pytest.raises(CannotClose, match="untouched for longer; or record acceleration"):
        close(logs, tmp_path / "closed")


def test_of_many_short_recordings_three_are_named(closing):
    with pytest.raises(CannotClose, match=r"^s0: [^;]*; 2 [^;]*; s1: .*; s2: .*; 2 more rest too"):
        closing([at_rest(i, 300) for i in range(5)])


def test_recordings_all_in_motion_are_told_to_rest(closing):
    every = [at_rest(i) for i in range(2)]
    for i, one in enumerate(every):
        one["gz"] = np.rint(131 * 60 * np.sin(np.arange(N) / (2 + i))).astype(np.int32)
    with pytest.raises(CannotClose, match="s1: only 0.0 minutes are still; .* untouched"):
        closing(every)


def test_whole_numbers_with_gaps_that_a_table_made_floats_are_integers_with_gaps(tmp_path):
    paths = []
    for i in range(3):
        vdd_mv = np.where(np.arange(N) % 5, np.nan, 3300.0 + wander(i))
        table = pa.table({**at_rest(i), "vdd_mv": vdd_mv})
        paths.append(tmp_path / f"s{i}.parquet")
        metadata = {"zerorate": json.dumps(MPU.to_json())}
        parquet.write_table(table.replace_schema_metadata(metadata), paths[-1])
    held = load(paths).sessions[0].sources["vdd_mv"]
    assert np.isfinite(held).all() and np.ptp(held) > 0


@pytest.mark.parametrize("lacking", [("temp",), ("temp", "ax", "ay", "az")])
def test_without_temperature_or_acceleration_the_rest_is_still_looked_at(closing, lacking):
    every = [{k: v for k, v in at_rest(i).items() if k not in lacking} for i in range(4)]
    analysis = closing(every)
    assert invented(analysis) == [] and np.isfinite(analysis.judgement.after_dps).all()


def test_a_channel_of_any_name_leaves_the_rates_alone(closing):
    every = [at_rest(i) for i in range(3)]
    for one in every:
        one |= {n: np.arange(N) * 1000 for n in ("count", "known", "vib", "gyro0")}
    analysis, plain = closing(every), closing([at_rest(i) for i in range(3)])
    rate, expected = (a.sessions[0].rate_dps for a in (analysis, plain))
    assert rate == pytest.approx(expected, nan_ok=True)
    assert invented(analysis) == [] and "rename" in analysis.gate.dropped["vib"]


def test_a_temperature_at_the_rails_is_no_temperature(closing):
    every = [at_rest(i) for i in range(3)]
    for i, one in enumerate(every):
        one["temp"][np.random.default_rng(i).integers(0, N, N // 50)] = -32768
    analysis = closing(every)
    assert invented(analysis) == []
    assert all(np.ptp(s.sources["temp"]) < 20 for s in analysis.sessions)


def test_an_accelerometer_that_gives_nothing_is_none(closing):
    every = [
        {**at_rest(i), "ax": np.zeros(N), "ay": np.zeros(N), "az": np.zeros(N)} for i in range(3)
    ]
    assert invented(closing(every)) == []


def test_rows_of_fifteen_seconds_lie_alike_in_every_power_on(closing):
    slow = [{**at_rest(i, 480), "t_us": 15_000_000 * np.arange(480)} for i in range(3)]
    sessions = closing(slow, *(replace(MPU, odr_hz=hz) for hz in (1 / 15, 0.0667, 0.066))).sessions
    assert len({(s.block_s, s.ticks_per_block) for s in sessions}) == 1
