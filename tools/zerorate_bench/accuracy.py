"""Accuracy beside the peers, all on the same samples in one run."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import rms_mdps
from zerorate_tools.peers import Given, Peer, given
from zerorate_tools.peers.online import within_two_sigma
from zerorate_tools.simulate import simulate_sessions

from .bayes import told_everything, told_the_future
from .peers import OURS, PEERS

SCENARIOS = ("warm-up-a", "warm-up-b", "warm-up-c")
SEEDS = (1, 2, 3, 4, 5)
FIRST_S = 15.0
LATER_S = 60.0
TOLD = "told the rests, the curve and its walk"
AT_REST = "told the curve and the spectra, at rest all day, and the future"
DAY = ("mean of the first 10 s", "imufusion", "vqf, clip 25 dps", *OURS)

Figures = dict[str, dict[str, float]]


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
    advance: Callable[[float], None] = lambda n: None,
) -> Figures:
    """Session 2 of a scenario: peer -> {"all": RMS, "first": RMS of the first 15 s}, mdps.

    Each is the median over `seeds`.
    """
    every: dict[str, list[tuple[float, float]]] = {peer: [] for peer in peers}
    for seed in seeds:
        sessions, truths = sessions_of(name, seed)
        for peer, bias in peers.items():
            error = bias(sessions)[-1] - truths[-1]
            first = round(FIRST_S * sessions[-1].odr_hz)
            every[peer].append((rms_mdps(error), rms_mdps(error[:first])))
            advance(1)
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


def day(advance: Callable[[float], None] = lambda n: None) -> Figures:
    """The simulated day: peer -> {"all": RMS over all samples, "later": after a minute}, mdps."""
    sessions, truths = sessions_of("day", 1)
    later = round(LATER_S * sessions[0].odr_hz)
    found = {}
    for peer in DAY:
        error = PEERS[peer](sessions)[0] - truths[0]
        found[peer] = {"all": rms_mdps(error), "later": rms_mdps(error[later:])}
        advance(1)
    error = told_everything("day", 1)
    found[TOLD] = {"all": rms_mdps(error), "later": rms_mdps(error[later:])}
    least = told_the_future("day", 1) * 1000
    found[AT_REST] = {"all": least, "later": least}
    return found
