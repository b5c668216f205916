"""What motion shows, part by part: whether recordings are of one device, and how one moves."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import f as fisher
from zerorate_tools.loop.motion import by_windows, heading, scales_and_timing, windows
from zerorate_tools.loop.motion.clock import evenly
from zerorate_tools.loop.motion.device import LEVEL, DifferentDevices, Shown, check_one_device
from zerorate_tools.loop.motion.heading import heading_lost
from zerorate_tools.loop.motion.moving import Moving, _attitude_by, check_axes, moving_of
from zerorate_tools.loop.motion.scales_and_timing import InMotion, Timing
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.model import Slot
from zerorate_tools.model.term import Term
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


@pytest.mark.parametrize(("share", "refused"), [(0.99, False), (1.01, True)])
def test_recordings_are_of_two_devices_beyond_one_chance_in_a_million_of_all_splits(share, refused):
    ratio = fisher.isf(LEVEL / 4, 9, 9)  # of the four ways to part three in two or none
    apart = share * np.sqrt(1.5 * ratio / 1e8)
    assert bool(parted(0.0, 0.0, apart)) is refused


@pytest.mark.parametrize(
    ("beside", "tilted", "is_planar"),
    [(0, 0, True), (0.09, 0, True), (0.11, 0, False), (0, 0.09, True), (0, 0.11, False)],
)
def test_who_turns_about_one_axis_in_one_pose_moves_in_a_plane(beside, tilted, is_planar):
    at_s, accel = np.arange(3000) / 50, np.zeros((3000, 3))
    swing, slow = (np.sqrt(2) * np.sin(2 * np.pi * hz * at_s) for hz in (1.3, 0.05))
    rate = np.column_stack([beside * np.cos(2 * np.pi * 1.3 * at_s) * np.sqrt(2), 0 * swing, swing])
    size = np.sqrt(1 - beside**2)
    accel[:, 0], accel[:, 2] = tilted * slow, np.sqrt(1 - (tilted * slow) ** 2)
    every = np.ones(3000, bool)
    rate[:, 2] *= size
    one = Moving("x", rate, accel, at_s, every, ~every, np.zeros(3), np.zeros((0, 4)))
    assert one.planar is is_planar


def test_an_attitude_by_true_rates_is_known_where_these_are():
    rate = np.full((100, 3), [0.0, 0.0, 90.0])
    rate[40:45] = np.nan
    attitude = _attitude_by(rate, 0.02)
    assert np.isnan(attitude).all(axis=1).nonzero()[0].tolist() == [40, 41, 42, 43, 44]
    turned = 2 * np.degrees(np.arctan2(attitude[:, 3], attitude[:, 0]))
    steps = np.diff(turned)
    assert steps[np.isfinite(steps)] == pytest.approx(np.full(93, 1.8), abs=1e-6)
    assert turned[45] - turned[39] == pytest.approx(1.8, abs=1.9)


# --- what is found, and what is made of it ---


def six_blocks(name, moving, block_s=20.0, ticks_per_block=4, sources=(), **more):
    """A session of which so many ticks of 5 s are no rest."""
    ticks = np.where(np.arange(6 * ticks_per_block) < moving, np.nan, 0.0)[:, None] * np.ones(3)
    rate, sources = np.ones((6, 3)), dict(sources)
    whole = Session(name, block_s, ticks_per_block, rate, np.ones(6), sources, **more)
    return replace(whole, ticks_dps=ticks)


def late(delay_s=0.004, p=1e-5, sessions_s=(0.003, 0.005)):
    return Timing(delay_s, 0.001, p, sessions_s)


@pytest.mark.parametrize(
    ("timing", "found"),
    [
        *((late(), True), (late(-0.004, sessions_s=(-0.1,)), True), (late(p=1.1e-4), False)),
        *((late(p=0.9e-4), True), (late(sessions_s=(0.01, -0.01)), False), (late(9e-5), False)),
        *((late(1.1e-4), True), (late(-9e-5), False), (late(sessions_s=()), False)),
    ],
)
def test_a_delay_is_found_where_it_is_sure_alike_in_all_and_not_small(timing, found):
    assert timing.found is found and InMotion(timing=timing).found is found


def test_a_matrix_that_a_reference_shows_goes_out_of_the_blocks_and_into_three_slots():
    matrix = np.arange(9.0).reshape(3, 3) / 100
    scale = SimpleNamespace(
        found=True, deployed=matrix, reference=by_windows.GIVEN, kind="cross-axis",
        fastest_dps=np.array([10.0, 20.0, 30.0]),
    )  # fmt: skip
    rates = {f"rate_{a}": np.arange(12.0) * k for k, a in enumerate("xyz", 1)}
    session = six_blocks("s", 8, sources=rates, ticks_per_block=2, block_s=10.0)
    block = np.outer(np.arange(6) * 2 + 0.5, [1.0, 2.0, 3.0])
    left = scales_and_timing.without_scales(session, InMotion(scale)).rate_dps
    assert left == pytest.approx(1.0 - block @ matrix.T)
    terms = [Term(f"rate_{a}", -10.0 * k, 10.0 * k) for k, a in enumerate("xyz", 1)]
    slots = [Slot(t, tuple(c), "cross-axis") for t, c in zip(terms, matrix.T.tolist())]
    assert scales_and_timing.slots_of(InMotion(scale)) == slots and InMotion(scale).found
    unsure = SimpleNamespace(**{**vars(scale), "found": False})
    by_gravity = SimpleNamespace(**{**vars(scale), "reference": by_windows.GRAVITY})
    bare = replace(session, sources={})
    cases = ((session, unsure), (session, by_gravity), (bare, scale), (session, None))
    for some, shown in cases:
        turned = scales_and_timing.rates_of_turning(some, InMotion(shown))
        assert turned.shape == (6, 3) and not turned.any()
    assert scales_and_timing.slots_of(InMotion(unsure)) == [] and not InMotion(unsure).found
    assert scales_and_timing.in_motion([session], [], None) == InMotion()
    assert not scales_and_timing.may_show_motion(session)
    assert scales_and_timing.may_show_motion(six_blocks("s", 9))


def test_sessions_that_move_are_asked_and_all_must_have_a_delay_to_tell_one(monkeypatch):
    delay = np.random.default_rng(1).random((600, 2))
    one, still = six_blocks("a", 9, delay=delay), six_blocks("b", 8, delay=delay)
    monkeypatch.setattr(scales_and_timing, "moving_of", lambda log: None if log == "of c" else log)
    monkeypatch.setattr(scales_and_timing, "by_windows", lambda *of: of)
    logs = {name: f"of {name}" for name in "abcde"}
    beside, held = [replace(one, name="c"), replace(one, name="d")], [replace(one, name="e"), still]
    told = scales_and_timing.in_motion([one, still], held, logs, beside)
    assert told.rate_scale == (["of a", "of d"], ["of e"])
    assert told.timing == scales_and_timing.timing_of([(delay, 5.0)] * 2)
    without = scales_and_timing.in_motion([one, replace(one, delay=None)], [], logs)
    assert without.timing is None


@pytest.mark.parametrize(
    ("ticks", "still", "told"), [(240, 0, True), (239, 0, False), (240, 30, False), (270, 30, True)]
)
def test_a_delay_is_told_of_eight_half_minutes_in_motion_and_more(ticks, still, told):
    products = np.random.default_rng(2).random((ticks, 2)) + [0.0, 1.0]
    products[:still] = 0.0
    assert (scales_and_timing.timing_of([(products, 1.0)]) is not None) is told
    if told:
        assert scales_and_timing.timing_of([(products, 1.0), (0 * products, 1.0)]) is None


@pytest.mark.parametrize(
    ("reference", "after", "unseen", "found"),
    [
        *((by_windows.GIVEN, 6.1, 8, True), (by_windows.GIVEN, 6.2, 8, False)),
        *((by_windows.GRAVITY, 6.01, 0, False), (by_windows.GRAVITY, 5.9, 0, True)),
        (by_windows.GIVEN, 6.1, 9, False),
    ],
)
def test_a_matrix_is_found_where_some_of_it_is_seen_and_a_heading_is_hardly_worse(
    monkeypatch, reference, after, unseen, found
):
    """A heading that is given scatters by 2 percent."""
    large = np.full((3, 3), 0.05), np.full((3, 3), 0.01), 1e-9, "scale-factor", reference
    seen = np.full(3, 300.0), np.arange(9).reshape(3, 3) < unseen
    unit = by_windows.UNIT[reference]
    tilts = 2.0, 1.0, unit, 40
    shown = by_windows.RateScale(*large, np.ones(2), *tilts, *seen, 1.0, large[0], (6.0, 1.0))
    monkeypatch.setattr(by_windows, "heading_lost", lambda judged: (6.0, after))
    assert by_windows._judged_by_heading(shown, [], []).found is found
    lost = iter([None, (6.0, after)])  # what was left out sees no stretch of a heading
    monkeypatch.setattr(by_windows, "heading_lost", lambda judged: next(lost))
    fitted = by_windows._judged_by_heading(shown, [], [])
    assert fitted.found is found and (f"{after:.2f} degrees" in "".join(fitted.notes)) is (
        after in (6.2, 6.01)
    )
    assert f"sees 1.23 {unit}" in by_windows.seen_in_words(1.234, unit)


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
    one = Moving("x", rate, none, at_s, every, ~every, np.zeros(3), np.zeros((0, 4)), given)
    before, after = heading_lost([(one, np.diag([0.0, 0.0, 0.01]))])
    assert before == pytest.approx(0.0, abs=1e-6) and 0.01 < after


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


def test_windows_are_whole_and_move_and_parts_have_their_own_rests(tmp_path):
    moving = moving_of(written(tmp_path))
    assert [s.start for s in moving.spans(10.0)] == [*range(0, 1001, 125)]
    assert all(s.stop - s.start == 500 for s in moving.spans(10.0)) and moving.spans(0.16) == []
    for gaps, spans in ((3.9, 9), (5.1, 5)):  # more than five samples apart is a gap
        late_s = 0.02 * gaps * (np.arange(1500) > 700)
        assert len(replace(moving, at_s=moving.at_s + late_s).spans(10.0)) == spans
    railed = replace(moving, usable=np.arange(1500) != 1499)
    assert [s.start for s in railed.spans(10.0)] == [*range(0, 876, 125)]
    slow = replace(moving, rate=moving.rate * 1e-3)
    assert slow.spans(10.0) == [] and windows.rows_of(slow, 10.0, None, None) is None
    rests = np.column_stack(
        [[moving.at_s[499], moving.at_s[500], moving.at_s[999], 14.0], np.eye(4)[:, :3]]
    )
    part = replace(moving, rests=rests).part(slice(500, 1000))
    assert part.rests[:, 0].tolist() == rests[1:3, 0].tolist() and len(part.rate) == 500


@pytest.mark.parametrize(("without", "with_it", "counts"), [(400, 420, False), (1, 420, True)])
def test_a_heading_that_is_far_off_anyway_hardly_counts_but_one_that_gets_so(
    without, with_it, counts
):
    squares = np.array([[1.0] * 9 + [without], [0.25] * 9 + [with_it]])
    weight = heading._weights(squares)
    assert bool(weight[-1] > 0.5 * weight[0]) is counts


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
