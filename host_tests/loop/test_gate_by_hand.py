"""What the gate lets through, at the edges of what it asks for."""

from types import SimpleNamespace

import numpy as np
import pytest
from zerorate.settings import DEFAULTS
from zerorate_tools.loop.read.gate import (
    CannotClose,
    GateReport,
    enough,
    readable,
    same_settings,
    shaken,
    usable_channels,
    without_long_gaps,
)
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.recordings import Scales


def session(blocks, block_s=10.0, still=None, **sources):
    """Of two ticks a block, with rates at rest in the first blocks."""
    rates = np.where(np.arange(blocks)[:, None] < (blocks if still is None else still), 0.1, np.nan)
    return Session("run", block_s, 2, rates * np.ones(3), np.ones(blocks), sources)


def refused(check, *of):
    """The text of a refusal, or "" where there is none."""
    try:
        check(*of)
    except CannotClose as error:
        return str(error)
    return ""


@pytest.mark.parametrize(
    "block_s, least, needed", [(4.0, 30, "2 min"), (8.0, 15, "2 min"), (20.0, 15, "5 min")]
)
def test_fifteen_blocks_and_two_minutes_at_rest_are_enough(block_s, least, needed):
    assert not refused(enough, session(least, block_s))
    assert not refused(enough, session(2 * least, block_s, still=least))
    for too_little in session(least - 1, block_s), session(2 * least, block_s, still=least - 1):
        have = f"{np.floor((least - 1) * block_s / 6) / 10:.1f} min"
        text = refused(enough, too_little)
        assert have in text and needed in text and f"{block_s:g} s" in text


@pytest.mark.parametrize("faulty, told", [(500, ""), (501, "50 %"), (750, "75 %")])
def test_a_recording_is_read_up_to_half_of_it_faulty(faulty, told):
    text = refused(
        readable, [SimpleNamespace(name="run", samples=1000, faults={"clipped": faulty})]
    )
    assert bool(text) == bool(told) and told in text


@pytest.mark.parametrize(
    "tick_s, gap, told",
    [(1.0, 600, ""), (1.0, 780, "13.0 min of its 20.0 min"), (20.0, 720, "4.0 h of its 6.7 h")],
)
def test_a_gap_of_more_than_half_of_a_recording_is_refused(tick_s, gap, told):
    count = np.ones(1200, int)
    count[100 : 100 + gap - 1] = 0
    text = refused(without_long_gaps, [SimpleNamespace(name="run", count=count, tick_s=tick_s)])
    assert bool(text) == bool(told) and told in text


@pytest.mark.parametrize(
    "change, alike",
    [
        ({}, True),
        ({"odr_hz": 95.0}, True),
        ({"odr_hz": 105.2}, True),
        ({"odr_hz": 94.9}, False),
        ({"odr_hz": 105.3}, False),
        ({"sensor": "other"}, False),
        ({"gyro_lsb_per_dps": 65.5}, False),
        ({"temp_offset_degc": 36.0}, False),
    ],
)
def test_two_recordings_are_of_one_setting_whose_clocks_are_within_five_percent(change, alike):
    kept = {"sensor": "MPU-6050", "odr_hz": 100.0, "gyro_lsb_per_dps": 131.0}
    kept |= {"accel_lsb_per_g": None, "temp_lsb_per_degc": 340.0, "temp_offset_degc": 36.53}
    two = [
        SimpleNamespace(name=name, scales=Scales(**{**kept, **other}), digest=name)
        for name, other in (("a", {}), ("b", change))
    ]
    assert bool(refused(same_settings, two)) != alike
    two[1].digest = "a"
    assert refused(same_settings, two)


