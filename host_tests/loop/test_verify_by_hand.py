"""What judges by data that no fit has seen, beside plain loops over samples and small tables."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_tools.layout import AXIS
from zerorate_tools.loop.fit.noise import floor_dps
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.motion.scales_and_timing import InMotion
from zerorate_tools.loop.read.earth import Earth
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.decide import Decision
from zerorate_tools.loop.search.selection import Found, Selection
from zerorate_tools.loop.verify import courses, run_kernels
from zerorate_tools.loop.verify import prune_by_holdout as prune
from zerorate_tools.loop.verify.analysis import Analysis, deployable, model_of
from zerorate_tools.loop.verify.firmware import Firmware, Refused, at_once, rows
from zerorate_tools.loop.verify.judge import (
    Judgement,
    ResidualTest,
    judge,
    scored,
)
from zerorate_tools.loop.verify.power_on import BlockMeans, PowerOn, TurnOn, ideal_dps, turn_on
from zerorate_tools.model import CannotDeploy, Slot, drafted
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.replay.samples import Frames

from . import dense, power_ons
from .dense import A, B, C

SCALES = Scales("MPU-6050", 5.0, 131.0, 16384.0, 340.0, 36.53)
PER, TICKS, HZ = 20, 4, 5  # samples and ticks a block, samples a tick
LINE = Term("temp", centre=25.0)


def effect(*terms, kind="supply-voltage", axes=(True, True, True)):
    decision = Decision(True, 0.0, 0.0, 1.0, np.zeros(1), tried=1.0)
    return Found(Candidate(kind, terms, "catalogue"), decision, axes=axes)


def selected(sessions, *found, line=(), **more):
    return Selection([*found], [], 0, Regression(sessions), line, (), [], {}, **more)


# --- the firmware over a session ---


def at_rest(seed=0, blocks=40, bias_lsb=(30, -20, 10)):
    """Columns of a rest at one temperature, with a voltage beside it."""
    n = blocks * PER
    volts = np.random.default_rng(seed + 1000).normal(5000, 50, n)
    columns = power_ons.at_rest(seed, n, 0, middle_degc=27.7, swing_degc=0.0)
    columns |= {g: columns[g] + b for g, b in zip(("gx", "gy", "gz"), bias_lsb)}
    return {**columns, "volt": np.rint(volts).astype(np.int32)}


def powered_on(folder, columns, channels=(), name="s", **more):
    """A recording on disk and its session, a block of four seconds."""
    path = folder / f"{name}.parquet"
    write_recording(Recording(columns, SCALES, name), path)
    rate = np.column_stack([columns[g] for g in ("gx", "gy", "gz")]) / 131.0
    blocks = -(-len(rate) // PER)
    whole = np.full((blocks * PER, 3), np.nan)
    whole[: len(rate)] = rate
    means = np.nanmean(whole.reshape(blocks, PER, 3), axis=1)
    degc = 36.53 + np.resize(columns["temp"], blocks * PER) / 340
    sources = {"temp": degc.reshape(-1, HZ).mean(axis=1)}
    session = Session(
        *(name, 4.0, TICKS, means, np.ones(blocks), sources),
        start_us=int(columns["t_us"][0]),
        tick_weight=np.full(blocks * TICKS, float(HZ)),
    )
    session = replace(session, **more)
    every = np.ones(session.blocks, bool)
    return PowerOn(session, path, 131.0, session.rate_dps, every, channels)


def test_every_sample_has_its_tick_and_block(tmp_path):
    columns = at_rest(blocks=6)
    columns = {name: values[:-3] for name, values in columns.items()}
    p = powered_on(tmp_path, columns, ("volt",))
    short = replace(p, session=replace(p.session, rate_dps=p.session.rate_dps[:5]))
    (frames,) = p.frames()
    at = np.arange(6 * PER - 3)
    assert p.ticks(frames).tolist() == (at // HZ).tolist()
    assert p.blocks(frames).tolist() == (at // PER).tolist()
    assert short.blocks(frames).max() == 4  # what is left over goes with the last block
    assert frames.extra[:, 0].tolist() == columns["volt"].tolist()
    pieces = [(block, len(part)) for block, part in p.by_blocks()]
    assert pieces == [(0, 20), (1, 20), (2, 20), (3, 20), (4, 20), (5, 17)]
    joined = np.vstack([part.frames for _, part in p.by_blocks()])
    assert (joined == frames.frames).all()


def test_steps_are_taken_out_of_the_samples_in_whole_counts(tmp_path):
    columns = at_rest(blocks=6)
    plain = powered_on(tmp_path, columns)
    level = np.zeros((6 * TICKS - 1, 3))  # the last goes on
    level[10:] = np.array([3.7, -2.25, 5.0]) / 131.0
    level[22:] = np.array([1.0, 2.0, -3.0]) / 131.0
    stepped = replace(plain, session=replace(plain.session, level_dps=level))
    (frames,), (less,) = plain.frames(), stepped.frames()
    taken = (frames.frames - less.frames)[:, 4:]
    assert (taken[: 10 * HZ] == 0).all()
    assert (taken[22 * HZ :] == [1, 2, -3]).all()
    after = taken[10 * HZ : 22 * HZ]
    for axis, counts in enumerate((3.7, -2.25, 5.0)):
        assert set(after[:, axis]) <= {np.floor(counts), np.ceil(counts)}
        assert after[:, axis].mean() == pytest.approx(counts, abs=0.02)
    assert (frames.frames[:, :4] == less.frames[:, :4]).all()


def test_biases_of_samples_are_gathered_into_means_of_blocks(tmp_path):
    columns = at_rest(blocks=6)
    columns = {name: np.delete(values, [21, 22, 50], axis=0) for name, values in columns.items()}
    p = powered_on(tmp_path, columns, rate_dps=np.ones((5, 3)), weight=np.ones(5),
                   tick_weight=np.full(5 * TICKS, 5.0))  # fmt: skip
    (frames,) = p.frames()
    bias = np.random.default_rng(1).integers(-9000, 9000, (len(frames), 3))
    means = BlockMeans(p)
    for part in np.array_split(np.arange(len(frames)), 4):
        means.add(rows(frames, part[0], part[-1] + 1), bias[part])
    at = p.ticks(frames)
    for tick in (0, 4, 10, 19):
        expected = bias[at == tick].mean(axis=0) / 256 / 131
        assert means.ticks_dps()[tick] == pytest.approx(expected)
    each = [bias[at == tick].mean(axis=0) / 256 / 131 for tick in range(4, 8)]
    assert means.blocks_dps()[1] == pytest.approx(np.mean(each, axis=0))
    assert means.blocks_dps().shape == (5, 3)
    assert np.isnan(BlockMeans(p).ticks_dps()).all()


def test_what_an_ideal_bias_would_be_has_earth_s_rate_at_the_first_rest_in_it(tmp_path):
    session = powered_on(tmp_path, at_rest(blocks=20)).session
    assert (ideal_dps(session, InMotion()) == session.rate_dps).all()
    turning = np.outer(np.arange(22 * TICKS), [1.0, 2.0, 3.0])
    earth = replace(session, earth=Earth(turning, 0.0, ""))
    by_block = turning[: 20 * TICKS].reshape(20, TICKS, 3).mean(axis=1)
    expected = session.rate_dps + by_block[:15].mean(axis=0)  # of a minute in blocks of 4 s
    assert ideal_dps(earth, InMotion()) == pytest.approx(expected)


class Scripted:
    """A device that knows its offset, on two axes or all, after so many samples.

    Its target is how many samples it has learned.
    """

    offset = 0, 0, 0

    def __init__(self, known_after, third=True):
        self.known_after, self.third = known_after, third
        self.seen = self.taught = 0

    def copy(self):
        return Scripted(self.known_after, self.third)

    def power_on(self):
        self.seen = 0

    def set_offset(self, offset):
        self.offset = offset

    def run(self, frames, learn=True):
        self.seen += len(frames)
        self.taught += len(frames) * learn
        return np.repeat([np.add(self.offset, [256, 0, 0])], len(frames), axis=0)

    @property
    def offset_is_known(self):
        known = self.seen >= self.known_after
        return np.array([known, known, known and self.third])

    @property
    def target_q8(self):
        return np.array([self.taught, 2 * self.taught, -self.taught])


@pytest.mark.parametrize(
    ("known_after", "third", "blocks"),
    # at once; within the first still minute; at its end; behind it; never; and not on one axis
    [
        *((0, True, 15), (5 * PER, True, 19), (14 * PER, True, 28), (16 * PER, True, 29)),
        *((10**9, True, 29), (0, False, 29)),
    ],
)
def test_the_offset_is_told_by_the_first_still_minute_or_as_much_again_where_there_is_doubt(
    tmp_path, known_after, third, blocks
):
    p = powered_on(tmp_path, at_rest(blocks=60))
    told = turn_on(Scripted(known_after, third), p)
    assert told.blocks == blocks
    # what a learning copy asks for, less what a frozen one does; or what the truth asks for
    taught = blocks * PER * np.array([1, 2, -1])
    beside = np.round((p.rate_dps[:15].mean(axis=0) - [1 / 131, 0, 0]) * 131 * 256)
    known = np.array([True, True, third]) & (known_after < 10**9)
    assert told.offset_q8.tolist() == np.where(known, taught, beside).tolist()
    rest_later = replace(p, session=replace(p.session, weight=(np.arange(60) > 4).astype(float)))
    assert turn_on(Scripted(0), rest_later).blocks == 20


def test_a_device_at_rest_knows_its_offset_and_it_is_what_differs_from_the_learned_curve(tmp_path):
    taught = powered_on(tmp_path, at_rest(0, 60), name="a")
    again = powered_on(tmp_path, at_rest(1, 60, (55, -20, -15)), name="b")
    device = Firmware(SCALES, None)
    device.power_on()
    for frames in taught.frames():
        device.run(frames)
    told = turn_on(device, again)
    assert told.offset_q8 / 256 == pytest.approx([25, 0, -25], abs=2.5)
    ready = device.copy()
    ready.power_on()
    ready.set_offset(told.offset_q8)
    (frames,) = again.frames()
    frozen = ready.run(frames, learn=False)
    assert frozen[-1] / 256 == pytest.approx([55, -20, -15], abs=2)
    assert ready.offset_is_known.tolist() == [False] * 3
    ready.run(frames)
    assert ready.offset_is_known.tolist() == [True] * 3
    for at, suspect in zip(ready._axes(), (-1, 0, 1)):
        ready._corrector.state[at + AXIS.SUSPECT] = suspect
    assert ready.offset_is_known.tolist() == [True, True, False]
    ready.set_offset((1, -2, 3))
    assert [ready._corrector.state[at + AXIS.OFFSET_Q8] for at in ready._axes()] == [1, -2, 3]
    assert ready.target_q8 / 256 == pytest.approx([55, -20, -15], abs=2)


def test_the_compiled_device_and_the_plain_one_learn_the_same_parts(tmp_path):
    from zerorate_tools.replay.engines import CPythonEngine

    (frames,) = powered_on(tmp_path, at_rest(0, 12)).frames()
    given, may = frames.frames.copy(), (np.arange(len(frames)) // 60) % 2 == 0
    compiled, plain = Firmware(SCALES, None), Firmware(SCALES, None)
    plain._engine = CPythonEngine()
    assert (compiled.run(frames, may) == plain.run(frames, may)).all()
    assert (frames.frames == given).all()


def test_a_model_is_subtracted_by_the_device_that_holds_it_channel_by_channel(tmp_path):
    p = powered_on(tmp_path, at_rest(0, 12), ("other", "volt"))
    (frames,) = powered_on(tmp_path, at_rest(0, 12), ("volt",)).frames()
    both = Frames(
        frames.t_us, frames.frames, frames.dt_us, np.hstack([0 * frames.extra, frames.extra])
    )
    slot = Slot(Term("volt", 4000.0, 6000.0, 5000.0), (0.001, 0.0, -0.002), "supply-voltage")
    model = drafted([slot], SCALES, tick_s=1.0)
    bias = Firmware(SCALES, model, p.channels).run(both, learn=False)
    expected = (frames.extra[-1, 0] - 5000) * np.array([0.001, 0.0, -0.002]) * 131
    assert bias[-1] / 256 == pytest.approx(expected, abs=0.5)
    other = Scales("MPU-6050", 5.0, 65.5, 16384.0, 340.0, 36.53)
    with pytest.raises(Refused, match="cannot run at these scales"):
        Firmware(replace(SCALES, odr_hz=1e9), None)
    with pytest.raises(Refused, match="refuses the model"):
        Firmware(other, model, ("volt",))


def test_all_are_run_and_what_they_return_is_in_their_order():
    assert at_once([lambda x: x + 1, lambda x: x * 10, lambda x: -x], 4) == [5, 40, -4]


# --- judging ---


@pytest.mark.parametrize(
    ("p", "nats", "common", "smooth"),
    [
        *((1e-3, 3.0, False, False), (0.9e-3, 0.0, True, False)),
        *((0.5, 3.1, False, True), (1e-9, 9.0, True, True)),
    ],
)
def test_something_is_left_where_axes_move_together_or_drift_smoothly(p, nats, common, smooth):
    test = ResidualTest(p, nats, np.zeros(3))
    assert (test.common, test.smooth, test.left) == (common, smooth, common or smooth)


def judgement(before, after, gains, p=1.0):
    test = ResidualTest(p, 0.0, np.zeros(3))
    figures = np.array(before), np.array(after), np.array(gains)
    return Judgement(*figures, test, [], [], [], None)


@pytest.mark.parametrize(
    ("after", "gain", "p", "said"),
    [
        *(([1.0, 1.0, 1.0], 3.1, 1.0, "confirmed"), ([1.0, 1.0, 1.0], 3.0, 1.0, "tentative")),
        ([0.9, 0.9, 0.9], 2.9, 1.0, "tentative"),
        *(([1.0, 1.0, 1.01], 9.0, 1.0, "tentative"), ([0.5, 0.5, 0.5], 9.0, 1e-9, "tentative")),
    ],
)
def test_an_effect_is_confirmed_where_it_gains_and_the_error_does_not_grow(after, gain, p, said):
    assert judgement([1.0, 1.0, 1.0], after, [gain], p).confidence(0) == said


def test_the_first_still_minute_gives_the_offset_and_is_not_scored():
    session = dense.made(1, 12, gap=(1, 8))
    model = np.outer(session.sources["a"], [1.0, 0.0, -1.0])
    left, offset = scored(session, model)
    first = [0, 2, 3]  # three still blocks of 20 s
    expected = (session.rate_dps - model)[first].mean(axis=0)
    assert offset == pytest.approx(expected)
    assert np.isnan(left[:4]).all() and np.isnan(left[8]).all()
    assert left[4] == pytest.approx(session.rate_dps[4] - model[4] - expected)


@pytest.fixture(scope="module")
def sessions():
    made = [dense.made(seed, 24) for seed in (1, 2, 3, 4)]
    for s in made:
        s.rate_dps += 3.0 * s.sources["a"][:, None]
    return made


def test_an_effect_gains_what_the_session_held_out_loses_without_it(sessions):
    train, held = sessions[:3], sessions[3:]
    told = judge(selected(train, effect(A), effect(B)), held)
    whole = told.whole
    full = whole.fit([A, B]).base
    clean = [replace(s, rate_dps=r) for s, r in zip(whole.sessions, whole.rate)]
    problems = [dense.problem(clean, [A, B], whole.scale[:, a]) for a in range(3)]

    def misfit(keep):
        total = 0.0
        for a, p in enumerate(problems):
            to, at, x = np.linalg.inv(p.v[full.best[a]]), p.rows[3], p.x[:, keep]
            fit = np.arange(p.rows[3].start)
            v = to[np.ix_(fit, fit)]
            b = np.linalg.solve(x[fit].T @ v @ x[fit], x[fit].T @ v @ p.y[fit, a])
            left = p.y[at, a] - x[at] @ b
            total += left @ to[at, at] @ left / full.variance[a]
        return total

    with_all = misfit([0, 1])
    assert told.gains == pytest.approx(
        [0.5 * (misfit([1]) - with_all), 0.5 * (misfit([0]) - with_all)], rel=1e-4
    )
    twice = judge(selected(train, effect(A), effect(B)), [held[0], replace(held[0], name="again")])
    assert twice.gains[0] > told.gains[0] > 10


# --- what held-out data speak against ---


def parts(*errors):
    """Residuals whose RMS on each axis is what is said, with the first 0, 1, ... effects."""
    return [[np.tile(e, (4, 1)).astype(float)] for e in errors]


@pytest.fixture(scope="module")
def three():
    return selected([dense.made(1, 24)], effect(A), effect(B), effect(C))


def never(i):
    raise AssertionError(f"effect {i} is not in doubt")


ALL = (True, True, True)


@pytest.mark.parametrize(
    ("after", "alone", "corrected"),
    [
        ([[4, 4, 4], [3, 4, 3], [2, 4, 3], [2, 3, 3]], None, None),
        # of the first, later ones may have made good what it does on x
        ([[4, 4, 4], [5, 4, 3], [4, 6, 3], [4, 6, 4]], [1, 1, 1],
         [(False, True, True), (True, False, True), (True, True, False)]),
        # on one axis the worst goes alone
        ([[1, 1, 1], [1.5, 1, 1], [3, 1, 1], [3.2, 1, 1]], None, [ALL, (False, True, True), ALL]),
        # with those found later it is better than before, and than without it
        ([[1, 1, 1], [1.5, 1, 1], [0.8, 1, 1], [0.8, 1, 1]], [0.9, 1, 1], None),
        ([[1, 1, 1], [1.5, 1, 1], [0.8, 1, 1], [0.8, 1, 1]], [0.7, 1, 1],
         [(False, True, True), ALL, ALL]),
    ],
)  # fmt: skip
def test_an_effect_goes_from_the_axes_on_which_the_error_grows(three, after, alone, corrected):
    asked = []
    without = lambda i: asked.append(i) or parts(alone)[0]  # noqa: E731
    less = prune.without_harmful(three, parts(*after), without if alone else never)
    assert less is three if corrected is None else [f.axes for f in less.found] == corrected
    assert set(asked) <= {0} and [f.axes for f in three.found] == [ALL] * 3


def test_an_axis_that_an_effect_does_not_correct_is_not_its_doing(three):
    spared = replace(three, found=[effect(A, axes=(False, True, True))])
    assert prune.without_harmful(spared, parts([1, 1, 1], [2, 0.5, 0.5]), never) is spared
    assert prune.without_harmful(replace(three, found=[]), parts([1, 1, 1]), never).found == []


def test_what_was_taken_from_every_axis_is_withdrawn_with_both_errors(three):
    every = [[1, 1, 1], [2, 2, 2], [2, 2, 2], [2, 2, 2]]
    for before in ([], [[4, 4, 4]]):
        less = prune.without_harmful(three, parts(*before, *every[: 4 - len(before)]), never)
        assert less.found == [f for i, f in enumerate(three.found) if i != len(before)]
        [(name, why)] = less.withdrawn
        assert name == "supply-voltage" and "grows: with it 2e+03 mdps, without 1e+03" in why


@pytest.mark.parametrize(
    ("better", "stays"),
    [([1] * 5, True), ([1] * 4, False), ([3] * 6 + [-1] * 2, True), ([1, -2] * 10, False),
     ([0.0] * 20, False), ([-1] * 20, False)],
)  # fmt: skip
def test_an_effect_that_helps_no_more_pieces_than_chance_is_withdrawn(three, better, stays):
    def left(gained):  # one piece a block: the last in a recording of its own
        dps = np.sqrt(10.0 - np.outer(gained, [1, 0, 0]))
        return [dps[:-1], dps[-1:]]

    pieces = [np.arange(len(better) - 1), np.zeros(1, int)]
    one, after = three.first(1), [left(np.zeros(len(better))), left(better)]
    less = prune.without_unshown(one, after, never, pieces)
    if stays:
        assert less is one
    else:
        [(name, why)] = less.withdrawn
        assert not less.found and name == one.found[0].candidate.label
        assert f"{sum(b > 0 for b in better)} of {len(better)} pieces" in why


def test_of_two_effects_the_one_less_shown_goes_first(three):
    def left(dps):
        return [np.full((20, 3), dps)]

    two, pieces = three.first(2), [np.arange(20)]
    for alone, gone in ((0.5, 0), (2.0, None)):
        less = prune.without_unshown(
            two, [left(3.0), left(2.0), left(1.0)], lambda i, e=alone: left(e), pieces
        )
        assert len(less.found) == (2 if gone is None else 1)
        assert gone is None or less.found == [two.found[1]]


def test_what_a_session_held_out_speaks_against_is_withdrawn_with_both_errors(sessions):
    train = sessions[:3]
    last = replace(
        sessions[3], rate_dps=sessions[3].rate_dps - 6.0 * sessions[3].sources["a"][:, None]
    )
    selection = selected(train, effect(A))
    less, told = prune.prune_by_holdout(selection, [last])
    assert less.found == []
    [(name, why)] = less.withdrawn
    with_it, without = judge(selection, [last]), judge(less, [last])
    assert name == "supply-voltage" and f"{-with_it.gains[0]:.1f} nats" in why
    assert f"error with it {1e3 * with_it.after_rms:.3g} mdps" in why
    assert f"without {1e3 * without.after_rms:.3g}" in why
    assert told.after_rms == without.after_rms


@pytest.mark.parametrize(
    ("gain", "grows", "stays"),
    [(0.0, 0.0, True), (-0.01, 0.0, False), (-9.0, 0.0, False), (-9.0, 1.0, True)],
)
def test_an_effect_goes_where_both_the_likelihood_and_the_error_speak_against_it(
    sessions, monkeypatch, gain, grows, stays
):
    def judged(selection, holdout):
        told, none = judge(selection, holdout), not selection.found
        gains = np.full(len(selection.found), gain)
        return replace(told, gains=gains, after_dps=np.full(3, 1.0 + grows * none))

    monkeypatch.setattr(prune, "judge", judged)
    selection = selected(sessions[:3], effect(A))
    less, _ = prune.prune_by_holdout(selection, sessions[3:])
    assert (less is selection) is stays
    assert stays or f"{-gain:.1f} nats" in less.withdrawn[0][1]


def test_what_follows_time_alone_must_come_again(monkeypatch):
    made = [dense.made(seed, 40) for seed in (1, 2, 3, 4)]
    drift = effect(Term("time"), kind="time-drift")
    again = []

    def comes(whole, terms, candidate, tried):
        again.append((len(whole.sessions), list(terms), candidate, tried))
        return answer

    monkeypatch.setattr(prune, "comes_again", comes)
    for s in made:
        s.rate_dps += np.outer(np.arange(40.0), [1, 1, 1])
    selection = selected(made[:3], drift, line=(B,))
    answer = True
    kept, _ = prune.prune_by_holdout(selection, made[3:])
    assert drift in kept.found and again[0] == (4, [B], drift.candidate, 1.0)
    answer = False
    left, _ = prune.prune_by_holdout(selection, made[3:])
    assert drift not in left.found and prune.AGAIN in left.withdrawn[0][1]
    again.clear()
    for more in ({}, {"alone": True, "judged_again": True}):
        prune.prune_by_holdout(selected(made[:1], drift, **more), made[3:])
    assert not again  # one recording cannot say whether it comes again
    alone = selected(made[:1], drift, alone=True)
    assert prune.prune_by_holdout(alone, made[:1])[0] is alone


# --- slots, and what an analysis says ---


def analysed(sessions, *found, holdout=1, **more):
    train, held = sessions[:-holdout], sessions[-holdout:]
    selection = selected(train, *found, **more)
    judged = judge(selection, held)
    return Analysis(sessions, train, held, selection, judged, np.zeros(3))


@pytest.fixture(scope="module")
def warm():
    made = [dense.made(seed, 24, names=("temp", "vdd_mv", "a")) for seed in (1, 2, 3, 4)]
    for s in made:
        s.sources["vdd_mv"] = 5000 + 10 * s.sources["vdd_mv"]
        s.rate_dps += 0.01 * (s.sources["vdd_mv"] - 5000)[:, None] * [1, 2, 3]
    return made


VOLTS = Term("vdd_mv", 4900.0, 5100.0, 5000.0)
WARM = Term("temp", -20.0, 30.0, 5.0, power=2)


@pytest.mark.parametrize("at", [0, 1, 2])
def test_the_effect_that_cannot_be_deployed_is_left_out_judged_anew_and_noted(warm, at):
    beyond = effect(replace(VOLTS, lag_mode="lag", lag_s=1e9), kind="thermal-lag")
    found = [effect(VOLTS), effect(WARM)]
    assert deployable(analysis := analysed(warm, *found), SCALES) is analysis
    found.insert(at, beyond)
    analysis = analysed(warm, *found)
    less = deployable(analysis, SCALES)
    assert [f.candidate.kind for f in less.selection.found] == ["supply-voltage"] * 2
    assert len(less.judgement.gains) == 2 and "found but left out: " in less.gate.notes[0]
    both = [*less.selection.straight, *less.selection.terms]
    assert less.floor_dps == pytest.approx(floor_dps(less.judgement.whole, both))


def test_what_cannot_be_deployed_without_an_effect_is_an_error(warm, monkeypatch):
    from zerorate_tools.loop.verify import analysis as module

    def never_fits(*arguments, **named):
        raise CannotDeploy("too much of motion")

    monkeypatch.setattr(module, "build_model", never_fits)
    with pytest.raises(CannotDeploy):
        deployable(analysed(warm), SCALES)


def test_confidence_is_tentative_with_few_power_ons_beside_earth_and_for_time_without_a_thermometer(
    warm,
):
    analysis = analysed(warm, effect(VOLTS))
    sure = replace(analysis, judgement=judgement([1, 1, 1], [0.5] * 3, [9.0]))
    assert sure.confidence(0) == "confirmed" and not sure.few and not sure.single
    few = replace(sure, train=warm[:2])
    assert few.few and few.confidence(0) == "tentative" and not replace(sure, train=warm * 2).few
    beside = replace(effect(VOLTS), rivals={"earth-rotation": 0.0})
    beside_earth = replace(sure, selection=replace(sure.selection, found=[beside]))
    assert beside_earth.confidence(0) == "tentative"
    time = replace(sure, selection=replace(sure.selection, found=[effect(Term("time"))]))
    assert time.confidence(0) == "confirmed" and not time.may_be_heat(0)
    blind = replace(time, sessions=[replace(warm[0], sources={})])
    assert blind.may_be_heat(0) and blind.confidence(0) == "tentative" and blind.single
    for some in ([warm[0], *blind.sessions], [*blind.sessions, warm[0]]):  # one cannot tell
        assert replace(time, sessions=some).may_be_heat(0)
    volts = replace(blind, selection=sure.selection)
    assert not volts.may_be_heat(0) and volts.confidence(0) == "confirmed"
    doubtful = replace(sure, judgement=judgement([1, 1, 1], [2.0] * 3, [9.0]))
    assert doubtful.confidence(0) == "tentative"


# --- what the kernels make of it ---


class Counting:
    """A device that subtracts its number and, learning, one LSB more for every sample it lives."""

    def __init__(self, scales, model, channels=()):
        self.number = 0 if model is None else model
        self.lived, self.on, self.offset = 0, 0, np.zeros(3, int)

    def copy(self):
        twin = Counting(None, self.number)
        twin.lived, twin.on, twin.offset = self.lived, self.on, self.offset
        return twin

    def power_on(self):
        self.on += 1

    def set_offset(self, offset_q8):
        self.offset = np.array(offset_q8)

    def run(self, frames, learn=True):
        bias = np.full((len(frames), 3), 256 * self.number) + self.offset
        if learn:
            bias = bias + 256 * (self.lived + np.arange(len(frames)))[:, None]
            self.lived += len(frames)
        return bias


@pytest.fixture
def counting(monkeypatch):
    monkeypatch.setattr(courses, "Firmware", Counting)
    told = TurnOn(np.array([128, 0, -128]), 3)
    monkeypatch.setattr(courses, "turn_on", lambda device, p: told)


@pytest.fixture
def pair(tmp_path):
    return [powered_on(tmp_path, at_rest(i, 6), name=n) for i, n in enumerate(("a", "b"))]


def nothing(name, frames, biases):
    pass


def test_devices_live_through_the_training_and_are_run_frozen_over_what_is_held_out(counting, pair):
    m = courses.SessionRuns(pair, ["a"], ["b"], [None, 1, 2], SCALES, {})
    m.learn()
    assert [d.lived for d in m.devices] == [120] * 3 and [d.on for d in m.devices] == [1] * 3
    seen = []
    course = m.course(
        "b", False, lambda name, frames, biases: seen.append((name, len(frames), {*biases}))
    )
    ways = {"before", "after_1", "after", "online_before", "online"}
    assert set(course.residual) == ways and seen == [("b", 120, ways)]
    assert course.unscored == 3 and course.offset_dps["after"] == pytest.approx(
        [0.5 / 131, 0, -0.5 / 131]
    )
    assert set(course.offset_dps) == {"before", "after_1", "after"}
    assert course.time_s.tolist() == [2, 6, 10, 14, 18, 22]
    for way, number in (("before", 0), ("after_1", 1), ("after", 2)):
        assert course.bias[way][:, 1] * 131 == pytest.approx(np.full(6, number))
        assert course.bias[way][:, 0] * 131 == pytest.approx(np.full(6, number + 0.5))
    left = pair[1].rate_dps - course.bias["after"]
    assert np.isnan(course.residual["after"][:3]).all()
    assert course.residual["after"][3:] == pytest.approx(left[3:])
    # learning, it goes on from what the training taught
    assert course.bias["online_before"][:, 0] * 131 == pytest.approx(120 + 9.5 + 20 * np.arange(6))
    assert course.bias["online"][:, 0] * 131 == pytest.approx(122 + 9.5 + 20 * np.arange(6))
    assert [d.lived for d in m.devices] == [120] * 3


def test_over_what_was_fitted_only_before_and_after_are_run_and_online_as_it_began(counting, pair):
    m = courses.SessionRuns(pair, ["a"], ["b"], [None, 1, 2], SCALES, {})
    m.learn()
    assert set(m.course("a", False, nothing).residual) == {"before", "after"}
    course = m.course("a", True, nothing)
    assert set(course.residual) == {"before", "after", "online_before", "online"}
    assert course.bias["online"][:, 0] * 131 == pytest.approx(2 + 9.5 + 20 * np.arange(6))
    assert course.bias["online_before"][:, 0] * 131 == pytest.approx(9.5 + 20 * np.arange(6))


def test_without_a_model_after_is_as_before(counting, pair):
    m = courses.SessionRuns(pair, ["a"], ["b"], [None], SCALES, {})
    m.learn()
    course = m.course("b", False, nothing)
    assert course.bias["after"] == pytest.approx(course.bias["before"])
    some = courses.SessionRuns(pair, ["a"], ["b"], [None, 1], SCALES, {"a": SimpleNamespace(
        course=lambda sink, learning: sorted(learning))})  # fmt: skip
    some.learn()
    assert some.course("a", False, nothing) == []
    assert some.course("a", True, nothing) == ["online", "online_before"]


@pytest.mark.parametrize(
    ("few", "single", "inside"), [(True, False, ["a", "b"]), (True, True, []), (False, False, [])]
)
def test_where_few_were_fitted_pieces_of_them_are_left_out_too(few, single, inside):
    train = [SimpleNamespace(name=name) for name in "ab"]
    assert run_kernels._inside(SimpleNamespace(train=train, few=few, single=single)) == inside


def test_models_are_none_those_of_the_first_effects_and_the_whole_one(warm):
    analysis = analysed(warm, effect(VOLTS), effect(WARM))
    whole = model_of(analysis, SCALES)
    models = run_kernels.models_of(analysis, whole, SCALES)
    assert (models[0], models[-1]) == (None, whole)
    assert [len(m.slots) for m in models[1:]] == [1, 2]
    alone = analysis.selection.regression.fit([VOLTS]).coefficients[0]
    assert models[1].slots[0].coefficient_dps == pytest.approx(alone, rel=0.02)
    none = analysed(warm)
    assert run_kernels.models_of(none, model_of(none, SCALES), SCALES) == [None]
    scales = SimpleNamespace(found=True, fastest_dps=np.ones(3), deployed=np.eye(3) / 99, kind="x")
    moved = replace(analysis, motion=InMotion(scales))
    models = run_kernels.models_of(moved, whole, SCALES)
    assert [len(m.slots) for m in models[1:]] == [1, 2, 2] and models[-1] is whole


def test_columns_of_the_corrected_rows_are_what_was_subtracted(tmp_path):
    (frames,) = powered_on(tmp_path, at_rest(0, 2)).frames()
    test = np.arange(40) >= 30
    biases = {"before": np.full((40, 3), 256), "after": np.arange(120).reshape(40, 3), "after_1": 0}
    writer = run_kernels.CorrectedWriter(tmp_path / "o.parquet")
    writer.write("a.csv", frames, test, biases)
    writer.write("b.csv", frames, ~test, biases)
    writer.close()
    table = pq.read_table(tmp_path / "o.parquet").to_pandas()
    assert table["recording"].tolist() == ["a.csv"] * 40 + ["b.csv"] * 40
    assert table["split"].tolist()[:40] == ["train"] * 30 + ["test"] * 10
    assert table["t_us"].tolist() == frames.t_us.tolist() * 2
    assert (table["bias_before_gx"] == 1).all()
    assert table["bias_after_gz"].tolist()[:40] == (np.arange(40) * 3 + 2).__truediv__(256).tolist()
    assert "bias_after_1_gx" not in table and "bias_online_gx" not in table


def test_what_the_integers_round_is_the_difference_to_the_same_terms_in_floats(tmp_path):
    columns = at_rest(0, 20)
    columns["volt"] = np.rint(5000 + 300 * np.sin(np.arange(400) / 40)).astype(np.int32)
    p = powered_on(tmp_path, columns, ("volt",))
    volts = columns["volt"].reshape(-1, HZ).mean(axis=1)
    p.session.sources["volt"] = volts
    term = Term("volt", 4000.0, 6000.0, 5000.0, lag_mode="lag", lag_s=8.0)
    told = np.array([[0.001, -0.002, 0.0]])
    model = drafted([Slot(term, tuple(told[0]), "x")], SCALES, tick_s=1.0)
    exact = run_kernels.rounding_dps(p, model, [term], told, SCALES)
    assert exact[2] == 0 and exact[:2].max() < 2e-3
    wrong = run_kernels.rounding_dps(p, model, [term], told + [[0.001, 0.0, 0.0]], SCALES)
    lagged = []
    at = volts[0] - 5000.0
    for v in volts:
        at += (1 - np.exp(-1 / 8)) * (v - 5000.0 - at)
        lagged.append(at)
    held = np.r_[lagged[0], lagged[:-1]].reshape(20, 4).mean(axis=1)
    assert wrong[0] == pytest.approx(0.001 * np.sqrt((held**2).mean()), rel=0.02)


def course(**ways):
    return courses.Course(np.arange(4), {}, {w: np.full((4, 3), e) for w, e in ways.items()})


def test_what_the_kernels_find_harmful_goes_by_what_was_held_out_and_then_by_the_pieces(three):
    two = three.first(2)
    good = course(before=1.0, after_1=0.5, after=0.4)
    bad = course(before=1.0, after_1=0.5, after=np.array([0.4, 0.6, 0.4]))
    asked = []

    def of(held, pieces=None):
        every = {"h": held, **({"p": pieces} if pieces else {})}
        told = courses.Courses(every, ["h"], np.zeros(3), inside=["p"] if pieces else [])
        return run_kernels._without_harmful(two, told, asked.append)

    assert of(good) is two and of(good, good) is two
    for less in (of(bad), of(bad, good), of(good, bad)):
        assert [f.axes for f in less.found] == [(True,) * 3, (True, False, True)]
    assert asked == []
    # the first is in doubt: it is asked what the other does alone
    needed = course(before=1.0, after_1=1.5, after=0.9)

    for alone, stays in ((0.95, True), (0.5, False)):
        others = course(before=9.0, after_1=alone, after=9.0)

        def again(selection, others=others):
            asked.append(selection.terms)
            return courses.Courses({"h": others}, ["h"], np.zeros(3))

        told = courses.Courses({"h": needed}, ["h"], np.zeros(3))
        less = run_kernels._without_harmful(two, told, again)
        assert (less is two) == stays and asked[-1] == [B]


def test_a_whole_device_is_measured_and_written(tmp_path):
    columns = [at_rest(i, 40) for i in range(4)]
    for c in columns:
        volts = c["volt"] + (np.arange(800) % 400 > 200) * 400
        c["volt"] = volts.astype(np.int32)
        c["gx"] = c["gx"] + np.rint((volts - 5000) * 0.1).astype(np.int32)
    every = [powered_on(tmp_path, c, name=n) for c, n in zip(columns, "abcd")]
    made = []
    for p, c in zip(every, columns):
        p.session.sources["volt"] = c["volt"].reshape(-1, HZ).mean(axis=1)
        made.append(p.session)
    analysis = analysed(made, effect(Term("volt", 4000.0, 6000.0, 5000.0)))
    logs, out, steps = [p.path for p in every], tmp_path / "corrected.parquet", []
    told, model = run_kernels.run_and_prune(analysis, logs, out, True, steps.append)
    assert len(model.slots) == 1 and steps == [1] * len(steps) and len(steps) % 4 == 0
    assert told.judgement.after_dps[0] < 0.3 * told.judgement.before_dps[0]
    found = told.measured
    assert (found.holdout, found.inside, set(found.sessions)) == (["d"], [], set("abcd"))
    assert found.rounding_dps.max() < 1e-3
    table = pq.read_table(out).to_pandas()
    assert set(table[table["recording"] == "d.parquet"]["split"]) == {"test"}
    assert set(table[table["recording"] != "d.parquet"]["split"]) == {"train"}
    assert "bias_online_gx" in table
    left = columns[3]["gx"] - table[table["recording"] == "d.parquet"]["bias_after_gx"]
    blocks = left.to_numpy().reshape(40, PER).mean(axis=1)[15:] / 131
    assert np.sqrt((blocks**2).mean()) == pytest.approx(told.judgement.after_dps[0], rel=0.05)
    none = told.selection.first(0)
    other = run_kernels._measured(told, logs, SCALES, none)
    assert other.holdout == ["d"] and set(other.sessions["d"].residual) == {
        "before",
        "after",
        "online",
        "online_before",
    }
    assert other.residuals("before")[0] == pytest.approx(found.residuals("before")[0], nan_ok=True)
    assert told.gate.notes == []
