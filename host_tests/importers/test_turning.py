"""The unit of rates by gravity, which they turn: in a hand it is told, at rest it is not."""

import re
from functools import partial

import numpy as np
import pandas as pd
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from zerorate_tools.closing import close
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options, import_recording
from zerorate_tools.importers.columns.mapping import parsed_mapping
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.recordings import turning
from zerorate_tools.recordings.turning import axes_of, axes_words, dps_of_one
from zerorate_tools.simulate.attitude import IDENTITY, integrate, into_body

from .test_tables import read

#: What fails is told as it is found: to look for less of it takes minutes.
QUICK = (Phase.explicit, Phase.generate)
SIGNS = st.tuples(*[st.sampled_from([-1, 1])] * 3)
UNITS_DPS = {"dps": 1.0, "mdps": 1e-3, "rad/s": 180 / np.pi, "mrad/s": 0.18 / np.pi}


def in_a_hand(seed=1, hz=50.0, seconds=30.0, axes=(1, 1, 1), push_g=0.3):
    """t_s (n,), rates in dps and force in g, both (3, n): turns of a hand about some axes."""
    rng = np.random.default_rng(seed)
    t_s = np.arange(int(seconds * hz)) / hz
    waves = rng.uniform(0.1, 0.6, (3, 4, 1)), rng.uniform(0, 6.3, (3, 4, 1))
    rates = 60 * np.sin(6.283 * waves[0] * t_s + waves[1]).sum(axis=1)
    rates *= np.array(axes)[:, np.newaxis]
    pose = Rotation.identity()
    force = []
    for rate in rates.T:
        force.append(pose.inv().apply([0.3, -0.5, 0.8]))
        pose = pose * Rotation.from_rotvec(np.radians(rate / hz))
    pushed = push_g * np.sin(6.283 * rng.uniform(1, 3, (3, 1)) * t_s)
    noise = rng.normal(0, 0.01, (3, len(t_s)))
    return t_s, rates + rng.normal(0, 0.1, rates.shape) + 0.8, np.transpose(force) + pushed + noise


@settings(max_examples=12, phases=QUICK)
@given(
    seed=st.integers(0, 10**6),
    hz=st.sampled_from([10.0, 25.0, 104.0, 400.0]),
    dps=st.sampled_from([*UNITS_DPS.values(), 1 / 131, 1 / 16.4]),
)
def test_in_a_hand_gravity_tells_the_size_of_rates(seed, hz, dps):
    t_s, rates, force = in_a_hand(seed, hz)
    assert dps_of_one(rates / dps, force, t_s).dps == pytest.approx(dps, rel=0.15)


def frame_of(t_s, rates, force, names="gx_dps,gy_dps,gz_dps", forces="ax_g,ay_g,az_g", time="t_s"):
    """A table of these columns."""
    names = [time, *names.split(","), *forces.split(",")]
    return pd.DataFrame(dict(zip(names, [t_s, *rates, *force])))


@pytest.mark.parametrize("length_m", [0.3, 2.0])
def test_a_pendulum_whose_pushes_move_with_it_does_not_mislead(tmp_path, length_m):
    t_s = np.arange(3000) / 100
    swing = 0.5 * np.exp(-t_s / 60) * np.sin(np.sqrt(9.8 / length_m) * t_s)
    rate = np.gradient(swing, t_s)
    rng = np.random.default_rng(1)
    along = np.cos(swing) + rate**2 * length_m / 9.8
    force = np.array([along, 0.05 * rate, 0 * t_s]) + rng.normal(0, 0.005, (3, len(t_s)))
    rates = np.array([0 * rate, 0 * rate, rate]) + rng.normal(0, 0.002, (3, len(t_s)))
    frame = frame_of(t_s, rates, force, "gx (rad/s),gy (rad/s),gz (rad/s)")
    assert not read(tmp_path, frame)[1].doubts


@settings(max_examples=12, phases=QUICK)
@given(seed=st.integers(0, 10**6), hz=st.sampled_from([10.0, 104.0]))
def test_at_rest_and_from_axes_that_do_not_belong_together_nothing_is_told(seed, hz):
    t_s, rates, force = in_a_hand(seed, hz)
    rng = np.random.default_rng(seed)
    still = np.array([[0.1], [0.2], [0.97]]) + rng.normal(0, 0.01, force.shape)
    assert dps_of_one(rng.normal(0.5, 0.1, rates.shape), still, t_s) is None
    assert dps_of_one(-rates, force, t_s) is None


@settings(max_examples=12, phases=QUICK)
@given(seed=st.integers(0, 10**6), order=st.permutations(range(3)), signs=SIGNS)
def test_in_a_hand_gravity_tells_the_axes_of_rates(seed, order, signs):
    t_s, rates, force = in_a_hand(seed)
    mixed = rates[list(order)] * np.array(signs)[:, np.newaxis]
    assert axes_of(mixed, force, t_s) @ mixed == pytest.approx(rates)
    still = np.tile([[0.1], [0.2], [0.97]], len(t_s))
    assert axes_of(mixed, still, t_s) is None


