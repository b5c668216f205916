"""One recording alone: an effect must gain on what the firmware learns without it."""

from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close, load
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.fit.line import less_slope
from zerorate_tools.loop.fit.single import PiecesByLine, nats, pass_of, speaks_for
from zerorate_tools.loop.search.curve import ByPieces, smooth_curve
from zerorate_tools.loop.search.select import Search, select
from zerorate_tools.loop.search.steps import Step
from zerorate_tools.loop.verify.by_kernels import PiecesByKernels
from zerorate_tools.loop.verify.measure import measure_and_prune
from zerorate_tools.loop.verify.power_on import PowerOn
from zerorate_tools.recordings import Recording, Scales, read_recording, write_recording
from zerorate_tools.replay.samples import frames_in_batches

SCALES = Scales("MPU-6050", 1.0, 1310.0, 16384.0, 340.0, 36.53)
#: Held-out error may grow by so much where a bend was added; the issue allows it in 2 % of devices.
WORSE = 1.02


def warm_up(folder, seed, bend_dps, odr_hz=1.0, hours=1.0):
    """A recording at rest that warms once from 20 to 50 degC; bend_dps: of -1..1, the range."""
    rng, n = np.random.default_rng(seed), int(hours * 3600 * odr_hz)
    temp = 20 + 30 * (1 - np.exp(-np.arange(n) / odr_hz / 900)) / (1 - np.exp(-hours * 4))
    u = (temp - 35) / 15
    columns = {"t_us": (np.arange(n) / odr_hz * 1e6).astype(np.int64)}
    for axis, line in (("x", 0.3), ("y", -0.2), ("z", 0.1)):
        rate = line * u + bend_dps(u) + rng.normal(0, 0.004, n)
        columns[f"g{axis}"] = np.round(rate * 1310).astype(np.int32)
        columns[f"a{axis}"] = 16384 * (axis == "z") + rng.integers(-3, 4, n).astype(np.int32)
    columns["temp"] = np.round((temp - 36.53) * 340).astype(np.int32)
    scales = Scales("MPU-6050", odr_hz, 1310.0, 16384.0, 340.0, 36.53)
    path = folder / f"warm-up-{seed}.parquet"
    write_recording(Recording(columns, scales, path.stem), path)
    return path


def closed(path, folder):
    """(kinds found, kernels' RMS before and after) of one recording alone."""
    analysis = load([path])
    analysis, _ = measure_and_prune(analysis, [path], folder / "corrected.parquet")
    judgement = analysis.judgement
    kinds = [f.candidate.kind for f in analysis.selection.found]
    return kinds, judgement.before_rms, judgement.after_rms


@pytest.mark.parametrize("seed", range(2))
def test_a_cubic_over_few_rests_is_found_and_halves_the_error(seed, tmp_path):
    path = warm_up(tmp_path, seed, lambda u: 0.15 * (u**3 - 0.6 * u), odr_hz=1 / 15)
    kinds, before, after = closed(path, tmp_path)
    assert kinds
    assert after < 0.5 * before


@pytest.mark.parametrize("seed", range(2))
def test_a_bend_that_the_firmware_follows_by_itself_is_not_made_worse(seed, tmp_path):
    _, before, after = closed(warm_up(tmp_path, seed, lambda u: 0.02 * u**2), tmp_path)
    assert after <= WORSE * before


@pytest.mark.parametrize("seed", range(2))
def test_a_straight_line_is_left_to_the_firmware(seed, tmp_path):
    kinds, before, after = closed(warm_up(tmp_path, seed, lambda u: 0.0 * u), tmp_path)
    assert not kinds
    assert after == before


def test_a_curve_that_explains_all_but_white_noise_ends_the_search(tmp_path):
    path = warm_up(tmp_path, 0, lambda u: 0.02 * u**2, odr_hz=4.0, hours=2.0)
    kinds, before, after = closed(path, tmp_path)
    assert len(kinds) <= 1
    assert after <= before


@pytest.fixture(scope="module")
def bent():
    session = simulate(3, [("temperature-quadratic", 20.0)], sessions=1, bare=True).sessions[0]
    return Search([session], on_pieces=PiecesByLine(session))


def by_pieces(search):
    own = search.regression, search.line, search.pool, search.on_pieces
    (found,) = ByPieces(*own, taken=0).look([])
    return found


