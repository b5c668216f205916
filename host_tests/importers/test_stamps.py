"""Stamps of the arrival are spread evenly again, and rows on lines between readings are none."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers.samples.clock import evened
from zerorate_tools.importers.samples.lines import _Seen
from zerorate_tools.importers.samples.spool import Spool

from .test_tables import HEAD, read, table, told

SAMPLES = 3000
TAKEN_S = np.arange(SAMPLES) / 100


def arrivals_s(every_s):
    """When samples arrive that are handed over together, a millisecond apart."""
    batch = np.floor(TAKEN_S / every_s)
    in_batch = np.arange(SAMPLES) - np.searchsorted(batch, batch)
    return (batch + 1) * every_s + 1e-3 * in_batch


def swung(at_s, turned_at_s):
    """A log of a device that swings, stamped at_s, with the rates of turned_at_s."""
    noise = np.random.default_rng(1).normal(size=(SAMPLES, 3)) * 0.1
    swing = 80 * np.sin(2 * np.pi * 0.7 * turned_at_s[:, None] + [0.0, 1.0, 2.0])
    return pd.DataFrame(np.column_stack([at_s, swing + noise]), columns=HEAD.split(","))


def test_samples_that_arrive_in_bursts_are_spread_evenly(tmp_path):
    recording, report = read(tmp_path, swung(arrivals_s(0.25), TAKEN_S))
    assert np.diff(recording.columns["t_us"])[50:-50] == pytest.approx(1e4, rel=0.02)
    assert told(report, "in bursts")


@pytest.mark.parametrize("every_s", [0.12, 0.25, 0.5])
def test_a_logger_that_pauses_or_noise_alone_keeps_its_stamps(tmp_path, every_s):
    at_s = arrivals_s(every_s)
    for turned_at_s in (at_s, np.zeros(SAMPLES)):
        recording, _ = read(tmp_path, swung(at_s, turned_at_s))
        assert np.diff(recording.columns["t_us"]).max() > 0.8e6 * every_s


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 60), st.integers(500, SAMPLES))
def test_evened_stamps_never_go_back_and_follow_lost_samples(seed, longest, piece):
    rng = np.random.default_rng(seed)
    taken_us = 1e6 * TAKEN_S
    taken_us[SAMPLES // 2 - 5 :] += 1e6  # a second of samples was lost
    at_us = taken_us.copy()
    for start in range(0, SAMPLES - 75, 75):  # a burst, and samples on time before and after it
        last = start + rng.integers(1, longest + 1)
        at_us[start:last] = taken_us[last]
    spool = Spool(["t_us"])
    for first in range(0, SAMPLES, piece):
        spool.append({"t_us": at_us[first : first + piece]})
    spool.finish()
    found = np.concatenate([columns["t_us"] for columns in evened(spool, 1e4)])
    assert (np.diff(found) >= 0).all()
    assert np.abs(found - taken_us).max() < 1.0


def resampled(frame, hz):
    """The same on an even grid of another rate, on lines between the readings."""
    at = np.arange(frame.t_s.iloc[0], frame.t_s.iloc[-1], 1 / hz)
    return pd.DataFrame({n: np.interp(at, frame.t_s, frame[n]) for n in frame}).assign(t_s=at)


def test_rows_between_readings_are_none(tmp_path):
    frame = table()
    recording, report = read(tmp_path, resampled(frame, 200).round(6))
    assert recording.scales.odr_hz == pytest.approx(100)
    assert recording.gyro_dps().std(axis=0) == pytest.approx(frame.std()[1:4], rel=0.01)
    assert sum(report.dropped.values()) == report.rows_read - len(frame)


def test_a_quiet_rest_of_few_digits_has_no_rows_between_readings(tmp_path):
    frame, luck = table(), np.random.default_rng(5)
    moves = np.arange(len(frame)) < 500
    for name in frame.columns[1:4]:
        frame[name] = 0.1 * np.round(luck.normal(0, np.where(moves, 200.0, 0.3)))
    _, report = read(tmp_path, frame)
    assert not told(report, "on a straight line")


@pytest.mark.parametrize(("hz", "printed"), [(220, 9), (333, 3), (350, 9), (410, 9)])
def test_a_log_that_was_resampled_is_refused(tmp_path, hz, printed):
    with pytest.raises(BadRecording, match="of a resampled log; import the log as the sensor"):
        read(tmp_path, resampled(table(), hz).round(printed))


@pytest.mark.parametrize(
    ("on", "longest", "near", "off", "are"),
    [
        *((1, 4, 0, 99, False), (2, 1, 0, 99, True), (1, 5, 0, 99, True)),
        *((50, 9, 4, 100, True), (50, 9, 5, 100, False)),
    ],
)
def test_lines_are_clear_and_more_than_chance_gives(on, longest, near, off, are):
    assert _Seen(100, on, on, near, off, longest).are_lines is are
