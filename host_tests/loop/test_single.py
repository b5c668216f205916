"""One recording alone: an effect must gain on what the firmware learns, on pieces left out."""

from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close, load
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.fit.line import less_slope
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.search.catalogue import candidates
from zerorate_tools.loop.search.curve import ByPieces, powers, smooth_curve
from zerorate_tools.loop.search.examine import cancels
from zerorate_tools.loop.search.hysteresis import is_like_hysteresis
from zerorate_tools.loop.search.select import Search, select, straight_line
from zerorate_tools.loop.verify.run_kernels import run_and_prune
from zerorate_tools.recordings import Recording, Scales, read_recording, write_recording

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


@pytest.mark.parametrize(
    ("bend_dps", "odr_hz", "most"), [(0.02, 1.0, 1), (0.02, 4.0, 1), (0.0, 1.0, 0)]
)
def test_what_the_firmware_follows_by_itself_is_not_made_worse(tmp_path, bend_dps, odr_hz, most):
    path = warm_up(tmp_path, 0, lambda u: bend_dps * u**2, odr_hz)
    told, _ = run_and_prune(load([path]), [path], tmp_path / "corrected.parquet")
    assert len(told.selection.found) <= most
    assert told.judgement.after_rms <= (WORSE if most else 1.0) * told.judgement.before_rms


def by_pieces(search):
    own = search.regression, search.line, search.pool, search.on_pieces
    (found,) = ByPieces(*own, taken=0).look([])
    return found


def test_a_kink_is_no_smooth_curve_and_is_followed_no_further_than_it_was_seen():
    session = simulate(3, [("temperature-kink", 20.0)], sessions=1, bare=True).sessions[0]
    search = Search([session], on_pieces=PiecesByLine(session))
    kink = by_pieces(search).candidate
    assert kink.kind == "temperature-kink"
    [term], last = kink.terms, session.sources["temp"].max()
    assert last < term.hi <= 2 * last - term.centre - term.knot + 1e-9


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
    assert pieces(*asked).sum() > 0
    assert (pieces.by_passes()(*asked).sum() > 0) == is_curve


def test_a_cubic_over_few_rests_is_halved_by_models_that_have_not_seen_the_rows(tmp_path):
    path = warm_up(tmp_path, 0, lambda u: 0.15 * (u**3 - 0.6 * u), odr_hz=1 / 15)
    result = close([path], tmp_path / "out")
    assert np.linalg.norm(result["after_mdps"]) < 0.5 * np.linalg.norm(result["before_mdps"])
    rows = pq.read_table(tmp_path / "out" / "corrected.parquet").to_pandas()
    assert set(rows["split"]) == {"test"} and len(rows) == 240
    left = (read_recording(path).columns["gx"] - rows["bias_after_gx"]).to_numpy() / 1.31
    blocks = left.reshape(-1, 2).mean(axis=1)
    assert np.sqrt((blocks**2).mean()) == pytest.approx(result["after_mdps"][0], rel=1e-3)


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_rests_that_are_few_and_far_between_teach_no_bend():
    (session,) = simulate(0, [("temperature-cubic", 20.0)], sessions=1, bare=True).sessions
    rests = np.arange(session.blocks) % 8 < 2
    session.rate_dps[~rests] = np.nan
    session.weight[~rests] = 0.0
    found = analyse([session]).selection
    assert found.alone and not found.judged_again
    assert any("too few rests" in reason for _, reason in found.refused)


@pytest.mark.parametrize("source", ["temp", "none"])
def test_one_recording_shows_nothing_that_follows_time_alone(source):
    (session,) = simulate(3, [("power-on-transient", 10.0)], sessions=1, bare=True).sessions
    sources = {k: v for k, v in session.sources.items() if k != "temp" or source == "temp"}
    session = replace(session, sources=sources)
    found = select([session], on_pieces=PiecesByLine(session)).found
    assert not {f.candidate.kind for f in found} & {"power-on-transient", "time-drift"}


def test_a_recording_without_temperature_shows_no_curve_over_it():
    (session,) = simulate(3, [("time-drift", 5.0)], sessions=1, bare=True).sessions
    blind = replace(session, sources={k: v for k, v in session.sources.items() if k != "temp"})
    found = select([blind], on_pieces=PiecesByLine(blind)).found
    assert all("temp" not in f.candidate.sources for f in found)


@pytest.fixture(scope="module")
def lagging():
    (session,) = simulate(5, [("thermal-lag", 20.0)], sessions=1, bare=True).sessions
    return Search([session])


def test_a_curve_follows_what_no_cubic_does():
    """Up and down twice over the range of temperature."""
    (session,) = simulate(5, sessions=1, bare=True).sessions
    temp = session.block_mean(session.sources["temp"])
    share = (temp - temp.min()) / np.ptp(temp)
    wave = 0.02 * np.sin(4 * np.pi * share)
    session = replace(session, rate_dps=session.rate_dps + wave[:, None])
    by_line, line, pool = PiecesByLine(session), straight_line([session]), candidates([session])
    (found,) = select([session], on_pieces=by_line).found
    assert found.candidate.kind == "temperature-curve"
    assert less_slope(line, found.candidate.terms) == (), "it has a slope of its own"
    left = [np.nanstd(by_line.residual(line, t)) for t in (powers(pool), found.candidate.terms)]
    assert left[1] < 0.7 * left[0]


def test_a_lag_is_no_curve_over_temperature(lagging):
    session = lagging.regression.sessions[0]
    (found,) = select([session], on_pieces=PiecesByLine(session)).found
    assert found.candidate.kind == "thermal-lag"
    assert not cancels([session], lagging.line, found.candidate.terms)


def test_a_lag_is_none_where_a_hysteresis_predicts_as_well(lagging):
    (session,) = simulate(5, [("thermal-hysteresis", 20.0)], sessions=1, bare=True).sessions
    for search, alike in ((Search([session]), True), (lagging, False)):
        lag = next(c for c in search.pool if c.kind == "thermal-lag" and c.terms[0].lag_s > 100.0)
        own = search.regression.sessions
        assert is_like_hysteresis(search.line, (), lag, search.pool, own) == alike
