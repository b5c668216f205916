"""Accuracy beside the peers, all on the same samples in one run."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import rms_mdps
from zerorate_tools.importers import read_foreign
from zerorate_tools.loop.read.still import runs
from zerorate_tools.peers import Given, Peer, first_seconds, given
from zerorate_tools.recordings import Recording
from zerorate_tools.simulate import simulate_sessions

from .limits import ACCURACY, SESSION_2, verdicts
from .peers import HOW, OURS, PEERS, uncorrected, within_two_sigma
from .public_data import data_folder, recordings, told_of
from .tables import machine, machine_line, measured, number, table

SCENARIOS = ("warm-up-a", "warm-up-b", "warm-up-c")
SEEDS = (1, 2, 3, 4, 5)
FIRST_S = 15.0
LATER_S = 60.0
TOLD = "floor: knows the rests, the curve and its random walk"
AT_REST = "floor: knows the curve and the spectra, rests all day, looks ahead"
DAY = ("mean of the first 10 s", "imufusion", "vqf, clip 25 dps", *OURS)

Figures = dict[str, dict[str, float]]
_MADE = """\
Made by `zerorate bench accuracy` in one run, with the same samples for everyone. Real recordings
are read from `ZERORATE_DATA`, or from `shared/data` beside the checkout. Others may report
another figure for the same filter and scenario.
"""
_SESSION_2 = """\
Session 1 warms from 20 to 45 degC in 40 minutes. Then the power is cut. Session 2 warms from 17
to 44 degC in 20 minutes. A has a bias of 0.8 dps. B has 6 dps and a curve over temperature. C also
has drift and a thermometer that lags. `zerorate` has default settings and no effect model. It loads
what it learned in session 1, so its first {first:.0f} s are from the store.
"""
_DAY = """\
All begin with nothing learned. Waiting a second for the first rest raises the daily RMS. The last
two rows are floors, not estimators. The first is a Kalman filter that knows the true rests, the
true curve over temperature and the best random walk for this day. The second is a Wiener smoother
of a device that rests all day. It knows the curve and the spectra of bias and noise, and looks
ahead. It leaves flicker noise that the white noise hides. Nothing gets below it on this part.
"""
_HONESTY = """\
The share of the last power-on in which the truth lies within two `quality_lsb`, with all sources
on. 95 % would be exact. The firmware learns one sigma from the part itself: from its flicker
noise, its walk, and how well its power-ons repeat
([learning.md](learning.md#reported-uncertainty)).
"""
_REAL = """\
RMS over axes and over means of 20 s. The true rate is zero, but for Earth's 4 mdps. Blocks in
which the sensor was handled are left out. The first figure is of the whole recording, the second
without its first 20 s (8 readings).
"""
BLOCK_S = 20.0
_START_READINGS = 8
_HANDLED = 3.0


def sessions_of(name: str, seed: int) -> tuple[list[Given], list[NDArray[np.float64]]]:
    """A bundled scenario's sessions as given to peers, and each one's true bias (n, 3), dps."""
    sessions, truths = [], []
    for recording, truth in simulate_sessions(name, seed=seed):
        sessions.append(given(recording, truth.still))
        truths.append(truth.bias_lsb / recording.scales.gyro_lsb_per_dps)
    return sessions, truths


def second_power_on(
    name: str,
    peers: Mapping[str, Peer] = PEERS,
    seeds: Sequence[int] = SEEDS,
) -> Figures:
    """Session 2 of a scenario: peer -> {"all": RMS, "first": RMS of the first 15 s}, mdps.

    Each is the median over `seeds`.
    """
    every: dict[str, list[tuple[float, float]]] = {peer: [] for peer in peers}
    for seed in measured(seeds):
        sessions, truths = sessions_of(name, seed)
        for peer, bias in peers.items():
            error = bias(sessions)[-1] - truths[-1]
            first = round(FIRST_S * sessions[-1].odr_hz)
            every[peer].append((rms_mdps(error), rms_mdps(error[:first])))
    medians = {peer: np.median(found, axis=0) for peer, found in every.items()}
    return {peer: {"all": float(m[0]), "first": float(m[1])} for peer, m in medians.items()}


def honesty(name: str, seeds: Sequence[int] = SEEDS) -> dict[str, float]:
    """Shares of a scenario's last session in which the truth lies within two sigma, all seeds."""
    every = []
    for seed in seeds:
        sessions, truths = sessions_of(name, seed)
        every.append(within_two_sigma(sessions, truths[-1], FIRST_S))
    whole, first = np.mean(every, axis=0)
    return {"all": float(whole), "first": float(first)}


def day() -> Figures:
    """The simulated day: peer -> {"all": RMS over all samples, "later": after a minute}, mdps."""
    sessions, truths = sessions_of("day", 1)
    later = round(LATER_S * sessions[0].odr_hz)
    found = {}
    for peer in measured(DAY):
        error = PEERS[peer](sessions)[0] - truths[0]
        found[peer] = {"all": rms_mdps(error), "later": rms_mdps(error[later:])}
    error, least = floors()
    found[TOLD] = {"all": rms_mdps(error), "later": rms_mdps(error[later:])}
    return found | {AT_REST: {"all": least * 1000, "later": least * 1000}}


def run(quick: bool) -> dict[str, Any]:
    """All figures, mdps: day_rms_mdps, session_2_rms_mdps, real_rms_mdps (None without data)."""
    folder, seeds = data_folder(), SEEDS[:1] if quick else SEEDS
    found: dict[str, Any] = {
        "machine": machine(),
        "seeds": list(seeds),
        "day_rms_mdps": day(),
        "session_2_rms_mdps": {name: second_power_on(name, seeds=seeds) for name in SCENARIOS},
        "within_two_sigma": {
            **{name: honesty(name, seeds) for name in SCENARIOS},
            "day": honesty("day", seeds[:1]),
        },
        "real_rms_mdps": real(folder) if folder else None,
    }
    found["limits"] = verdicts(found, ACCURACY)
    return found


def in_markdown(found: Mapping[str, Any]) -> str:
    return "\n".join(["# Accuracy\n", _MADE, machine_line(found["machine"]), *_sections(found)])


def _sections(found: Mapping[str, Any]) -> Iterator[str]:
    """The tables of session 2, of the day and of the real recordings, one below the other."""
    yield f"## Session 2, after a warm-up and a power cut; all, and the first {FIRST_S:.0f} s\n"
    yield _SESSION_2.format(first=FIRST_S)
    seeds = len(found["seeds"])
    yield "One seed.\n" if seeds == 1 else f"Median of {seeds} seeds.\n"
    yield _second_power_on(found["session_2_rms_mdps"])
    yield "## A simulated day: half of it moving, 25 degC of change\n"
    yield _DAY
    rows = [[p, number(f["all"]), number(f["later"])] for p, f in found["day_rms_mdps"].items()]
    yield table(["RMS bias error, mdps", "all day", "after the first minute"], rows)
    yield "## Is one sigma one sigma?\n"
    yield _HONESTY
    shares = found["within_two_sigma"].items()
    rows = [[name, *(f"{100 * f[part]:.0f} %" for part in ("all", "first"))] for name, f in shares]
    yield table(["truth within two sigma", "all", f"first {FIRST_S:.0f} s"], rows)
    yield "## Real recordings at rest\n"
    if found["real_rms_mdps"] is None:
        yield "Left out: no real recordings here; ZERORATE_DATA names their folder.\n"
        return
    rows = [
        [name, *(f"{number(f['all'])} / {number(f['later'])}" for f in columns.values())]
        for name, columns in found["real_rms_mdps"].items()
    ]
    yield _REAL
    yield table(["mdps", *COLUMNS], rows)


def _second_power_on(figures: Mapping[str, Mapping[str, Any]]) -> str:
    header = ["RMS bias error, mdps", "how"]
    header += [f"{name[-1].upper()} {part}" for part in ("all", "first 15 s") for name in figures]
    rows: list[list[object]] = []
    for peer, how in HOW.items():
        parts = [figures[name][peer][part] for part in ("all", "first") for name in figures]
        rows.append([peer, how, *map(number, parts)])
    bounds = [f"{bound:g}" for part in SESSION_2.values() for bound in part.values()]
    return table(header, [*rows, ["zerorate must be at most", "", *bounds]])


COLUMNS: dict[str, Peer] = {
    "uncorrected": uncorrected,
    "mean of the first 10 s": first_seconds,
    **OURS,
}


def rest_errors(recording: Recording, peer: Peer) -> dict[str, float]:
    """RMS over axes and blocks of rest, mdps: "all", and "later" without the start."""
    still = recording.columns.get("moving")
    one = given(recording, None if still is None else still == 0)
    residual = one.rate_dps - peer([one])[0]
    start = max(BLOCK_S * one.odr_hz, _START_READINGS)
    blocks = [(first, residual[first:end]) for first, end in _rests(one)]
    later = [block.mean(axis=0) for first, block in blocks if first >= start]
    every = [block.mean(axis=0) for _, block in blocks]
    return {"all": rms_mdps(np.array(every)), "later": rms_mdps(np.array(later))}


def _rests(one: Given) -> Iterator[tuple[int, int]]:
    """First and end of each block at rest; those with far more noise than most are handled ones."""
    size = max(1, round(BLOCK_S * one.odr_hz))
    blocks = []
    for start, end in runs(one.still):
        cuts = np.linspace(start, end, max(1, (end - start) // size) + 1).astype(int)
        blocks += list(zip(cuts[:-1], cuts[1:]))
    spreads = np.array([one.rate_dps[first:end].std(axis=0).max() for first, end in blocks])
    for block, spread in zip(blocks, spreads):
        if spread <= _HANDLED * np.median(spreads):
            yield block


def real(folder: Path) -> dict[str, dict[str, dict[str, float]]]:
    """Each recording of the data folder: name -> column -> `rest_errors`."""
    found = {}
    for path in measured(recordings(folder)):
        name = f"{path.parent.name}/{path.name.split('.')[0]}"
        recording, _ = read_foreign(path, **told_of(path))
        found[name] = {column: rest_errors(recording, peer) for column, peer in COLUMNS.items()}
    return found


Array = NDArray[np.float64]
#: Standard deviation of a second's walk, dps: of 0.1 to 1 mdps the best on the day.
_WALK_DPS_TOLD = 0.0004
_DEGREE = 3
_BANDS = 60


def floors() -> tuple[Array, float]:
    """(n, 3) error of the Kalman filter, dps, over the day, each sample; and the RMS that the
    Wiener smoother leaves, dps.

    Wiener, Extrapolation, Interpolation, and Smoothing of Stationary Time Series (1949), ch. III:
    at each frequency the product of both powers over their sum.
    """
    recording, truth = list(simulate_sessions("day", seed=1))[-1]
    hz, true_dps = (
        round(recording.scales.odr_hz),
        truth.bias_lsb / recording.scales.gyro_lsb_per_dps,
    )
    curve = np.column_stack([_curve(truth.temp_degc, axis) for axis in true_dps.T])
    rate_dps, wander = recording.gyro_dps() - curve, true_dps - curve
    found, left, still = (_seconds(v, hz) for v in (rate_dps, wander, truth.still[:, None]))
    rests = still[:, 0] == 1
    followed = _followed(found, rests, (found - left)[rests].std(axis=0))
    noise_power = np.var((rate_dps - wander)[truth.still], axis=0)
    power = np.array([_smooth(np.abs(np.fft.rfft(axis)) ** 2 / len(axis)) for axis in wander.T])
    least = (power.T * noise_power / (power.T + noise_power)).T.mean(axis=1)
    error = np.repeat(followed, hz, axis=0) - wander[: len(followed) * hz]
    return error, float(np.sqrt(np.mean(least)))


def _smooth(power: Array) -> Array:
    """A periodogram's mean in bands that grow: a single line of it is chance, not spectrum."""
    edges = np.unique(np.geomspace(1, len(power), _BANDS).astype(int))
    sums = np.add.reduceat(power, edges[:-1])
    return np.concatenate([power[:1], np.repeat(sums / np.diff(edges), np.diff(edges))])


def _curve(temp_degc: Array, bias_dps: Array) -> Array:
    return np.asarray(np.polyval(np.polyfit(temp_degc[::50], bias_dps[::50], _DEGREE), temp_degc))


def _seconds(values: Array, hz: int) -> Array:
    n = len(values) // hz
    return values[: n * hz].reshape(n, hz, -1).mean(axis=1)


def _followed(found: Array, still: NDArray[np.bool_], noise: Array) -> Array:
    level, variance, out = np.zeros(3), np.ones(3), np.empty_like(found)
    for i in range(len(found)):
        variance = variance + _WALK_DPS_TOLD**2
        if still[i]:
            gain = variance / (variance + noise**2)
            level, variance = level + gain * (found[i] - level), (1 - gain) * variance
        out[i] = level
    return out
