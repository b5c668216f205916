"""One device's matrix from what each of its recordings states.

A part's scale factors move a little from day to day with temperature and stress, and what a hand
does differs. So each recording's matrix is the device's plus a scatter of its own (DerSimonian and
Laird 1986); the sizes of entries and of the scatter are averaged by their evidence.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from scipy.special import logsumexp

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

    def share(self, headings: Sequence[np.ndarray]) -> float:
        """The largest share, 0 to 1, of the entries that surely lessens the heading lost in the
        recordings seen. headings: (9, 9) each, mean square of heading by entries.

        With d taken out of M, the mean square of heading grows where `d Q M < d Q d / 2`; M is
        each recording's own, told by its windows and by the device's entries.
        """
        pulls = [h @ self.entries for h in headings]
        less, square = np.transpose([c.along(pulls) for c in self.cases])
        mean = self.weight @ less
        sigma = np.sqrt(self.weight @ (square + less**2) - mean**2)
        size = sum(pull @ self.entries for pull in pulls)
        return float(np.clip(2.0 * (mean - _SURE * sigma) / max(size, 1e-300), 0.0, 1.0))


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
    means = np.stack([c.entries for c in cases])
    mean = weight @ means
    apart = means - mean
    spread = np.einsum("c,cij->ij", weight, np.stack([c.covariance for c in cases]))
    spread += np.einsum("c,ci,cj->ij", weight, apart, apart)
    return Device(mean, spread, cases[int(weight.argmax())].shown, nats, weight, cases)


def _case(statements, sigma, large) -> _Case:
    """Under one scatter, averaged over the sizes."""
    parts = [s.scattered(sigma) for s in statements]
    shown = sum((p[0] for p in parts), Shown())
    nats, means, covariances = _posteriors(shown, sum(p[1] for p in parts) + _LIKELY[int(large)])
    evidence = float(logsumexp(nats))
    weight = np.exp(nats - evidence)
    mean = weight @ means
    spread = np.einsum("s,sij->ij", weight, covariances)
    spread += np.einsum("s,si,sj->ij", weight, means - mean, means - mean)
    return _Case(sigma, statements, shown, evidence, mean, spread)


def _posteriors(shown: Shown, nats: np.ndarray):
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
