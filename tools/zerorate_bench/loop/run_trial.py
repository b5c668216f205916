"""One device looked at: simulated, closed, and judged by a session that no fit has seen."""

import time
from dataclasses import dataclass, field, replace

import numpy as np
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import predicted
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.search.select import select, straight_line
from zerorate_tools.loop.search.steps_first import remove_steps
from zerorate_tools.loop.verify.judge import residuals, rms_dps, scored
from zerorate_tools.loop.verify.prune_by_holdout import prune_by_holdout

from .added_effects import CURVE_OF, PRANDTL_ISHLINSKII_TOLD
from .devices import CORNERS, CURVE, TOLD, Device
from .simulated import cut_into_sessions, simulate, simulate_corners


@dataclass
class Outcome:
    """What the loop said of a device. before, after: held-out RMS over that of the noise alone;
    unpruned: after, had the held-out session taken nothing out again; withdrawn: what it took;
    in_motion_mdps: error while it moves, of devices whose row asks for it; within: whether what an
    effect follows stays, in the held-out session, within what the others show of it; told: of each
    effect found, the chance of each group that it may be."""

    device: Device
    found: list[str] = field(default_factory=list)
    sources: list[list[str]] = field(default_factory=list)
    rivals: list[list[str]] = field(default_factory=list)
    confidence: list[str] = field(default_factory=list)
    events: int = 0
    excess: bool = False
    before: float = 1.0
    after: float = 1.0
    cpu_s: float = 0.0
    in_motion_mdps: float | None = None
    unpruned: float = 1.0
    withdrawn: list[str] = field(default_factory=list)
    within: bool = True
    told: list[dict[str, float]] = field(default_factory=list)

    def named(self, effect: str) -> bool:
        """Whether an effect is among the named, or among what is confounded with one of them."""
        everything = [*self.found, *(r for rivals in self.rivals for r in rivals)]
        return any(effect in n.split("+") for n in everything)

    def tied_to(self, channels: tuple[str, ...]) -> bool:
        """Whether an effect found follows exactly these channels."""
        return any(set(s) == set(channels) for s in self.sources)

    @property
    def confirmed(self) -> bool:
        """Whether any effect is said to be sure."""
        return "confirmed" in self.confidence

    @property
    def worse(self) -> bool:
        """Whether the error held out has grown by more than 2 %."""
        return self.after > 1.02 * self.before


def run_trial(device: Device) -> Outcome:
    """Simulate a device, run the loop on it and judge by its last session."""
    began = time.process_time()
    if device.row == TOLD:
        return _told(device)
    if device.row == CORNERS:
        return _corners(device)
    if device.real:
        sessions, noise = cut_into_sessions(device.real, device.seed)
    else:
        made = simulate(
            device.seed, list(device.effects), device.sessions, 1.0, device.noise, device.hidden
        )
        sessions, noise = made.sessions, made.noise_dps
    outcome = judged(device, sessions, noise[-1])
    outcome.cpu_s = time.process_time() - began
    return outcome


def _corners(device: Device) -> Outcome:
    """The steps that are taken out of a recording before anything else is looked for."""
    [session] = remove_steps(simulate_corners(device.seed).sessions)
    return Outcome(device, events=len(session.steps))


def _told(device: Device) -> Outcome:
    """What a model of the loop itself leaves, which takes it to start where the temperature does:
    found where some axis of the last session is nearer with it, and it corrects those alone."""
    (_, size), n = device.effects[0], device.sessions
    made = simulate(device.seed, device.effects, n)
    left = simulate(device.seed, [(PRANDTL_ISHLINSKII_TOLD, size)], n)
    before, after = _left_by_line(made.sessions), _left_by_line(left.sessions)
    unit = _noise_rms(made.sessions[-1], made.noise_dps[-1])
    named = ["thermal-hysteresis"] if (after < before).any() else []
    straight, least, whole = (_rms(e) / unit for e in (before, np.minimum(before, after), after))
    taken = [] if named else ["thermal-hysteresis"]
    return Outcome(device, named, before=straight, after=least, unpruned=whole, withdrawn=taken)


def _rms(each: np.ndarray) -> float:
    return float(np.sqrt((each**2).mean()))


def _left_by_line(sessions: list[Session]) -> np.ndarray:
    """(3,) RMS of the last session beside the line over temperature of the others."""
    line = straight_line(sessions[:-1])
    of_line = predicted(line, ordinary(line, sessions[:-1]), sessions[-1])
    return rms_dps([scored(sessions[-1], of_line)[0]])


def _noise_rms(session: Session, noise_dps: np.ndarray) -> float:
    """Of the blocks scored, over the axes."""
    noise, _ = scored(replace(session, rate_dps=noise_dps), np.zeros(noise_dps.shape))
    return float(np.sqrt(np.nanmean(noise**2)))


def judged(device: Device, sessions: list[Session], noise_dps: np.ndarray) -> Outcome:
    """What the loop says of sessions. noise_dps: (n, 3) of the last one, nothing else in it."""
    sessions = remove_steps(sessions)
    alone = PiecesByLine(sessions[0]) if len(sessions) == 2 else None
    every = select(sessions[:-1], 0, alone, judged_again=True)
    selection, verdict = prune_by_holdout(every, sessions[-1:])
    unpruned = rms_dps([left for left, _ in residuals(every, sessions[-1:])])
    unit = _noise_rms(sessions[-1], noise_dps)
    found = selection.found
    return Outcome(
        device,
        [f.candidate.label for f in found],
        [f.candidate.sources for f in found],
        [f.confounded_with for f in found],
        [verdict.confidence(i) for i in range(len(found))],
        sum(len(s.steps) for s in sessions[:-1]),
        bool(verdict.residual_test.left),
        float(verdict.before_rms / unit),
        float(verdict.after_rms / unit),
        unpruned=_rms(unpruned) / unit,
        withdrawn=[name for name, _ in selection.withdrawn],
        within=device.row != CURVE or _is_within(sessions, CURVE_OF),
        told=[f.probabilities for f in found],
    )


def _is_within(sessions: list[Session], name: str) -> bool:
    """Whether the last session's blocks stay within those of the others."""
    *some, last = [s.block_mean(s.source(name)) for s in sessions]
    seen = np.concatenate(some)
    return bool(seen.min() <= last.min() and last.max() <= seen.max())
