"""What recordings in motion show of the nine entries, and whether it holds on windows held out."""

import numpy as np
from scipy.stats import chi2

from .columns import MATRIX
from .device import device_of, groups
from .matrix import FOLDS, beside, fit
from .moving import Moving
from .rate_scale import RateScale
from .same_device import LEVEL, check_one_device

GRAVITY, GIVEN = "gravity while it moved", "the reference given"
_UNIT = {GRAVITY: "degrees a minute of tilt", GIVEN: "degrees a minute of turn"}
#: Posterior sigma of an entry above which the motion did not show it: a data sheet's 0.5 %.
UNSEEN = 0.005
#: Of devices without errors, so many may be said to have one.
_LEVEL = 1 / 200
#: Of the whole matrix: a part that is smaller is not named.
_TRIFLE = 0.1


def by_windows(train: list[Moving], holdout: list[Moving]) -> RateScale | None:
    """The matrix of the recordings to fit, judged on windows held out; None where none moves
    or too little to be judged on.

    holdout: recordings held out whole; without any, every fourth part of each is, in turn. Raises
    DifferentDevices.
    """
    matrix, fitted = fit(train)
    if not fitted:
        return None
    check_one_device([(f.moving.name, f.shown(matrix)) for f in fitted])
    device = device_of([f.shown(matrix) for f in fitted])
    share = device.share([f.heading for f in fitted])
    entries, covariance, shown = device.entries, device.covariance, device.shown
    # small sizes are the better guess; how far off it is, is not said as if they were known
    wide = device_of([f.shown(matrix) for f in fitted], large=True)
    deviation = np.sqrt(np.diag(wide.covariance) + (wide.entries - entries) ** 2)
    held = [f for f in (beside(m, matrix) for m in holdout) if f is not None]
    left_out = list(_folds(fitted, matrix, share))
    judged = [(f, None, share * entries) for f in held] or left_out
    if not judged:
        return None
    gain, predicted = (_gain(some, matrix) for some in (judged, left_out))
    before, after = (
        _tilt([f.tilts(matrix, x, k) for f, k, m in judged for x in [0.0 * m if bare else m]])
        for bare in (True, False)
    )
    fastest = np.degrees(np.max([np.abs(f.moving.rate).max(axis=0) for f in fitted], axis=0))
    reference = GIVEN if all(f.moving.given is not None for f in fitted) else GRAVITY
    unseen = np.sqrt(np.diag(np.linalg.pinv(shown.normal + _FAINT))) > UNSEEN
    return RateScale(
        matrix=entries.reshape(3, 3),
        deviation=deviation.reshape(3, 3),
        # a likelihood ratio averaged over sizes: Markov bounds its chance without errors. The fit
        # takes the noise for even, which a few bouts of a hand are not: parts left out must agree.
        p_value=float(np.exp(-max(min(device.nats, predicted), 0.0))),
        level=0.0 if all(f.moving.planar and f.moving.given is None for f in fitted) else _LEVEL,
        share=share,
        kind=_kind(entries, covariance),
        reference=reference,
        gains=np.array([gain, before - after]),
        before=before,
        after=after,
        unit=_UNIT[reference],
        runs=sum(len(f.rows.errors) for f in fitted),
        fastest_dps=fastest,
        unseen=unseen.reshape(3, 3),
    )


#: Keeps an inverse finite where nothing at all was seen: an entry of ten.
_FAINT = np.eye(MATRIX) * 1e-2


def _folds(fitted, matrix, share):
    """Each recording's part held out, with the entries that all other parts show."""
    for k in range(FOLDS):
        left = [f for f in fitted if (f.folds == k).any() and (f.folds != k).any()]
        if left:
            entries = device_of([f.without(matrix, k) for f in fitted]).entries
            yield from ((f, k, share * entries) for f in left)


def _gain(judged, matrix) -> float:
    """Nats by which entries are likelier than none in parts that they were not fitted to."""
    return float(sum(f.shown(matrix, k).gain(m) for f, k, m in judged))


def _tilt(parts) -> float:
    tilt, worth = np.concatenate([np.zeros((0, 2)), *parts]).T
    return float(np.sqrt(worth @ tilt**2 / worth.sum())) if worth.any() else float("nan")


def _kind(entries, covariance) -> str:
    """Which of the three it is, by what its own entries are worth; all that are clear and no trifle
    beside the others."""
    said = []
    for name, onto in zip(("scale-factor", "cross-axis", "turned-axes"), groups()):
        size = onto @ entries
        spread = onto @ covariance @ onto.T
        free = round(float(np.trace(onto)))
        clear = np.linalg.norm(size) > _TRIFLE * np.linalg.norm(entries)
        if clear and chi2.sf(size @ np.linalg.pinv(spread, rcond=1e-6) @ size, free) < LEVEL:
            said.append(name)
    return "+".join(said) or "scale-factor+cross-axis"
