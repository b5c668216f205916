"""Rows on lines between readings: those of a resampled log are refused, and no readings are."""

import numpy as np
import pandas as pd
import pytest
from zerorate_bench.resampled import KINDS, digits, drawn, on_lines, timed
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers.samples.resampled import base_period

from .test_odd_files import read, table


def resampled(frame, hz):
    """The same on an even grid of another rate, on lines between the readings."""
    at = np.arange(frame.t_s.iloc[0], frame.t_s.iloc[-1], 1 / hz)
    return pd.DataFrame({n: np.interp(at, frame.t_s, frame[n]) for n in frame}).assign(t_s=at)


@pytest.mark.parametrize("hz", [200, 400])
def test_rows_between_readings_are_none(tmp_path, hz):
    frame = table()
    recording, report = read(tmp_path, resampled(frame, hz).round(6))
    assert recording.scales.odr_hz == pytest.approx(100)
    assert recording.gyro_dps().std(axis=0) == pytest.approx(frame.std()[1:4], rel=0.01)
    assert sum(report.dropped.values()) == report.rows_read - len(frame)


def test_a_quiet_rest_of_few_digits_has_no_rows_between_readings(tmp_path):
    frame, luck = table(), np.random.default_rng(5)
    moves = np.arange(len(frame)) < 500
    for name in frame.columns[1:4]:
        frame[name] = 0.1 * np.round(luck.normal(0, np.where(moves, 200.0, 0.3)))
    _, report = read(tmp_path, frame)
    assert "on a straight line" not in " ".join(report.dropped)


@pytest.mark.parametrize("hz", [115, 160, 203, 333])
def test_a_log_that_was_resampled_is_refused(tmp_path, hz):
    with pytest.raises(BadRecording, match="of a resampled log; import the log as the sensor"):
        read(tmp_path, resampled(table(), hz))


@pytest.mark.parametrize("hz", [130, 333])
def test_one_of_few_digits_is_refused_too(tmp_path, hz):
    with pytest.raises(BadRecording, match="of a resampled log"):
        read(tmp_path, resampled(table(), hz).round(2))


@pytest.mark.parametrize("kind", KINDS)
def test_noise_of_any_kind_is_not_refused_and_its_lines_are(kind):
    luck = np.random.default_rng(3)
    for _ in range(3):
        rates = drawn(kind, luck)
        assert base_period(timed(rates), digits(kind)) == 0
        if kind not in ("coarse", "smooth motion", "with spikes"):
            period = base_period(timed(on_lines(rates, 1.3)), digits(kind))
            assert period == pytest.approx(1.3, abs=0.02)
