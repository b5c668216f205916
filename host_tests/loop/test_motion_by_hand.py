"""What motion shows, part by part: whether recordings are of one device, and how one moves."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_tools.compare.judge import matrix_of
from zerorate_tools.loop.motion import by_windows, scales_and_timing
from zerorate_tools.loop.motion.clock import evenly
from zerorate_tools.loop.motion.device import DifferentDevices, Shown, check_one_device
from zerorate_tools.loop.motion.heading import heading_lost, tells_worse
from zerorate_tools.loop.motion.moving import Moving, _attitude_by, check_axes, moving_of
from zerorate_tools.loop.motion.scales_and_timing import InMotion
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.recordings import write_recording
from zerorate_tools.simulate.attitude import IDENTITY, integrate

from .test_axes_by_gravity import handled


def said(entry, precision=1e8):
    """A recording that says of all nine entries that they are this."""
    return Shown(np.eye(9) * precision, np.full(9, precision * entry))


def parted(*entries, unsure=()):
    """(groups, unsure) that recordings a, b, c, ... are refused as, or None."""
    every = [*map(said, entries), *(said(entry, 1.0) for entry in unsure)]
    try:
        check_one_device([*zip("abcdefghijk", every)])
    except DifferentDevices as error:
        return sorted(map(sorted, error.groups)), error.unsure
    return None


def test_recordings_of_two_devices_are_parted_and_those_that_tell_little_said_to_be_unsure():
    assert parted(0.005, 0.0051, -0.005) == ([["a", "b"], ["c"]], [])
    assert parted(-0.005, 0.005, 0.0051, -0.0051) == ([["a", "d"], ["b", "c"]], [])
    (one, other), unsure = parted(0.005, 0.0051, -0.005, -0.0051, unsure=[0.0])
    assert {*one, *other} == {*"abcde"} and {"a", "b"} <= {*one} | {*other} and unsure == ["e"]
    halves = np.repeat([0.005, -0.005], [5, 6]).tolist()  # of ten every split is tried
    assert parted(*halves[:10]) == ([[*"abcde"], [*"fghij"]], []) and parted(*halves) is None
    assert parted(0.005, 0.0051, 0.0049) is None and parted(0.005, -0.005) is None


def test_an_attitude_by_true_rates_is_known_where_these_are():
    rate = np.full((100, 3), [0.0, 0.0, 90.0])
    rate[40:45] = np.nan
    attitude = _attitude_by(rate, 0.02)
    assert np.isnan(attitude).all(axis=1).nonzero()[0].tolist() == [40, 41, 42, 43, 44]
    turned = 2 * np.degrees(np.arctan2(attitude[:, 3], attitude[:, 0]))
    steps = np.diff(turned)
    assert steps[np.isfinite(steps)] == pytest.approx(np.full(93, 1.8), abs=1e-6)
    assert turned[45] - turned[39] == pytest.approx(1.8, abs=1.9)


def test_a_matrix_goes_out_of_the_blocks_where_a_reference_shows_it():
    rates = {f"rate_{a}": np.arange(12.0) * k for k, a in enumerate("xyz", 1)}
    session = Session("s", 10.0, 2, np.ones((6, 3)), np.ones(6), rates)
    matrix = np.arange(9.0).reshape(3, 3) / 100
    block = np.outer(np.arange(6) * 2 + 0.5, [1.0, 2.0, 3.0])
    for reference, times in ((by_windows.GIVEN, 1.0), (by_windows.GRAVITY, 0.0)):
        shown = InMotion(SimpleNamespace(found=True, deployed=matrix, reference=reference))
        left = scales_and_timing.without_scales(session, shown).rate_dps
        assert left == pytest.approx(1.0 - times * block @ matrix.T)


@pytest.mark.parametrize(
    ("sizes", "sigma", "kind"),
    [
        *(((1.0, 0.09, 0.09), 1e-4, "scale-factor"), ((1.0, 0.11, 0.09), 1e-4, "+cross-axis")),
        ((0.09, 0.11, 1.0), 1e-4, "cross-axis+turned-axes"),
        ((0.0, 0.0, 1.0), 0.1, "turned-axes"),
        *(((1.0, 1.0, 1.0), 0.1, "+cross-axis+turned-axes"), ((1.0, 1.0, 1.0), 9.0, "+cross-axis")),
    ],
)
def test_a_matrix_is_named_by_its_parts_that_are_sure_and_no_tenth_of_the_whole(sizes, sigma, kind):
    parts = [np.diag([1.0, -1.0, 0.0]), np.ones((3, 3)) - np.eye(3), np.zeros((3, 3))]
    parts[2][0, 1], parts[2][1, 0] = 1.0, -1.0
    length = np.sqrt(1.0 + sum(size**2 for size in sorted(sizes)[:2]))
    entries = sum(s * length * p / np.linalg.norm(p) for s, p in zip(sizes, parts)).ravel()
    told = by_windows._kind(entries, sigma**2 * np.eye(9))
    assert told == (f"scale-factor{kind}" if kind.startswith("+") else kind)


# --- recordings as their motion is read ---


def written(tmp_path, change=lambda columns: columns, **how):
    recording = handled(7, np.zeros((3, 3)), **{"minutes": 0.5, **how})
    changed = replace(recording, columns=change(dict(recording.columns)))
    write_recording(changed, tmp_path / "run.parquet")
    return tmp_path / "run.parquet"


def without_acceleration(columns):
    return {n: of for n, of in columns.items() if n not in ("ax", "ay", "az")}


def test_a_recording_says_nothing_of_motion_without_turns_or_what_sees_them(tmp_path):
    bare = written(tmp_path, without_acceleration)
    assert moving_of(bare) is None
    assert moving_of(written(tmp_path, dps=0.5)) is None
    fifteen, sixteen = (
        moving_of(written(tmp_path, lambda columns, n=n: {k: c[:n] for k, c in columns.items()}))
        for n in (15, 16)
    )
    assert fifteen is None and len(sixteen.rate) == 16 and sixteen.given is None


def test_samples_at_the_end_of_an_accelerometers_range_are_in_no_window_and_it_is_said(tmp_path):
    def clipped(columns):  # stored with more room, as an import of m/s2 does
        return columns | {f"a{a}": columns[f"a{a}"].clip(-7400, 7400) for a in "xyz"}

    free, railed = (moving_of(written(tmp_path, change)) for change in (dict, clipped))
    beyond = (np.abs(free.accel) > 1.01 * np.abs(railed.accel).max()).any(axis=1)
    assert beyond.any() and not railed.usable[beyond].any() and not free.railed
    assert "run: " in railed.railed and "end of a sensor's range" in railed.railed
    assert railed.railed in matrix_of([tmp_path / "run.parquet"]).sentence()
    seen = replace(railed, given=np.tile([1.0, 0.0, 0.0, 0.0], (len(railed.rate), 1)))
    assert seen.usable[beyond].all() and not seen.railed, "beside an attitude no force is asked"


def test_true_rates_beside_a_recording_are_an_attitude_where_most_are_known(tmp_path):
    def with_true_rates(columns):
        return without_acceleration(columns) | {f"ref_g{a}": columns[f"g{a}"] for a in "xyz"}

    moving = moving_of(written(tmp_path, with_true_rates))
    assert not moving.accel.any() and np.isfinite(moving.given).all()
    turned = _attitude_by(np.degrees(moving.rate + moving.offset), moving.dt_s)
    assert moving.given == pytest.approx(turned, abs=1e-3)
    check_axes(moving)


@pytest.mark.parametrize(("unseen", "given"), [(749, True), (750, False)])
def test_an_attitude_that_is_seen_at_half_of_the_samples_is_none(tmp_path, unseen, given):
    def hidden(columns):
        for name in ("qw", "qx", "qy", "qz"):
            columns[name][:unseen] = 0
        return columns

    moving = moving_of(written(tmp_path, hidden, seen=True))
    assert (moving.given is not None) is given
    alone = replace(moving, given=None)
    assert heading_lost([(alone, np.eye(3))]) is None
    if given:  # no stretch of half a minute is seen at both ends
        assert heading_lost([(moving, 0.01 * np.eye(3))]) is None


def test_heading_is_told_where_no_window_sees_the_attitude_throughout():
    at_s = np.arange(3002) / 50
    rate = np.radians(60) * np.sin(np.outer(at_s, [1.3, 1.7, 0.9]))
    given = integrate(np.degrees(rate), 0.02, IDENTITY)[:3002]
    given[137::200] = np.nan
    every, none = np.ones(3002, bool), np.zeros((3002, 3))
    one = Moving("x", rate, none, at_s, every, every, ~every, np.zeros(3), np.zeros((0, 4)), given)
    before, after = heading_lost([(one, np.diag([0.0, 0.0, 0.01]))])
    assert before == pytest.approx(0.0, abs=1e-6) and 0.01 < after
    alone = one.part(slice(1800)), np.diag([0.0, 0.0, 0.01])
    assert not tells_worse([alone])  # half a minute that is off may be so by its bias
    assert tells_worse([alone, alone]) and heading_lost([alone]) is not None


def test_axes_that_gravity_contradicts_are_refused_by_name(tmp_path):
    def swapped(columns):
        return columns | {"gx": columns["gy"], "gy": -columns["gx"]}

    turned = moving_of(written(tmp_path, swapped, minutes=2.0))
    with pytest.raises(CannotClose, match="run: gravity turns as if the rates x y z were .*--map"):
        check_axes(turned)
    check_axes(replace(turned, accel=0.0 * turned.accel))
    check_axes(replace(turned, given=np.ones((len(turned.rate), 4))))


def test_an_attitude_that_is_the_inverse_is_refused_with_the_words_that_mend_it(tmp_path):
    def inverse(columns):
        return columns | {f"q{axis}": -columns[f"q{axis}"] for axis in "xyz"}

    with pytest.raises(
        CannotClose, match="world's axes into the body's: import it with --map qx=-"
    ):
        check_axes(moving_of(written(tmp_path, inverse, seen=True)))
    check_axes(moving_of(written(tmp_path, seen=True)))


def test_optics_that_lose_the_body_now_and_then_are_no_other_motion(tmp_path):
    def lost(columns):  # half a turn about x, for a tenth of each ten seconds
        at = np.arange(len(columns["qw"])) % 1000 < 100
        turned = zip(("qw", "qx", "qy", "qz"), ("qx", "qw", "qz", "qy"), (-1, 1, 1, -1))
        return columns | {n: np.where(at, sign * columns[o], columns[n]) for n, o, sign in turned}

    check_axes(moving_of(written(tmp_path, lost, seen=True)))


def test_an_attitude_of_another_motion_is_refused(tmp_path):
    other = handled(8, np.zeros((3, 3)), minutes=0.5, seen=True).columns
    with pytest.raises(CannotClose, match="does not turn as the rates do"):
        parts = {name: other[name] for name in ("qw", "qx", "qy", "qz")}
        check_axes(moving_of(written(tmp_path, lambda columns: columns | parts, seen=True)))


@pytest.mark.parametrize(
    "jitter_ms, batch, lost, most_ms",
    [(0, 1, 0.0, 1e-3), (0, 1, 0.03, 1e-3), (4, 1, 0.0, 1), (0, 3, 0.0, 6), (0, 3, 0.01, 25)],
)
def test_samples_are_read_on_an_even_clock(jitter_ms, batch, lost, most_ms):
    rng, taken_us = np.random.default_rng(1), np.arange(20_000) * 10_000
    late_us = rng.integers(0, 1000 * jitter_ms + 1, len(taken_us))
    late_us += (-1 - np.arange(len(taken_us))) % batch * 10_000
    kept = rng.random(len(taken_us)) >= lost
    taken_us, stamped_us = taken_us[kept], (taken_us + late_us)[kept]
    stamped_us[5000:] += 100_000
    clock_us, put = evenly(stamped_us)
    seen_us = put(taken_us[:, None])[:, 0]
    late_ms = (clock_us - seen_us)[: np.searchsorted(clock_us, stamped_us[4900])] / 1000
    assert np.diff(clock_us).max() > 100_000 and np.ptp(np.diff(clock_us)[:4800]) <= 1
    assert np.abs(late_ms - late_ms.mean()).max() < most_ms