class SpeakAgainst(PiecesByLine):
    reason = "the kernels say no"

    def __call__(self, straight, found, candidate):
        return np.array([-1.0, 0.1, 0.0, 0.1, -1.0])


def test_a_curve_that_pieces_speak_against_is_refused(bent):
    session = bent.regression.sessions[0]
    assert select([session], on_pieces=SpeakAgainst(session)).found == []


def test_a_bend_that_pieces_show_is_a_smooth_curve_with_a_slope_of_its_own(bent):
    best = by_pieces(bent)
    assert best.candidate.kind == "temperature-curve" and best.decision.accepted
    assert less_slope(bent.line, best.candidate.terms) == ()


def test_a_kink_is_no_smooth_curve():
    session = simulate(3, [("temperature-kink", 20.0)], sessions=1, bare=True).sessions[0]
    search = Search([session], on_pieces=PiecesByLine(session))
    assert by_pieces(search).candidate.kind == "temperature-kink"


@pytest.mark.parametrize("taken, bends", [(0, 7), (3, 4), (6, 0)])
def test_a_curve_bends_in_the_slots_that_others_leave(bent, taken, bends):
    every = smooth_curve(bent.regression.sessions, bent.line, taken)
    assert sum(len(c.terms) - 1 for c in every) == bends


def test_a_piece_far_off_either_way_does_not_drown_the_others():
    before, after = np.full((5, 3), 1.0), np.full((5, 3), 0.8)
    before[0], after[0] = 1e6, 1.01e6
    gain = nats(before, after, [20] * 5)
    assert gain[0] < 0 < gain[1:].min()
    assert speaks_for(gain)


def test_nothing_gained_is_nothing_that_speaks_for_an_effect():
    assert not speaks_for(nats(np.ones((5, 3)), np.ones((5, 3)), [20] * 5))
    assert not speaks_for(nats(np.ones((5, 3)), np.full((5, 3), np.inf), [20] * 5))


def test_every_block_is_left_out_once_and_gaps_part_it_from_what_is_fitted():
    (session,) = simulate(1, sessions=1, hours=2.0).sessions
    judged = PiecesByLine(session)
    assert (np.bincount(judged.fold) > 15).all()
    for k, part in enumerate(judged.parts):
        left = np.flatnonzero(judged.fold == k)
        apart = np.abs(left[:, None] - np.flatnonzero(part.available)).min(axis=1)
        assert apart.min() == 3
        assert np.isfinite(part.rate_dps[judged.fold != k]).mean() > 0.6


def test_pieces_lie_over_the_whole_course_of_temperature():
    (session,) = simulate(1, sessions=1, hours=2.0).sessions
    temp = session.block_mean(session.sources["temp"])
    fold = PiecesByLine(session).fold
    spans = [np.ptp(temp[fold == k]) for k in range(10)]
    assert np.median(spans) > 0.3 * np.ptp(temp)


def there_and_back(bias_dps):
    """A session that warms by 30 degC in a fifth of its time, holds for a fifth and cools slowly.
    bias_dps: by temperature, -1..1, and by the share of time that is over."""
    (session,) = simulate(1, sessions=1, hours=2.0).sessions
    rng, ticks = np.random.default_rng(5), len(session.sources["temp"])
    temp = np.interp(np.linspace(0, 1, ticks), [0.0, 0.2, 0.4, 1.0], [20.0, 50.0, 50.0, 20.0])
    session = replace(session, sources={"temp": temp + rng.normal(0, 0.1, ticks)})
    u = (session.block_mean(session.sources["temp"]) - 35) / 15
    bias = bias_dps(u, np.linspace(0, 1, session.blocks))[:, None]
    return replace(session, rate_dps=bias + rng.normal(0, 0.004, (session.blocks, 3)))


def test_a_hold_belongs_to_the_pass_before_it():
    session = there_and_back(lambda u, t: 0 * t)
    passes = pass_of(session)
    assert set(passes) == {0, 1}
    assert np.argmax(passes) == pytest.approx(0.42 * session.blocks, abs=8)