@pytest.mark.parametrize(
    ("one", "other", "more", "said"),
    [
        *(
            ("unknown", "BMI160", {}, "--sensor BMI160"),
            ("BMI160", "unknown", {}, "--sensor BMI160"),
        ),
        ("BMI160", "ICM-20948", {}, None),
        ("BMI160", "BMI160", {"gyro_lsb_per_dps": 65.5}, "--gyro-lsb-per-dps 65.5"),
        ("unknown", "unknown", {"odr_hz": 121.0}, "--hz 110"),
        ("unknown", "unknown", {"odr_hz": 200.0}, None),
        ("X", "X", {"more": {"binding": {"chip_id": 2}}}, "its chip_id is 2, but 1 in a"),
    ],
)
def test_what_differs_by_its_import_alone_is_said_how_to_import(one, other, more, said):
    kept = {
        "odr_hz": 100.0,
        "gyro_lsb_per_dps": 131.0,
        "more": {"binding": {"chip_id": 1, "filter": 3}},
    }
    kept |= {"accel_lsb_per_g": None, "temp_lsb_per_degc": 340.0, "temp_offset_degc": 36.53}
    every = [Scales(**{**kept, "sensor": one}), Scales(**{**kept, "sensor": other, **more})]
    two = [SimpleNamespace(name=n, scales=of, digest=n) for n, of in zip("ab", every)]
    text = refused(same_settings, two)
    assert text and (said in text if said else "--" not in text)


def test_two_recordings_of_one_name_are_refused():
    scales = Scales("X", 100.0, 131.0, None, 340.0, 36.53)
    one, other = (SimpleNamespace(name="imu", scales=scales, digest=d) for d in "ab")
    assert "two recordings are named imu" in refused(same_settings, [one, other])


@pytest.mark.parametrize("over, told", [(3, ""), (4, "40 %")])
def test_shaking_in_more_than_three_tenths_of_the_rests_is_told_with_its_share(over, told):
    report, limit = GateReport(), DEFAULTS["still_g"] ** 2
    vib = np.repeat(np.where(np.arange(10) < over, 1.01, 0.99) * limit, 2)
    shaken([session(10), session(10, vib=vib)], report)
    assert len(report.notes) == bool(told) and told in "".join(report.notes)
    shaken([session(10)], quiet := GateReport())
    assert quiet.notes == []


def test_channels_that_show_nothing_of_their_own_are_left_out():
    rng = np.random.default_rng(3)
    one, two = rng.normal(size=(2, 80))
    there = {"fan": one, "held": np.ones(80), "twice": 5 - 2 * one, "near": one + 0.1 * two}
    there |= {"other": two, "lost": np.full(80, np.nan)}
    there |= {
        "uptime": 7.0 - 3.0 * np.arange(80),
        "acc_x": np.zeros(80),
        "acc_y": one,
        "rate_x": one + 1,
    }
    sessions, report = [session(40, **there), session(40, **there, alone=two)], GateReport()
    usable_channels(sessions, report)
    gone = {"held", "twice", "lost", "uptime", "alone", "acc_y", "rate_x"}
    assert set(report.dropped) == gone and report.dropped["alone"] == "not in run"
    for s in sessions:
        assert list(s.sources) == ["fan", "near", "other", "acc_x"]


@pytest.mark.parametrize(
    "noise, changes, kept", [(0.02, 80, False), (3.0, 80, True), (0.02, 38, True)]
)
def test_a_channel_with_the_rates_own_noise_is_no_cause(noise, changes, kept):
    """It changes at more than half of the ticks."""
    rng = np.random.default_rng(4)
    of = session(40, fan=np.zeros(80))
    of.ticks_dps = rng.normal(size=(80, 3))
    of.ticks_dps[10:20] = np.nan
    of.sources["fan"] = np.nan_to_num(-of.ticks_dps[:, 1]) + noise * rng.normal(size=80)
    of.sources["fan"][changes:] = 0.0
    ramp = session(40, fan=np.arange(80.0) ** 2)
    ramp.ticks_dps = of.ticks_dps
    usable_channels([of], GateReport())
    usable_channels([ramp], GateReport())
    assert ("fan" in of.sources) == kept and "fan" in ramp.sources
