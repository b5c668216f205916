"""Times as tables have them: each is read, or the error has the words that mend it."""

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options

from .test_odd_files import read, table, told

RNG = np.random.default_rng(3)


def test_a_gap_of_five_minutes_does_not_change_the_rate(tmp_path):
    frame = table()
    frame.loc[1000:, "t_s"] += 300
    recording, report = read(tmp_path, frame)
    assert recording.scales.odr_hz == pytest.approx(100, rel=1e-4)
    assert told(report, "a gap of 5 min in the time stamps")


def test_rows_out_of_order_are_sorted_and_said(tmp_path):
    frame = table()
    shuffled = frame.iloc[np.argsort(np.arange(2000) + RNG.uniform(0, 4, 2000))]
    recording, report = read(tmp_path, shuffled)
    assert recording.columns["t_us"].tolist() == [i * 10_000 for i in range(2000)]
    assert told(report, "rows: sorted by time")


def test_the_second_half_of_a_log_before_the_first_is_sorted(tmp_path):
    frame = table()
    recording, _ = read(tmp_path, pd.concat([frame[1000:], frame[:1000]]))
    assert recording.columns["t_us"].tolist() == [i * 10_000 for i in range(2000)]


def test_two_power_ons_in_one_file_are_not_mixed(tmp_path):
    frame = table()
    with pytest.raises(BadRecording, match="row 2001: time begins anew; cut it there"):
        read(tmp_path, pd.concat([frame, frame]))


@pytest.mark.parametrize("back_s", [65.536, 3600])
def test_a_short_counter_that_ran_over_and_the_end_of_summer_time_are_no_disorder(tmp_path, back_s):
    frame = table()
    frame["t_s"] += 7200
    frame.loc[1000:, "t_s"] -= back_s
    with pytest.raises(BadRecording, match="row 1001: time begins anew; cut it there"):
        read(tmp_path, frame)


def test_a_row_that_is_written_twice_is_one_sample(tmp_path):
    frame = table()
    recording, report = read(tmp_path, frame.loc[np.repeat(np.arange(2000), 2)])
    assert recording.columns["t_us"].tolist() == [i * 10_000 for i in range(2000)]
    assert told(report, "dropped 2000 rows: the row before once more")


def test_times_of_which_most_are_no_numbers_are_refused(tmp_path):
    frame = table()
    frame["t_s"] = [f"{1000 * t:,.2f}" for t in frame["t_s"]]
    with pytest.raises(BadRecording, match=r"1900 of 2000 time stamps are no numbers; .*--hz"):
        read(tmp_path, frame)


def test_a_stamp_that_lost_or_won_a_digit_is_left_out(tmp_path):
    frame = table().rename(columns={"t_s": "t_us"})
    frame["t_us"] = 788_201_245 + 13_000 * np.arange(2000)
    frame.loc[500, "t_us"] = 79_470_245
    frame.loc[1500, "t_us"] = 8_077_012_459
    recording, report = read(tmp_path, frame)
    assert len(recording) == 1998 and np.diff(recording.columns["t_us"]).max() == 26_000
    assert told(report, "dropped 2 rows: the time stamp is torn")


@pytest.mark.parametrize("behind_s", [0.2, 5000])
def test_two_clocks_that_take_turns_are_two_devices(tmp_path, behind_s):
    frame = table()
    frame.loc[1::2, "t_s"] += behind_s
    with pytest.raises(BadRecording, match="2 devices take turns: time goes back .*file of its"):
        read(tmp_path, frame)


def test_a_counter_that_ran_over_goes_on(tmp_path):
    frame = table().rename(columns={"t_s": "t_us"})
    frame["t_us"] = (2**32 - 5_000_000 + np.arange(2000) * 10_000) % 2**32
    recording, report = read(tmp_path, frame)
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()
    assert told(report, "a clock of 32 bits ran over at row 501: counted on")


@pytest.mark.parametrize(
    "stamp",
    [
        "2026-05-01T12:00:{:06.3f}Z",
        "2026-05-01 12:00:{:06.3f}",
        "2026-05-01T14:00:{:06.3f}+02:00",
        "2026/05/01 12:00:{:06.3f}",
    ],
)
def test_dates_of_iso_8601_are_times(tmp_path, stamp):
    frame = table().rename(columns={"t_s": "time"})
    frame["time"] = [stamp.format(i / 100) for i in range(2000)]
    recording, _ = read(tmp_path, frame)
    assert recording.columns["t_us"][0] == 1_777_636_800_000_000
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()


