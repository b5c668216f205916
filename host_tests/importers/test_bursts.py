"""Time stamps of the arrival at a host: evenly taken samples are spread evenly again."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.samples.bursts import evened
from zerorate_tools.importers.samples.spool import Spool

HZ = 100.0
SAMPLES = 3000


def arrivals_s(taken_s, every_s):
    """When samples arrive that are handed over together, a millisecond apart."""
    batch = np.floor(taken_s / every_s)
    in_batch = np.arange(len(batch)) - np.searchsorted(batch, batch)
    return (batch + 1) * every_s + 1e-3 * in_batch


def log(folder, at_s, turned_at_s):
    """A log of a device that swings, stamped at_s, with the rates of turned_at_s."""
    noise = np.random.default_rng(1).normal(size=(len(at_s), 3)) * 0.1
    swing = 80 * np.sin(2 * np.pi * 0.7 * turned_at_s[:, None] + [0.0, 1.0, 2.0])
    frame = pd.DataFrame(swing + noise, columns=["gx_dps", "gy_dps", "gz_dps"])
    frame.insert(0, "time_s", at_s)
    frame.to_csv(folder / "in.csv", index=False)
    return folder / "in.csv"


def test_samples_that_arrive_in_bursts_are_spread_evenly(tmp_path):
    taken_s = np.arange(SAMPLES) / HZ
    recording, report = read_foreign(log(tmp_path, arrivals_s(taken_s, 0.25), taken_s))
    steps_us = np.diff(recording.columns["t_us"])[50:-50]
    assert steps_us == pytest.approx(1e6 / HZ, rel=0.02)
    assert any("in bursts" in line for line in report.lines())


def test_a_logger_that_really_pauses_keeps_its_stamps(tmp_path):
    at_s = arrivals_s(np.arange(SAMPLES) / HZ, 0.25)
    recording, _ = read_foreign(log(tmp_path, at_s, at_s))
    assert np.diff(recording.columns["t_us"]).max() > 200_000


@pytest.mark.parametrize("every_s", [0.12, 0.2, 0.25, 0.3, 0.5])
def test_noise_alone_does_not_tell_and_the_stamps_stay(tmp_path, every_s):
    at_s = arrivals_s(np.arange(SAMPLES) / HZ, every_s)
    recording, _ = read_foreign(log(tmp_path, at_s, np.zeros(SAMPLES)))
    assert np.diff(recording.columns["t_us"]).max() > 0.8e6 * every_s


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 60), st.integers(500, SAMPLES))
def test_evened_stamps_never_go_back_and_follow_lost_samples(seed, longest, piece):
    rng = np.random.default_rng(seed)
    taken_us = 1e4 * np.arange(SAMPLES)
    taken_us[SAMPLES // 2 - 5 :] += 1e6  # a second of samples was lost
    at_us = taken_us.copy()
    for start in range(0, SAMPLES - 75, 75):  # a burst, and samples on time before and after it
        last = start + rng.integers(1, longest + 1)
        at_us[start:last] = taken_us[last]
    spool = Spool(["t_us"])
    for first in range(0, SAMPLES, piece):
        spool.append({"t_us": at_us[first : first + piece]})
    spool.finish()
    found = np.concatenate([columns["t_us"] for columns in evened(spool, 1e4, None)])
    assert (np.diff(found) >= 0).all()
    assert np.abs(found - taken_us).max() < 1.0
