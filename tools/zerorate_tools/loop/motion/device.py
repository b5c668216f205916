"""One device's matrix from what each of its recordings states, and whether they are of one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import reduce
from itertools import product

import numpy as np
from scipy.special import logsumexp
from scipy.stats import f as fisher

from ..read.gate import CannotClose
from .columns import MATRIX

#: Sizes that a group of entries may have; the last allows what a data sheet does.
SIZES = (3e-4, 1e-3, 3e-3, 1e-2, 3e-2)
#: Axes of two chips on one board, or of a chip set by hand, may be turned by more.
_TURNED = (*SIZES, 1e-1)
#: Scatter of an entry between recordings: none, up to a change of temperature by 50 degrees.
_SCATTER = (0.0, 3e-4, 1e-3, 3e-3)
#: Stands for no scatter where it is divided by.
_NO_SCATTER = 1e-6
#: Sigmas by which heading must be lessened: one recording in forty may be wrong.
_SURE = 2.0


@dataclass
class Shown:
    """What windows say of the nine entries, everything else integrated out: a quadratic form.

    normal: (9, 9); right: (9,); nats gained by entries m are `right m - m normal m / 2`.
    """

    normal: np.ndarray = field(default_factory=lambda: np.zeros((MATRIX, MATRIX)))
    right: np.ndarray = field(default_factory=lambda: np.zeros(MATRIX))

    def __add__(self, other: "Shown") -> "Shown":
        return Shown(self.normal + other.normal, self.right + other.right)

    def gain(self, entries: np.ndarray) -> float:
        """Nats by which the entries (9,) are likelier than none."""
        return float(self.right @ entries - 0.5 * entries @ self.normal @ entries)

    def scattered(self, sigma: float) -> tuple["Shown", float]:
        """What is said of the device where this recording's entries differ from it by sigma, and
        the nats by which that scatter alone is likelier than none."""
        wider = np.eye(MATRIX) + sigma**2 * self.normal
        right = np.linalg.solve(wider, self.right)
        nats = 0.5 * (sigma**2 * self.right @ right - np.linalg.slogdet(wider)[1])
        return Shown(np.linalg.solve(wider, self.normal), right), float(nats)


@dataclass(frozen=True)
class Device:
    """Posterior of the nine entries: mean (9,) and covariance (9, 9); shown: what all recordings
    say together, with the likeliest scatter; nats: by which errors are likelier than none at all;
    cases: the device under each scatter; weight: (c,) of each."""

    entries: np.ndarray
    covariance: np.ndarray
    shown: Shown
    nats: float
    weight: np.ndarray
    cases: Sequence["_Case"]

    def kept(self, headings: Sequence[np.ndarray]) -> np.ndarray:
        """(9, 9) of the entries what is deployed: all that heading does not see, and of the rest
        the largest share, 0 to 1, that surely lessens the heading lost in the recordings seen.
        headings: (9, 9) each, as of `Rows`.

        With d taken out of M, the mean square of heading grows where `d Q M < d Q d / 2`; M is
        each recording's own, told by its windows and by the device's entries.
        """
        pulls = [h @ self.entries for h in headings]
        less, square = np.transpose([c.along(pulls) for c in self.cases])
        mean = self.weight @ less
        sigma = np.sqrt(self.weight @ (square + less**2) - mean**2)
        every = np.sum(headings, axis=0)
        size = max(self.entries @ every @ self.entries, 1e-300)
        share = np.clip(2.0 * (mean - _SURE * sigma) / size, 0.0, 1.0)
        seen = np.linalg.pinv(every, rcond=1e-6, hermitian=True) @ every
        return np.eye(MATRIX) - (1.0 - share) * seen

    def heading_lost(self, headings: Sequence[np.ndarray], deployed: np.ndarray) -> float:
        """Degrees a minute by which the entries, with those deployed (9,) taken out, turn the
        heading, RMS over motion like that of the recordings seen. headings: (9, 9) each."""
        left = self.entries - deployed
        square = self.covariance + np.outer(left, left)
        return 60.0 * float(np.degrees(np.sqrt(np.mean([(h * square).sum() for h in headings]))))


@dataclass(frozen=True)
class _Case:
    """The device under one scatter: what all say, (9,) entries, their covariance and evidence."""

    scatter: float
    statements: Sequence[Shown]
    shown: Shown
    evidence: float
    entries: np.ndarray
    covariance: np.ndarray

    def along(self, pulls: Sequence[np.ndarray]) -> tuple[float, float]:
        """Mean and variance of the sum, over recordings, of pull (9,) times its own entries."""
        tight = np.eye(MATRIX) / max(self.scatter, _NO_SCATTER) ** 2
        mean, variance, common = 0.0, 0.0, np.zeros(MATRIX)
        for one, pull in zip(self.statements, pulls):
            own = np.linalg.solve(one.normal + tight, pull)
            mean += own @ (one.right + tight @ self.entries)
            variance += own @ pull
            common += tight @ own
        return mean, variance + common @ self.covariance @ common


def device_of(statements: Sequence[Shown], large: bool = False) -> Device:
    """The device of which every recording states something. Scale factors, cross-axis
    sensitivities and turns of the axes each have a size of their own. So has the scatter; of one
    recording it is told what it is in that recording. large: sizes are as likely before as they
    are large (uniform in the standard deviation, Gelman 2006), and not all alike."""
    cases = [
        _case(statements, s, large) for s in (_SCATTER if len(statements) > 1 else _SCATTER[:1])
    ]
    evidence = np.array([c.evidence for c in cases])
    nats = float(logsumexp(evidence) - np.log(len(cases)))
    weight = np.exp(evidence - logsumexp(evidence))
    parts = zip(*((c.entries, c.covariance) for c in cases))
    mean, spread = _mixed(weight, *map(np.stack, parts))
    return Device(mean, spread, cases[int(weight.argmax())].shown, nats, weight, cases)


def _mixed(
    weight: np.ndarray, means: np.ndarray, covariances: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Mean (9,) and covariance (9, 9) of a mixture of (k, 9) and (k, 9, 9)."""
    mean = weight @ means
    apart = means - mean
    spread = np.einsum("k,kij->ij", weight, covariances)
    return mean, spread + np.einsum("k,ki,kj->ij", weight, apart, apart)


