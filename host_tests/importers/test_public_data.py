"""The real recordings, by what their authors' notes say of them."""

import numpy as np
import pandas as pd
import pytest
from zerorate_bench.public_data import recordings, told_of
from zerorate_tools.importers import import_recording, read_foreign
from zerorate_tools.recordings import read_recording
from zerorate_tools.recordings.checks import GAP


def test_every_real_recording_is_imported(real_data, tmp_path):
    found = [*recordings(real_data), *real_data.glob("chamber-loop/*")]
    assert len(found) == 20
    for number, source in enumerate(found):
        out = tmp_path / f"{number}.parquet"
        report = import_recording(source, out, **told_of(source))
        assert report.rows_written > 0.89 * report.rows_read
        assert report.doubts == []
        assert len(read_recording(out, keep_gaps=True)) == report.rows_written


def test_the_real_mpu6050_comes_back_to_integers(real_data):
    for source in real_data.glob("mpu6050-unmoved/*.csv.gz"):
        frame = pd.read_csv(source)
        frame = frame[frame["temp_C"] != 0]
        recording, _ = read_foreign(source, **told_of(source))
        printed = frame[["gx_dps", "gy_dps", "gz_dps"]].to_numpy()
        assert np.abs(recording.gyro_lsb() - printed * 131).max() < 0.001
        untold, _ = read_foreign(source)
        assert untold.columns["temp"].tolist() == recording.columns["temp"].tolist()
        assert 90 < recording.scales.odr_hz < 110


def test_a_trial_of_broad_keeps_movement_and_the_attitude_that_cameras_saw(real_data):
    source = next(real_data.glob("broad/02*.mat"))
    recording, _ = read_foreign(source, **told_of(source))
    assert set(recording.columns["moving"]) == {0, 1}
    optical = np.stack([recording.columns[f"opt_q{n}"] for n in "wxyz"], axis=1)
    seen = (optical != GAP).all(axis=1)
    assert seen.mean() > 0.8
    assert np.linalg.norm(optical[seen] * 2.0**-29, axis=1) == pytest.approx(1, abs=1e-6)
    assert recording.scales.more["channels"]["opt_qw"]["role"] == "reference"


def test_what_cannot_be_true_of_the_chamber_is_doubted_in_words(real_data):
    source = next(real_data.glob("chamber-loop/*"))
    units = {"gyro": "rad/s", "time": "ns"}
    _, report = read_foreign(source, units=units)
    assert len(report.doubts) == 1
    assert "89.7 degC within 4.24 s cannot be" in report.doubts[0]
    assert "give --hz" in report.doubts[0]
