"""Steps of the bias: found before effects, in every stretch an offset, and never invented."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate, simulate_corners
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.search import steps_first
from zerorate_tools.loop.search.steps_first import remove_steps
from zerorate_tools.model.term import first_order_lag

from . import dense
from .selections import step


def stepped(seed, floors, *places, effects=()):
    """A session with steps of so many floors on every axis, and their blocks."""
    device = simulate(seed, effects, sessions=1, bare=not effects)
    (session,) = device.sessions
    for at, sign in zip(places, (1, -1, 1)):
        session.rate_dps[at:] += sign * floors * device.floor_dps * (1, -1, 1)
    return session, device.floor_dps


def in_a_freezer(seed, floors, place):
    """A session taken in and out of a freezer whose part is late behind the thermometer."""
    device = simulate(seed, sessions=1, bare=True)
    (session,) = device.sessions
    box = np.interp(
        session.time_s(), [800, 1100, 1900, 2200, 2800, 3000], [24, -16, -16, 40, 40, 0]
    )
    session.sources["temp"] = temp = first_order_lag(box, 20.0, session.tick_s)
    part = session.block_mean(first_order_lag(temp, 10.0, session.tick_s))[:, None] - 20.0
    bias = part * (0.012, -0.01, 0.008) + part**2 * (-3e-4, 1e-4, 3e-4)
    session.rate_dps = device.noise_dps[0] + bias
    session.rate_dps[place:] += floors * device.floor_dps * (1, -1, 1)
    return session


def steps_at(session):
    """Blocks before each step that is listed."""
    return [s.block - s.share for s in remove_steps([session])[0].steps]


def test_three_large_steps_hide_none_of_them():
    session, floor = stepped(0, 40.0, 50, 90, 130)
    (clean,) = remove_steps([session])
    assert [s.block - s.share for s in clean.steps] == [50, 90, 130]
    for found, sign in zip(clean.steps, (1, -1, 1)):
        off = found.size_dps - sign * 40 * floor * (1, -1, 1)
        assert (np.abs(off) < 5 * found.deviation_dps).all()


def test_a_step_is_taken_out_of_a_recording_alone_where_less_is_left_without_it():
    [session] = analyse([stepped(0, 40.0, 90)[0]]).sessions
    assert [s.block - s.share for s in session.steps] == [90] and session.listed == ()


@pytest.mark.parametrize("seed", range(3))
def test_a_step_of_twice_three_floors_stands_out_of_noise_that_walks(seed):
    session, _ = stepped(seed, 6.0, 90)
    assert steps_at(session) == [pytest.approx(90, abs=0.75)]


def test_a_step_beside_blocks_that_a_hand_had_mostly_is_listed():
    session, floor = stepped(0, 8.0, 90)
    per = session.ticks_per_block
    still = np.ones(session.blocks * per)
    still[89 * per : 91 * per].reshape(2, per)[:, 1:] = 0.0
    session.tick_weight = still
    ticks = np.repeat(session.rate_dps, per, axis=0)
    session.ticks_dps = np.where(still[:, None] > 0, ticks, np.nan)
    assert steps_at(session) == [pytest.approx(90, abs=0.75)]


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_a_step_between_rests_is_listed_though_the_first_block_after_has_both_its_sides(share):
    session, floor = stepped(0, 20.0, 90)
    per = session.ticks_per_block
    session.tick_weight = np.ones(session.blocks * per)
    session.tick_weight[88 * per : 91 * per] = 0.0
    session.tick_weight[[90 * per, 91 * per - 1]] = 1.0 - share, share
    session.rate_dps[90] -= (1.0 - share) * 20.0 * floor * (1, -1, 1)
    session.rate_dps[88:90], session.weight[88:90] = np.nan, 0.0
    [step] = remove_steps([session])[0].steps
    assert np.abs(step.size_dps / floor) == pytest.approx([20.0] * 3, abs=5.0)


@pytest.mark.parametrize("seed", range(2))
def test_a_part_that_is_late_behind_its_thermometer_makes_no_step_and_hides_none(seed):
    assert steps_at(in_a_freezer(seed, 0.0, 122)) == []
    assert steps_at(in_a_freezer(seed, 10.0, 122)) == [pytest.approx(122, abs=1.0)]


@pytest.mark.parametrize(
    "step_degc, off_axis, listed", [(0.0, 0, 1), (1.0, 0, 0), (1.0, 6, 1), (0.3, 0, 1)]
)
def test_a_step_along_the_slope_that_a_reading_of_the_thermometer_would_make_is_none(
    step_degc, off_axis, listed
):
    device = simulate(1, sessions=1, bare=True)
    ([session], floor) = device.sessions, device.floor_dps
    slope = 20.0 * floor * (1, -1, 1)
    temp = session.block_mean(session.sources["temp"])
    session.rate_dps = device.noise_dps[0] + np.outer(temp, slope)
    session.rate_dps[90:] += 0.8 * slope + off_axis * floor * (1, 1, 0)
    session.temp_step_degc = step_degc
    assert len(steps_at(session)) == listed


@pytest.mark.parametrize("spoiled", [(0.5,), (0.25, 0.4)])
def test_a_disturbance_of_seconds_is_no_step(spoiled):
    session, floor = stepped(0, 0.0)
    session.rate_dps[90 : 90 + len(spoiled)] += 60 * floor * np.outer(spoiled, (1, -1, 1))
    assert steps_at(session) == []


def test_a_step_that_comes_back_after_a_minute_is_two():
    session, _ = stepped(0, 30.0, 90, 93)
    assert steps_at(session) == [90, 93]


@pytest.mark.parametrize("back, slope", [(93, 0.0), (140, -0.2)])
def test_steps_are_timed_beside_each_other_and_beside_what_follows_temperature(back, slope):
    session, floor = stepped(5, 0.0)
    rng, per = np.random.default_rng(5), session.ticks_per_block
    moments, temp = (90 * per + 2, back * per + 1), session.sources["temp"]
    rate = slope * temp / (temp[91 * per] - temp[90 * per])
    for moment, sign in zip(moments, (1, -1)):
        rate[moment:] += sign
    ticks = np.repeat(session.rate_dps, per, axis=0) + rng.normal(0, 1e-4, (180 * per, 3))
    ticks += 30 * floor * rate[:, None]
    session.ticks_dps, session.tick_weight = ticks, np.ones(len(ticks))
    session.rate_dps = ticks.reshape(180, per, 3).mean(axis=1)
    at = [s.at_s / session.tick_s for s in remove_steps([session])[0].steps]
    assert at == pytest.approx(moments, abs=1)


def test_nothing_and_what_bends_has_no_step():
    listed = 0
    for seed in range(3):
        for effect in ((), [("thermal-hysteresis", 5.0)], [("temperature-kink", 5.0)]):
            session, _ = stepped(seed, 0.0, effects=effect)
            listed += len(remove_steps([session])[0].steps)
    assert listed == 0


def test_stress_that_the_accelerometer_sees_in_hundredths_of_a_g_is_no_sensitivity_to_it():
    session, floor = stepped(3, 40.0, 40, 80, 130)
    rng, per = np.random.default_rng(3), session.ticks_per_block
    stressed = np.repeat(stepped(3, 1.0, 40, 80, 130)[0].rate_dps / floor, per, axis=0)
    quiet = np.repeat(stepped(3, 0.0)[0].rate_dps / floor, per, axis=0)
    clicks = 0.02 * (np.arange(len(stressed)) // per >= 60) - 0.02 * (
        np.arange(len(stressed)) // per >= 105
    )
    for i, axis in enumerate("xyz"):
        seen = 0.02 * (stressed - quiet)[:, i] + clicks
        session.sources[f"acc_{axis}"] = (i == 2) + seen + rng.normal(0, 1e-4, len(seen))
    assert steps_at(session) == [pytest.approx(block, abs=0.75) for block in (40, 80, 130)]


@pytest.mark.parametrize("floors, follows_dps", [(8.0, 0.0), (0.0, 0.05)])
def test_what_follows_a_pose_that_changes_often_is_no_step_and_a_step_no_acceleration(
    floors, follows_dps
):
    session, _ = stepped(5, floors, 90)
    rng, ticks = np.random.default_rng(5), len(session.sources["temp"])
    pose = np.repeat([0.0, 0.3, -0.1, 0.4, 0.1, -0.2], ticks // 6)
    for axis, size in zip("xyz", (1.0, 0.5, -0.2)):
        session.sources[f"acc_{axis}"] = size * pose + rng.normal(0, 1e-3, ticks)
    session.rate_dps += follows_dps * session.block_mean(session.sources["acc_x"])[:, None]
    assert steps_at(session) == ([pytest.approx(90, abs=0.75)] if floors else [])


@pytest.mark.parametrize("seed", [5_000_015, 5_000_058])
def test_a_part_that_is_late_at_a_sharp_corner_of_temperature_makes_no_step(seed):
    (session,) = simulate_corners(seed).sessions
    assert steps_at(session) == []


BLOCKS, TICKS = 60, np.arange(120)


def in_ticks(known, jump, **sources):
    """12 blocks of 10 ticks of 2 s, of which some are known; after a jump the bias is another."""
    level = (TICKS >= jump)[:, None] * np.array([1.0, -1.0, 0.0])
    ticks = np.where(known[:, None], level, np.nan)
    session = dense.white(4, 12)
    return replace(session, ticks_per_block=10, ticks_dps=ticks, sources=sources)


KNOWN, GAP = TICKS >= 0, (TICKS < 60) | (TICKS > 66)
STEP = step(6, (1.0, -1.0, 0.0), (0.1, 0.1, 1.0))


# of what shakes within a tick, squares
SHAKEN = np.where(TICKS == 64, 0.01, 0.0009)


@pytest.mark.parametrize(
    ("known", "force", "vib", "at_s", "seen"),
    [
        (GAP, (TICKS > 68) * 0.5, 0 * SHAKEN, 138.0, "0.87 g"),
        (KNOWN, 0.0 * TICKS, SHAKEN, 128.0, "0.07 g"),
    ],
)
def test_a_knock_within_its_ticks_has_the_step_s_moment(known, force, vib, at_s, seen):
    session = in_ticks(known, 63, vib=vib, **{f"acc_{axis}": force for axis in "xyz"})
    told = steps_first._timed(session, STEP, np.zeros((120, 3)))
    assert told.at_s == at_s and seen in told.said


@pytest.mark.parametrize(
    ("second", "sign", "listed"), [(31, 1, [2.0]), (31, -1, [1.0, -1.0]), (32, 1, [1.0, 1.0])]
)
def test_a_step_that_two_blocks_in_turn_show_is_one(answers, second, sign, listed):
    one, two = step(30, deviation_dps=[0.3] * 3), step(second, [sign] * 3, [0.4] * 3)
    answers(steps_first, hold_disturbed=None, steps_and_lags=([two, one], {}))
    found = steps_first._steps(dense.white(4, BLOCKS), 1)
    assert [s.size_dps.tolist() for s in found] == [[size] * 3 for size in listed]
    assert found[0].block == 30
    assert found[0].deviation_dps == pytest.approx([0.5 if len(listed) == 1 else 0.3] * 3)