def test_a_time_of_day_is_a_time_and_goes_on_at_midnight(tmp_path):
    frame = table(500).rename(columns={"t_s": "rtcTime"})
    stamps = pd.Timestamp("2021-03-05T23:59:57") + pd.to_timedelta(frame["rtcTime"], unit="s")
    frame["rtcTime"] = stamps.dt.strftime("%H:%M:%S.%f").str[:-4]
    recording, report = read(tmp_path, frame)
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()
    assert told(report, "a clock of 24 hours ran over at row 301: counted on")


@pytest.mark.parametrize("stamp", ["01.05.2026 11:59:{}", "5/1/2026, 11:59:{} AM"])
def test_a_day_in_any_order_may_stand_before_a_time_of_it(tmp_path, stamp):
    noon = stamp.replace("11:59", "12:00").replace("AM", "PM")
    seconds = [f"{i / 100:06.3f}" for i in range(5900, 6000)]
    times = [stamp.format(s) for s in seconds] + [noon.format(f"00.{i:02d}0") for i in range(100)]
    recording, _ = read(tmp_path, table(200).assign(t_s=times).rename(columns={"t_s": "time"}))
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()


def test_a_column_of_days_beside_one_of_times_is_no_time(tmp_path):
    frame = table(500).rename(columns={"t_s": "Time"})
    frame["Time"] = [f"12:00:{t:06.3f}" for t in frame["Time"]]
    for day in ("05/05/2021", "20210505"):
        recording, _ = read(tmp_path, frame.assign(Date=day)[["Date", *frame]])
        assert (np.diff(recording.columns["t_us"]) == 10_000).all()


@pytest.mark.parametrize("name, scale", [("Zeit (s)", 1), ("Temps (s)", 1), ("uptime_ms", 1000)])
def test_a_column_in_a_unit_of_time_that_only_grows_is_the_time(tmp_path, name, scale):
    frame = table(500).assign(t_s=lambda f: scale * f["t_s"]).rename(columns={"t_s": name})
    recording, _ = read(tmp_path, frame.assign(**{"delay (s)": 0.5})[["delay (s)", *frame]])
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()


def test_a_column_of_dates_is_the_time_whatever_it_is_called(tmp_path):
    frame = table(500).rename(columns={"t_s": "hhmmss.ms"})
    frame["hhmmss.ms"] = [f"12:00:{t:06.3f}" for t in frame["hhmmss.ms"]]
    recording, _ = read(tmp_path, frame)
    assert (np.diff(recording.columns["t_us"]) == 10_000).all()


def test_midnight_falls_between_rows_that_are_rare(tmp_path):
    stamps = pd.Timestamp("2021-03-05T23:50") + pd.to_timedelta(np.arange(100) * 15, unit="s")
    frame = table(100).assign(t_s=stamps.strftime("%H:%M:%S")).rename(columns={"t_s": "time"})
    recording, _ = read(tmp_path, frame)
    assert (np.diff(recording.columns["t_us"]) == 15_000_000).all()


def test_a_time_that_cannot_be_read_says_how_to_write_it(tmp_path):
    frame = table(500).rename(columns={"t_s": "time"})
    frame["time"] = [f"May 1st, at noon and {t:06.3f}" for t in frame["time"]]
    with pytest.raises(BadRecording, match="no time can be read from column 'time'; .*--hz N"):
        read(tmp_path, frame)


def test_rows_that_share_a_coarse_stamp_are_spread_over_it(tmp_path):
    frame = table()
    exact = frame["t_s"].to_numpy() + 3.47
    exact[1000:] += 300
    recording, report = read(tmp_path, frame.assign(t_s=np.floor(exact)))
    assert recording.scales.odr_hz == pytest.approx(100, rel=1e-3)
    assert recording.columns["t_us"] == pytest.approx(exact * 1e6, abs=1e6)
    assert np.diff(recording.columns["t_us"]).min() > 0
    assert recording.duration_s == pytest.approx(exact[-1] - exact[0], abs=0.6)
    assert told(report, "rows that share a time stamp of 1 s are spread over it, 100 each")


def test_rows_that_share_a_stamp_unevenly_are_refused(tmp_path):
    frame = table().assign(t_s=lambda f: np.floor(f["t_s"]))
    kept = RNG.random(2000) > 0.3
    with pytest.raises(BadRecording, match="share each time stamp of 1 s, .*write finer times"):
        read(tmp_path, frame[kept])


def test_rows_of_two_devices_in_turn_are_told_by_their_levels(tmp_path):
    frame = table()
    frame.loc[1::2, "gy_dps"] += 0.5
    with pytest.raises(BadRecording, match="2 devices take turns: the readings change"):
        read(tmp_path, frame)


@pytest.mark.parametrize("names", [["temp_c"], ["ax_g", "ay_g", "az_g"]])
def test_a_gap_of_a_slower_sensor_stays_a_gap(tmp_path, names):
    frame = table()
    frame.loc[800:1399, names] = np.nan
    recording, report = read(tmp_path, frame)
    assert len(recording) == 1400 and np.diff(recording.columns["t_us"]).max() == 6_010_000
    assert any("in a gap of the" in reason for reason in report.dropped)