def test_axes_that_do_not_agree_are_told_with_the_words_that_mend_them(tmp_path):
    t_s, rates, force = in_a_hand()
    mixed = rates[[1, 0, 2]] * np.array([[-1], [1], [1]])
    frame_of(t_s, mixed, force).to_csv(tmp_path / "in.csv")
    (doubt,) = import_recording(tmp_path / "in.csv", tmp_path / "out.csv").doubts
    assert "y -x z of the accelerometer" in doubt
    with pytest.raises(CannotClose, match="out: gravity turns as if"):
        close([tmp_path / "out.csv"], tmp_path / "closed")
    words = re.findall(r"--map (\S+?)[, ]", doubt)
    mapping = [parsed_mapping(word) for word in words]
    mended = import_recording(tmp_path / "in.csv", tmp_path / "out.csv", mapping=mapping)
    assert len(words) == 3 and not mended.doubts
    assert pd.read_csv(tmp_path / "out.csv")["gy"].corr(pd.Series(rates[1])) > 0.999


def test_gaps_and_cells_without_a_number_do_not_change_what_is_told():
    t_s, rates, force = in_a_hand(seconds=60.0)
    rates[:, 700:720] = np.nan
    t_s[1500:] += 400.0
    assert dps_of_one(rates, force, t_s).dps == pytest.approx(1.0, rel=0.1)
    assert dps_of_one(rates[:, :500], force[:, :500], t_s[:500]) is None  # of ten seconds
    slow = in_a_hand(hz=0.5, seconds=600.0)
    assert dps_of_one(*slow[1:], slow[0]) is None


@pytest.mark.parametrize(("power", "told"), [(-33, 0), (-32, 1), (-4.5, 1), (19, 1), (20, 0)])
def test_sizes_at_the_ends_of_what_is_tried_are_not_told(power, told):
    t_s, rates, force = in_a_hand(hz=33.0, seconds=20.0, push_g=0.0)
    size = dps_of_one(rates / 1.25**power, force, t_s)
    assert (size is not None) == told
    if told:
        assert size.dps == pytest.approx(1.25**power, rel=0.03)
        assert (size.least, size.most) == pytest.approx((size.dps / 1.4, size.dps * 1.4))


@pytest.mark.parametrize(("swing_rad", "times", "otherwise"), [(0.36, 4.1, 0), (0.39, 1.4, 1)])
def test_what_swings_little_may_be_a_pendulum(swing_rad, times, otherwise):
    t_s = np.arange(700) / 33
    swing = swing_rad * np.sin(2 * t_s)
    rates = np.array([np.degrees(np.gradient(swing, t_s)), 0 * t_s, 0 * t_s])
    force = np.array([0 * t_s, np.sin(swing), np.cos(swing)])
    size = dps_of_one(rates, force, t_s)
    assert (size.least, size.most) == pytest.approx((size.dps / 1.4, size.dps * times))
    assert not turning.turns_otherwise(rates, force, t_s)
    for push, alone in ((0.13, True), (0.16, False)):  # their RMS is 0.7 of it
        pushed = 3 * force * (1 + push * np.sin(9 * t_s))
        assert turning.turns_otherwise(-rates, pushed, t_s) == (alone and otherwise)
    assert not turning.turns_otherwise(-rates[:, :9], force[:, :9], t_s[:9])


def plain(dps=1.0, names="gyro_x,gyro_y,gyro_z"):
    """A table whose names tell no units, and its rates in dps."""
    t_s, rates, force = in_a_hand()
    return frame_of(t_s, rates / dps, force, names, "acc_x,acc_y,acc_z", "t"), rates


@pytest.mark.parametrize("unit", ["dps", "mdps", "rad/s"])
def test_rates_and_times_whose_unit_nobody_names_are_taken_as_they_must_be(tmp_path, unit):
    frame, rates = plain(UNITS_DPS[unit])
    recording, report = read(tmp_path, frame)
    assert f"gyro taken in {unit}: gravity turns with it" in report.notes
    assert "time taken in s: that is 50 Hz" in report.notes
    assert recording.gyro_dps().T == pytest.approx(rates, abs=0.1)


def test_gravity_tells_the_unit_where_each_sensor_has_rows_of_its_own(tmp_path):
    frame, _ = plain(UNITS_DPS["rad/s"])
    axes = [["gx", "gy", "gz"], ["acc_x", "acc_y", "acc_z"]]
    faster = np.arange(frame["t"].iloc[0], frame["t"].iloc[-1], 0.019)
    force = pd.DataFrame({name: np.interp(faster, frame["t"], frame[name]) for name in axes[1]})
    rows = pd.concat([frame.drop(columns=axes[1]), force.assign(t=faster)])
    _, report = read(tmp_path, rows.sort_values("t"))
    assert "gyro taken in rad/s: gravity turns with it" in report.notes
    (doubt,) = read(tmp_path, rows, units={"gyro": "dps"})[1].doubts
    assert "did you mean rad/s?" in doubt


