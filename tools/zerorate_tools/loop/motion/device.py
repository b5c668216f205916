"""One device's matrix from what each of its recordings states.

A part's scale factors move a little from day to day with temperature and stress, and what a hand
does differs. So each recording's matrix is the device's plus a scatter of its own (DerSimonian and
Laird 1986); the sizes of entries and of the scatter are averaged by their evidence.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from .windows import MATRIX

#: Sizes that a group of entries may have; the last allows what a data sheet does.
SIZES = (3e-4, 1e-3, 3e-3, 1e-2, 3e-2)
#: Scatter of an entry between recordings: none, up to a change of temperature by 50 degrees.
_SCATTER = (0.0, 3e-4, 1e-3, 3e-3)


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
    say together, with the likeliest scatter."""

    entries: np.ndarray
    covariance: np.ndarray
    shown: Shown


def device_of(statements: Sequence[Shown]) -> Device:
    """The device of which every recording states something. Scale factors, cross-axis
    sensitivities and turns of the axes each have a size of their own."""
    cases = []
    for sigma in _SCATTER if len(statements) > 1 else _SCATTER[:1]:
        parts = [s.scattered(sigma) for s in statements]
        shown = sum((p[0] for p in parts), Shown())
        cases.append((shown, *_posteriors(shown, sum(p[1] for p in parts))))
    evidence = np.stack([c[1] for c in cases])
    weight = np.exp(evidence - evidence.max())
    weight /= weight.sum()
    means, covariances = np.stack([c[2] for c in cases]), np.stack([c[3] for c in cases])
    mean = np.einsum("ts,tsi->i", weight, means)
    apart = means - mean
    spread = np.einsum("ts,tsij->ij", weight, covariances)
    spread += np.einsum("ts,tsi,tsj->ij", weight, apart, apart)
    return Device(mean, spread, cases[int(weight.sum(axis=1).argmax())][0])


def _posteriors(shown: Shown, nats: float):
    """Evidence, mean and covariance of the entries under each of the sizes."""
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


#: (125, 9, 9) roots of the priors; projections are their own roots.
_ROOTS = np.einsum("sk,kij->sij", np.array(list(product(SIZES, repeat=3))), np.stack(groups()))