def test_seconds_and_nanoseconds_are_added(tmp_path):
    frame = table()
    at_ns = 1_777_636_800_990_000_000 + np.arange(2000) * 10_000_000
    frame.insert(0, "header.stamp.sec", at_ns // 10**9)
    frame.insert(1, "header.stamp.nanosec", at_ns % 10**9)
    recording, _ = read(tmp_path, frame.drop(columns="t_s"))
    assert np.abs(recording.columns["t_us"] - at_ns // 1000).max() <= 1
    named = frame.drop(columns="t_s").set_axis(["A", "B", *frame.columns[3:]], axis=1)
    again, _ = read(tmp_path, named, mapping="t_us=A:s+B:ns")
    assert again.columns["t_us"].tolist() == recording.columns["t_us"].tolist()


def test_a_rate_overrides_a_time_column_and_says_so(tmp_path):
    frame = table(50).rename(columns={"t_s": "when"}).assign(timestamp="yesterday")
    recording, report = read(tmp_path, frame, options=Options(hz=4))
    assert recording.columns["t_us"][1] == 250_000
    assert told(report, "time column 'timestamp' left aside, as --hz is given")


def test_a_time_of_unknown_unit_is_taken_where_one_can_be_and_else_offered_with_its_rate(tmp_path):
    frame = table().rename(columns={"t_s": "time"})
    _, report = read(tmp_path, frame)
    assert told(report, "time taken in s: that is 100 Hz")
    with pytest.raises(BadRecording, match=r"give --time-unit s \(100 Hz\)"):
        read(tmp_path, frame.rename(columns={"time": "min.timestamp"}))
    with pytest.raises(BadRecording, match=r"give --time-unit s \(0.1 Hz\) or ms \(100 Hz\)"):
        read(tmp_path, frame.assign(time=frame["time"] * 1000))


def test_stamps_beyond_64_bits_are_refused_with_their_row(tmp_path):
    text = "t_us,gx_dps,gy_dps,gz_dps\n1,1,1,1\n18446744073709551615,1,1,1\n"
    with pytest.raises(BadRecording, match="row 2: the time stamp is .*name the unit"):
        read(tmp_path, text)


def test_temperature_once_a_second_is_interpolated_and_said(tmp_path):
    frame = table(2000, 200.0)
    exact = frame["temp_c"].copy()
    frame.loc[np.arange(2000) % 200 != 0, "temp_c"] = np.nan
    recording, report = read(tmp_path, frame)
    assert len(recording) == 2000
    assert recording.temp_degc()[:1800] == pytest.approx(exact[:1800], abs=0.006)
    assert told(report, "temperature interpolated between its readings, over at most 1 s")


def test_a_merged_time_line_keeps_every_rate(tmp_path):
    frame = table(2000, 200.0)
    rates = frame[["t_s", *(f"g{a}_dps" for a in "xyz")]]
    force = frame[["t_s", *(f"a{a}_g" for a in "xyz")]].assign(t_s=frame["t_s"] + 0.002)
    warm = frame.loc[::200, ["t_s", "temp_c"]].assign(t_s=frame["t_s"][::200] + 0.001)
    merged = pd.concat([rates, force, warm]).sort_values("t_s")
    recording, report = read(tmp_path, merged)
    assert len(recording) == 2000
    assert recording.scales.odr_hz == pytest.approx(200)
    assert recording.accel_g()[:, 2] == pytest.approx(1, abs=0.02)
    assert told(report, "acceleration interpolated between its readings, over at most 5 ms")


def test_acceleration_on_rows_of_its_own_chooses_its_range(tmp_path):
    frame = table()
    forces = [f"a{axis}_g" for axis in "xyz"]
    apart = frame[["t_s", *forces]].assign(az_g=1.0)
    apart.loc[apart.index[-len(apart) // 4 :], "az_g"] = 5.0
    apart["t_s"] += 0.003
    merged = pd.concat([frame.drop(columns=forces), apart]).sort_values("t_s")
    recording, report = read(tmp_path, merged)
    at_end = recording.accel_g()[-10:, 2]
    assert at_end == pytest.approx(np.full(10, 5.0), abs=0.001)
    assert told(report, "strongest acceleration: 5 g")


def test_a_column_can_be_left_out(tmp_path):
    frame = table().assign(temp_c="broken")
    recording, report = read(tmp_path, frame)
    assert not recording.has_temp
    assert told(report, "column 'temp_c' left out: no number is in it")
    recording, _ = read(tmp_path, table(), mapping="temp=none ax=none")
    assert not recording.has_temp and not recording.has_accel