@pytest.mark.parametrize(("unit", "per_s"), [("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
def test_times_that_may_be_of_two_units_are_taken_so_that_the_rates_turn_gravity(
    tmp_path, unit, per_s
):
    frame, _ = plain()
    frame["t"] = (frame["t"] * per_s).astype(int)
    _, report = read(tmp_path, frame)
    assert f"time taken in {unit}: that is 50 Hz, and gravity turns with the rates" in report.notes
    with pytest.raises(BadRecording, match=rf"--time-unit .*\(0.05 Hz\) or {unit} \(50 Hz\)"):
        read(tmp_path, frame.assign(acc_x=0, acc_y=0, acc_z=9.8))


def test_a_unit_in_a_name_that_gravity_contradicts_is_refused_with_the_true_one(tmp_path):
    frame, _ = plain(UNITS_DPS["rad/s"], "gx_dps,gy_dps,gz_dps")
    with pytest.raises(BadRecording, match="gravity turns 5[5-9] times as fast.*gx=gx_dps:rad/s"):
        read(tmp_path, frame)
    _, report = read(tmp_path, frame, mapping="gx=gx_dps:dps gy=gy_dps:dps gz=gz_dps:dps")
    assert "did you mean rad/s?" in " ".join(report.doubts)


def test_rates_that_would_turn_gravity_where_it_stays_are_in_a_smaller_unit(tmp_path):
    t_s, luck = np.arange(1500) / 50, np.random.default_rng(4)
    rates = luck.normal(0, 0.4, (3, 1500)) + [[0.9], [1.1], [0.5]] + 2 * np.sin(t_s)
    force = luck.normal(0, 0.4, (3, 1500)) + [[-0.8], [0.5], [-9.9]]
    drive = partial(frame_of, t_s, rates, force, forces="ax,ay,az")
    with pytest.raises(BadRecording, match="give --gyro-unit dps"):
        read(tmp_path, drive("rollrate,pitchrate,yawrate"))
    names = ",".join(f"gyro_{axis} (rad/s)" for axis in "xyz")
    with pytest.raises(BadRecording, match="would turn it; did you mean dps"):
        read(tmp_path, drive(names))
    (doubt,) = read(tmp_path, drive("gx,gy,gz"), units={"gyro": "rad/s"})[1].doubts
    assert "did you mean dps" in doubt
    assert not read(tmp_path, drive("gx,gy,gz"), units={"gyro": "dps"})[1].doubts
    how = {"units": {"gyro": "lsb"}, "options": Options(gyro_lsb_per_dps=15)}
    counts = frame_of(t_s, 900 * rates // 1, force, "gx,gy,gz", "ax,ay,az")
    (doubt,) = read(tmp_path, counts, **how)[1].doubts
    assert "is --gyro-lsb-per-dps right" in doubt


@pytest.mark.parametrize("times", [0.5, 1.6])
def test_times_and_scales_that_gravity_denies_are_doubted(tmp_path, times):
    frame, _ = plain(1.0, "gx_dps,gy_dps,gz_dps")
    (doubt,) = read(tmp_path, frame, options=Options(hz=50.0 * times))[1].doubts
    assert f"{times:.1f}" in doubt and "--hz" in doubt
    how = {"units": {"gyro": "lsb"}, "options": Options(gyro_lsb_per_dps=16.4)}
    (doubt,) = read(tmp_path, plain(times / 16.4)[0], **how)[1].doubts
    assert "--gyro-lsb-per-dps" in doubt


def test_columns_that_do_not_turn_gravity_are_doubted_as_rates(tmp_path):
    t_s, _, force = in_a_hand(push_g=0.0)
    (doubt,) = read(tmp_path, frame_of(t_s, 90 * force[[1, 2, 0]] ** 2, force))[1].doubts
    assert "gx_dps" in doubt


@pytest.mark.parametrize(("unit", "dps"), [("deg/min", 1 / 60), ("0.1 deg/s", 0.1)])
def test_a_quotient_that_is_no_known_unit_is_refused_and_taken_by_its_size(tmp_path, unit, dps):
    frame, rates = plain(dps, ",".join(f"gyro {axis} [{unit}]" for axis in "xyz"))
    with pytest.raises(BadRecording, match=f"{unit}.*:xSIZE"):
        read(tmp_path, frame)
    words = " ".join(f"g{axis}=gyro_{axis}:x{dps}" for axis in "xyz")
    recording, _ = read(tmp_path, plain(dps)[0], mapping=words)
    assert recording.gyro_dps().T == pytest.approx(rates, abs=0.1)


@pytest.mark.parametrize(("swings_deg", "told"), [(40.0, "-x y z"), (4.0, None)])
def test_axes_are_told_where_the_force_swings_by_more_than_pushes_do(swings_deg, told):
    """A car leans out of its curve: the force swings against its roll."""
    t_s = np.arange(3000) / 50
    rates = swings_deg * np.sin(np.outer([2.0, 1.4, 0.9], t_s))
    force = into_body(integrate(rates.T * [-1, 1, 1], 0.02, IDENTITY), np.array([0.0, 0.0, 1.0])).T
    axes = axes_of(rates, force[:, : len(t_s)], t_s)
    assert (None if axes is None else axes_words(axes)) == told
