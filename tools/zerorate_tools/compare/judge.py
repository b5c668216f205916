"""How wrong each way to the bias would have been when the device next lay still, and in motion.

In motion: what a matrix of scale factors and axes would win, by the logs alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm, t
from threadpoolctl import threadpool_limits

from ..errors import BadRecording, InFile
from ..installed import beside
from ..loop.motion.by_windows import GRAVITY, UNIT, by_windows, seen_in_words
from ..loop.motion.moving import moving_of
from ..loop.read.gate import CannotClose
from ..loop.read.still import runs, still_ticks, ticks_with_spread
from ..loop.read.ticks import Ticks
from ..numbers import counted
from ..peers import Given, firmware, fusion, given, vqf_default
from ..recordings import read_recording

_LEAST_TICKS = 3
#: A long rest counts as several: a device that never moves is compared, too.
_MOST_S = 60.0
NOTHING, FIRST_REST, FRESH, TAUGHT = (
    "no correction",
    "mean of the first rest",
    "zerorate",
    "zerorate, with the earlier logs",
)
_OPTIONAL = {"vqf": vqf_default, "imufusion": fusion}
#: What a way knows is taken this long before a rest, so that it has seen nothing of it.
_LEAD_S = 3.0
_SIGMAS = 2.0
#: Of an axis at a rest: the Earth turns by 15 degrees an hour, nobody knows about which axis.
_EARTH_DPS = 15.04 / 3600 / 3**0.5
_ENOUGH = 5


@dataclass(frozen=True)
class Rest:
    """Samples [first, last) at rest, from start_s on. bias_dps: their mean (3,), sigma_dps: its
    standard error (3,); down: unit vector of gravity, None without an accelerometer.
    """

    first: int
    last: int
    start_s: float
    bias_dps: NDArray[np.float64]
    sigma_dps: NDArray[np.float64]
    down: NDArray[np.float64] | None


def rests_of(ticks: Ticks, one: Given) -> list[Rest]:
    """Every rest of three ticks and more, those of over a minute in pieces."""
    still = still_ticks(ticks, edges=False) & (ticks.count > 0)
    t_us = one.recording.columns["t_us"]
    found = []
    for start, end in runs(still):
        pieces = max(1, round((end - start) * ticks.tick_s / _MOST_S))
        cuts = np.linspace(start, end, pieces + 1).astype(int)
        for first, last in zip(cuts[:-1], cuts[1:]):
            if last - first >= _LEAST_TICKS:
                at = ticks.start_us + np.array([first, last]) * ticks.tick_s * 1e6
                found.append(_rest(one, ticks.rate[first:last], *np.searchsorted(t_us, at)))
    return found


def _rest(one: Given, means: NDArray[np.float64], first: int, last: int) -> Rest:
    bias = one.rate_dps[first:last].mean(axis=0)
    sigma = standard_error(means)
    down = None
    if one.accel_g is not None:
        down = one.accel_g[first:last].mean(axis=0)
        down = down / (np.linalg.norm(down) or 1.0)
    t_us = one.recording.columns["t_us"]
    return Rest(first, last, float(t_us[first] - t_us[0]) / 1e6, bias, sigma, down)


def standard_error(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """(axes,) of the mean of (n, axes) means, wide enough that the truth lies within two of them as
    often as within two sigma: a few means hardly know their own scatter (Student's t)."""
    n = len(means)
    few = t.isf(norm.sf(_SIGMAS), n - 1) / _SIGMAS
    error: NDArray[np.float64] = few * np.nanstd(means, axis=0, ddof=1) / np.sqrt(n)
    return error


@dataclass(frozen=True)
class Verdict:
    """Of one way against another: "better", "worse" or "no difference that this log can show".

    times: degrees of heading that the other loses for each that the way does.
    """

    word: str
    times: float


@dataclass(frozen=True)
class Compared:
    """names: of the logs; rests: the later rests of all logs, with the log's place in names;
    error_dps: way -> (rests, 3), what it would have left on the rate; left_out: way -> why.
    """

    names: list[str]
    rests: list[tuple[int, Rest]]
    error_dps: dict[str, NDArray[np.float64]]
    left_out: dict[str, str]

    def rms_dps(self, way: str) -> float:
        """RMS over axes and later rests."""
        return float(np.sqrt(np.mean(np.square(self.error_dps[way]))))

    def heading_deg_per_min(self, way: str) -> float:
        """RMS over later rests of the error about the vertical, in degrees a minute.

        Without an accelerometer nobody knows the vertical: the worst axis is taken.
        """
        return 60 * float(np.sqrt(np.mean(np.square(self.about_vertical_dps(way)))))

    def about_vertical_dps(self, way: str) -> NDArray[np.float64]:
        """(rests,) the error about the vertical at each later rest."""
        error = self.error_dps[way]
        if self.rests[0][1].down is None:
            worst = int(np.square(error).mean(axis=0).argmax())
            return error[:, worst]
        return np.array([row @ rest.down for row, (_, rest) in zip(error, self.rests)])

    def verdict(self, way: str, against: str) -> Verdict:
        """Who is better, where the rests tell it beyond twice their own uncertainty."""
        mine, theirs = self.error_dps[way], self.error_dps[against]
        gain = np.square(theirs).sum(axis=1) - np.square(mine).sum(axis=1)
        sigma = np.hypot([rest.sigma_dps for _, rest in self.rests], _EARTH_DPS)
        # a rest's mean is uncertain itself, and both errors share it
        variance = 4 * np.square(sigma * (theirs - mine)).sum(axis=1)
        doubt = np.sqrt(variance.sum()) / len(gain)
        if len(gain) >= _ENOUGH:
            doubt = max(doubt, gain.std(ddof=1) / np.sqrt(len(gain)))
        apart = abs(self.rms_dps(way) - self.rms_dps(against))
        sure = abs(gain.mean()) > _SIGMAS * doubt and apart > _EARTH_DPS
        word = "no difference that this log can show"
        if sure:
            word = "better" if gain.mean() > 0 else "worse"
        least = 1e-9  # a rest may find a way right to the last bit
        mine_lost, theirs_lost = self.heading_deg_per_min(way), self.heading_deg_per_min(against)
        times = max(theirs_lost, least) / max(mine_lost, least)
        return Verdict(word, times)

    def figures(self) -> dict[str, object]:
        ways = {
            way: {
                "error_dps": self.rms_dps(way),
                "heading_deg_per_min": self.heading_deg_per_min(way),
                "against_first_rest": self.verdict(way, FIRST_REST).word,
            }
            for way in self.error_dps
        }
        return {
            **{"logs": self.names, "later_rests": len(self.rests), "ways": ways},
            **{"left_out": self.left_out, "headline": self.headline()},
        }

    @property
    def ours(self) -> str:
        """The way of zerorate that the headline is about."""
        return TAUGHT if TAUGHT in self.error_dps else FRESH

    def headline(self) -> str:
        """The one sentence: how wrong the mean at boot, how wrong zerorate."""
        verdict = self.verdict(self.ours, FIRST_REST)
        times = verdict.times if verdict.word == "better" else 1 / verdict.times
        how = f"{times:.1f} times {verdict.word}" if times > 1 else f"in deg/s {verdict.word}"
        than = f"{how} than the mean of the first rest"
        words = than if verdict.word in ("better", "worse") else verdict.word
        rests = counted(len(self.rests), "later rest")
        mine, theirs = map(self.heading_deg_per_min, (self.ours, FIRST_REST))
        return (
            f"{self.ours}: {words}. At {rests} it would have lost "
            f"{mine:.2f} deg of heading a minute, and the mean {theirs:.2f}."
        )


class TooFewRests(InFile):
    """A recording that never lay still twice."""


# The matrices are small: more threads wait for each other longer than one works.
@threadpool_limits.wrap(limits=1, user_api="blas")
def compare(
    logs: Sequence[str | Path], advance: Callable[[float], None] = lambda n: None
) -> Compared:
    """Compare on `logs`, power-ons of one device in their order, each read whole.

    advance: called with 1 after each log and each way. Raises ZerorateError (BadRecording; no log
    with two rests).
    """
    paths = [Path(log) for log in logs]
    sessions, rests = [], []
    seen: dict[str, Path] = {}
    for path in paths:
        ticks = ticks_with_spread(path)
        for key, problem, do in (
            (ticks.digest, "holds the same samples as", "name each recording once"),
            (ticks.name, "has the name of", "rename one"),
        ):
            first = seen.setdefault(key, path)
            if first is not path:
                raise BadRecording(path, f"{problem} {first}", do=do)
        sessions.append(given(read_recording(path, keep_gaps=True)))
        rests.append(rests_of(ticks, sessions[-1]))
        advance(1)
    later = [(number, rest) for number, found in enumerate(rests) for rest in found[1:]]
    if not later:
        do = "leave the device at rest for some seconds, move it, and leave it at rest again"
        raise TooFewRests(paths[0], "never still twice, so there is nothing to compare", do=do)
    errors = {
        NOTHING: np.array([rest.bias_dps for _, rest in later]),
        FIRST_REST: np.array([rest.bias_dps - rests[n][0].bias_dps for n, rest in later]),
    }
    left_out = {}
    for name, peer in _OPTIONAL.items():
        if find_spec(name) is None:
            left_out[name] = f"not installed: {beside(name)}"
            continue
        errors[name] = _errors([peer([one])[0] for one in sessions], sessions, later)
        advance(1)
    errors[FRESH] = _errors([firmware()([one])[0] for one in sessions], sessions, later)
    if len(sessions) > 1:
        errors[TAUGHT] = _errors(firmware()(sessions), sessions, later)
    advance(1)
    for way in [way for way, error in errors.items() if np.isnan(error).any()]:
        del errors[way]
        left_out[way] = "needs an accelerometer"
    return Compared([path.name for path in paths], later, errors, left_out)


def _errors(
    biases: Sequence[NDArray[np.float64]],
    sessions: Sequence[Given],
    later: Sequence[tuple[int, Rest]],
) -> NDArray[np.float64]:
    """(rests, 3): the rest's bias less what the way knew shortly before it."""
    rows = []
    for number, rest in later:
        t_us = sessions[number].recording.columns["t_us"]
        known = max(0, int(np.searchsorted(t_us, t_us[rest.first] - _LEAD_S * 1e6)) - 1)
        rows.append(rest.bias_dps - biases[number][known])
    return np.array(rows)


HEAD = "in motion, deg/min"
WITHOUT, WITH = "without the matrix", "with the matrix"


@dataclass(frozen=True)
class Won:
    """turned: degrees a minute of windows left out, without and with; unit: what turns them;
    heading: the same of heading, against an attitude that is given, else as the matrix turns it;
    deployed: whether `close` would deploy it; refused: why nothing is told, "" where it is; notes:
    of what was left out, a sentence each.
    """

    turned: tuple[float, float] = (float("nan"), float("nan"))
    unit: str = UNIT[GRAVITY]
    heading: tuple[float, float] = (float("nan"), float("nan"))
    deployed: bool = False
    refused: str = ""
    notes: Sequence[str] = ()

    def sentence(self) -> str:
        if self.refused:
            return f"In motion: {self.refused}."
        return " ".join([self._told(), *(f"Note: {note}." for note in self.notes)])

    def _told(self) -> str:
        before, after = self.turned
        if not self.deployed:
            return f"In motion no matrix would lower the error: {seen_in_words(before, self.unit)}."
        heading = [f"{h:.2f}" for h in self.heading]
        less = f"{heading[1]} of {heading[0]} degrees a minute of heading, and "
        return (
            "In motion the matrix of `zerorate close` would leave "
            f"{less if heading[0] != heading[1] else ''}{after:.2f} of {before:.2f} {self.unit} "
            "on windows left out."
        )

    def rows(self) -> list[tuple[str, str, str, str]]:
        """A head, and a row each, without and with: its name, what turns windows, heading, both in
        degrees a minute."""
        if self.refused:
            return []
        names = (WITHOUT, WITH) if self.deployed else (WITHOUT,)
        headings = [f"{h:.2f}" if self.deployed else "" for h in self.heading]
        head = (HEAD, self.unit.rpartition(" ")[2], "heading", "")
        return [head, *((n, f"{t:.2f}", h, "") for n, t, h in zip(names, self.turned, headings))]


def matrix_of(logs: Sequence[str | Path]) -> Won | None:
    """What the matrix of the logs' device would win; None where too little of them moves.

    Raises BadRecording.
    """
    moving = [m for log in logs if (m := moving_of(log)) is not None]
    try:
        shown = by_windows(moving, [])
    except CannotClose as problem:
        return Won(refused=str(problem))
    if shown is None:
        railed = "; ".join(m.railed for m in moving if m.railed)
        return Won(refused=railed) if railed else None
    heading = shown.heading or shown.lost
    turned = shown.before, shown.after
    return Won(turned, shown.unit, heading, shown.found, notes=shown.notes)