def _case(statements: Sequence[Shown], sigma: float, large: bool) -> _Case:
    """Under one scatter, averaged over the sizes."""
    parts = [s.scattered(sigma) for s in statements]
    shown = sum((p[0] for p in parts), Shown())
    nats, means, covariances = _posteriors(shown, sum(p[1] for p in parts) + _LIKELY[int(large)])
    evidence = float(logsumexp(nats))
    weight = np.exp(nats - evidence)
    mean, spread = _mixed(weight, means, covariances)
    return _Case(sigma, statements, shown, evidence, mean, spread)


def _posteriors(shown: Shown, nats: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Evidence, mean and covariance of the entries under each of the sizes. nats: (150,) before."""
    inner = np.eye(MATRIX) + _ROOTS @ shown.normal @ _ROOTS
    covariance = _ROOTS @ np.linalg.solve(inner, _ROOTS)
    mean = covariance @ shown.right
    return nats + 0.5 * (mean @ shown.right - np.linalg.slogdet(inner)[1]), mean, covariance


def groups() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(9, 9) projections on scale factors, on cross-axis sensitivities, on turns of the axes."""
    turn = np.arange(MATRIX).reshape(3, 3).T.ravel()
    diagonal = np.diag(np.eye(3).ravel())
    symmetric = 0.5 * (np.eye(MATRIX) + np.eye(MATRIX)[turn])
    return diagonal, symmetric - diagonal, np.eye(MATRIX) - symmetric


_EACH = np.array(list(product(SIZES, SIZES, _TURNED)))
#: (150, 9, 9) roots of the priors; projections are their own roots; (2, 150) nats of each before.
_ROOTS = np.einsum("sk,kij->sij", _EACH, np.stack(groups()))
_LIKELY = np.log([w / w.sum() for w in (np.ones(len(_EACH)), _EACH.prod(axis=1))])


#: Of a test that tells something from chance.
LEVEL = 1e-6
#: Odds below which it is not said with whom a recording is: one in a thousand of ten is wrong.
_SURE_NATS = np.log(1e4)


class DifferentDevices(CannotClose):
    """Recordings whose matrices differ by more than their scatter; groups: names of each; unsure:
    names of those that could also be with the others."""

    def __init__(self, groups: Sequence[Sequence[str]], unsure: Sequence[str]) -> None:
        names = " and ".join(f"({', '.join(sorted(g))})" for g in groups)
        either = f"; {', '.join(sorted(unsure))} could also be with the others" if unsure else ""
        super().__init__(
            f"these recordings do not have the same axes: {names} differ by more than recordings "
            f"of one device do{either}; close each group by itself"
        )
        self.groups = groups
        self.unsure = unsure


@dataclass(frozen=True)
class _Together:
    names: tuple[str, ...]
    shown: Shown
    apart: float


def distance(one: Shown, other: Shown) -> float:
    """Chi-squared of two statements being of one matrix; a size that no part exceeds bounds what
    either leaves open."""
    bound = np.eye(MATRIX) * SIZES[-1] ** -2
    inverses = [np.linalg.inv(s.normal + bound) for s in (one, other)]
    apart = inverses[0] @ one.right - inverses[1] @ other.right
    return float(apart @ np.linalg.solve(sum(inverses), apart))


def check_one_device(statements: Sequence[tuple[str, Shown]]) -> None:
    """Raises DifferentDevices where two groups of recordings, (name, statement) each, lie farther
    apart than each scatters: an F-test over recordings, for the best of all splits."""
    every = [_Together((name,), shown, 0.0) for name, shown in statements]
    number = len(every)
    if number < 3:
        return
    whole = reduce(_joined, every).apart
    sides = min(_splits(every), key=_parts)
    scatter = max(_parts(sides) / (MATRIX * (number - 2)), 1.0)
    ratio = (whole - _parts(sides)) / MATRIX / scatter
    if fisher.sf(ratio, MATRIX, MATRIX * (number - 2)) * 2.0 ** (number - 1) < LEVEL:
        raise DifferentDevices([s.names for s in sides], _unsure(every, sides, scatter))


def _parts(sides: Sequence[_Together]) -> float:
    return sides[0].apart + sides[1].apart


def _splits(every: Sequence[_Together]) -> Iterator[list[_Together]]:
    """All ways to part up to ten recordings in two; of more, each against the others."""
    number = len(every)
    masks = range(1, 2 ** (number - 1)) if number <= 10 else [1 << k for k in range(number)]
    for mask in masks:
        yield _parted(every, [bool(mask >> k & 1) for k in range(number)])


def _parted(every: Sequence[_Together], first: Sequence[bool]) -> list[_Together]:
    sides = [[s for s, is_first in zip(every, first) if is_first == side] for side in (True, False)]
    return [reduce(_joined, side) for side in sides]


def _unsure(every: Sequence[_Together], sides: Sequence[_Together], scatter: float) -> list[str]:
    """Names of those that on the other side would hardly be worse."""
    first = [s.names[0] in sides[0].names for s in every]
    names = []
    for k, s in enumerate(every):
        other = [side != (j == k) for j, side in enumerate(first)]
        alone = all(other) or not any(other)
        if not alone and _parts(_parted(every, other)) - _parts(sides) < 2 * scatter * _SURE_NATS:
            names.append(s.names[0])
    return names


def _joined(one: _Together, other: _Together) -> _Together:
    apart = one.apart + other.apart + distance(one.shown, other.shown)
    return _Together((*one.names, *other.names), one.shown + other.shown, apart)