@pytest.mark.parametrize(
    "bias_dps, is_curve",
    [
        (lambda u, t: 0.03 * u**2, True),
        (lambda u, t: 0.02 * np.sin(10.5 * np.maximum(t - 0.4, 0)), False),
    ],
)
def test_whole_passes_tell_a_curve_over_temperature_from_a_walk_that_pieces_take_for_one(
    bias_dps, is_curve
):
    session = there_and_back(bias_dps)
    line = Search([session], on_pieces=PiecesByLine(session)).line
    (curve,) = smooth_curve([session], line, taken=0)
    pieces = PiecesByLine(session)
    asked = less_slope(line, curve.terms), (), curve.terms
    assert speaks_for(pieces(*asked))
    assert speaks_for(pieces.by_passes()(*asked)) == is_curve


def test_one_pass_is_judged_by_pieces():
    (session,) = simulate(1, sessions=1, hours=2.0).sessions
    warming = replace(session, sources={"temp": np.linspace(20, 50, len(session.sources["temp"]))})
    without = replace(session, sources={})
    for judged in (PiecesByLine(warming), PiecesByLine(without)):
        assert judged.by_passes() is judged


def test_a_step_whose_size_is_misjudged_is_no_error_of_the_stretch_after_it():
    (session,) = simulate(1, sessions=1, hours=2.0).sessions
    step = Step(0, session.blocks // 2, np.full(3, 0.1), 100.0, 0.0)
    judged = PiecesByLine(replace(session, steps=(step,)))
    noise = np.random.default_rng(0).normal(0, 0.004, (session.blocks, 3))
    left = noise + 0.02 * (np.arange(session.blocks) >= step.block)[:, None]
    assert np.nanstd(judged.about_stretches(left)) == pytest.approx(0.004, rel=0.05)
    assert PiecesByLine(session).about_stretches(left) is left


def test_what_a_piece_holds_changes_its_own_error_alone(tmp_path):
    path = warm_up(tmp_path, 1, lambda u: 0.0 * u)
    session = load([path]).sessions[0]
    fold = PiecesByLine(session).fold
    other = read_recording(path)
    inside = np.repeat(fold == 2, int(session.block_s))[: len(other)]
    other.columns["gx"] += np.where(inside, 100, 0).astype(np.int32)
    write_recording(other, tmp_path / "other.parquet")
    learned = []
    for log in (path, tmp_path / "other.parquet"):
        power_on = PowerOn(session, log, 1310.0, session.rate_dps, session.available, ())
        devices = PiecesByKernels(power_on, SCALES).learned([None] * 10)
        frames = next(iter(frames_in_batches(read_recording(path))))
        learned.append([d.run(frames, learn=False)[:, 0] for d in devices])
    same = [bool((a == b).all()) for a, b in zip(*learned)]
    assert same == [k == 2 for k in range(10)]


def test_every_row_is_test_and_by_a_model_that_has_not_seen_it(tmp_path):
    path = warm_up(tmp_path, 0, lambda u: 0.15 * (u**3 - 0.6 * u), odr_hz=1 / 15)
    result = close([path], tmp_path / "out")
    rows = pq.read_table(tmp_path / "out" / "corrected.parquet").to_pandas()
    assert set(rows["split"]) == {"test"} and len(rows) == 240
    left = (read_recording(path).columns["gx"] - rows["bias_after_gx"]).to_numpy() / 1.31
    blocks = left.reshape(-1, 2).mean(axis=1)
    assert np.sqrt((blocks**2).mean()) == pytest.approx(result["after_mdps"][0], rel=1e-3)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_rests_that_are_few_and_far_between_teach_no_bend(seed):
    (session,) = simulate(seed, [("temperature-cubic", 20.0)], sessions=1, bare=True).sessions
    rests = np.arange(session.blocks) % 8 < 2
    session.rate_dps[~rests] = np.nan
    session.weight[~rests] = 0.0
    found = analyse([session]).selection
    assert any("too few rests" in reason for _, reason in found.refused)


def test_a_recording_without_temperature_shows_no_curve_over_it():
    (session,) = simulate(3, [("time-drift", 5.0)], sessions=1, bare=True).sessions
    blind = replace(session, sources={k: v for k, v in session.sources.items() if k != "temp"})
    found = select([blind], on_pieces=PiecesByLine(blind)).found
    assert all("temp" not in f.candidate.sources for f in found)
