"""The matrix of a gyroscope from its motion: scale factor, cross-axis sensitivity, turned axes.

`error = M rate`, nine entries common to the recordings. Each recording also has a bias, its drift,
its accelerometer's errors, a delay and a lever arm. All are fitted beside them.
The noise is the hand's acceleration: its spectrum comes from the residuals of each recording.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.ndimage import uniform_filter1d

from .columns import ACCEL_BIAS, BIAS, DRIFT, LONGEST_S, MATRIX, MOUNTING, OWN, OWN_SIGMA
from .device import SIZES, Shown, device_of, distance, groups
from .moving import REST_SIGMA, Moving
from .windows import LEAST_WINDOWS, Rows, rows_of

#: Short windows first: a large bias bends long ones.
_SECONDS = (10.0, 20.0, LONGEST_S, LONGEST_S)
FOLDS = 4
_LEAST_BLOCK, _MOST_BLOCKS = 4, 8
#: Rows that a data sheet's word on turns between rests is worth: three turns.
_TURN_WORTH = 6.0
#: Degrees of freedom of a hand's loudness: few, and yet it has a variance.
FREEDOM, ROUNDS = 4.0, 6
#: A turn of the axes turns the frame that headings are told in, once: no heading is lost by it.
_NO_TURN = np.eye(MATRIX) - groups()[-1]
#: Of its own errors those before a delay and a lever arm, which are small, are taken out.
_TAKEN_OUT = np.arange(sum(OWN.values())) < MOUNTING.stop
_WIDTH = np.concatenate([np.full(n, OWN_SIGMA[name]) for name, n in OWN.items()])


@dataclass
class Fitted:
    """A recording beside a matrix: its own errors, their precision before (p,), rows of its
    windows, precision (w, q, 3) and noise (q, 3) of them, folds (w,) of a window, heading (9, 9) as
    of `Rows`, and doubt, by how much parts of it contradict each other.
    """

    moving: Moving
    own: np.ndarray
    likely: np.ndarray
    rows: Rows
    precision: np.ndarray
    folds: np.ndarray
    heading: np.ndarray
    noise: np.ndarray = field(default_factory=lambda: np.ones(1))
    doubt: float = 1.0

    def shown(self, matrix: np.ndarray, fold: int | None = None) -> Shown:
        """What its windows say, or those of one fold, linear about the matrix."""
        return self._of(matrix, self.of(fold))

    def without(self, matrix: np.ndarray, fold: int) -> Shown:
        """What its windows say without a fold, nor those that lie next to it and share its data."""
        held = np.pad(self.folds == fold, 1)
        return self._of(matrix, ~(held[:-2] | held[1:-1] | held[2:]))

    def normal(self, take: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """(p, p) and (p,) normal equations of some windows (w,), or of all, of its rests, and of
        what its own errors were before."""
        squares, rights = self._by_window
        share = np.ones(len(rights)) if take is None else take * 1.0
        normal, right = np.tensordot(share, squares, 1), share @ rights
        at = np.arange(MATRIX, len(right))
        normal[at, at] += self.likely
        right[MATRIX:] -= self.likely * self.own
        rests, left = self._of_rests()
        normal[MATRIX:, MATRIX:] += rests
        right[MATRIX:] += left
        return normal, right

    @cached_property
    def _by_window(self) -> tuple[np.ndarray, np.ndarray]:
        """(w, p, p) and (w, p) normal equations of each window."""
        columns, errors = self.rows.columns, self.rows.errors
        w, q, _, p = columns.shape
        flat = columns.reshape(w, 3 * q, p)
        weight = (self.rows.counts[:, None] * self.precision).reshape(w, 1, 3 * q)
        weighted = flat.transpose(0, 2, 1) * weight
        return weighted @ flat, (weighted @ errors.reshape(w, 3 * q, 1))[..., 0]

    def _of_rests(self) -> tuple[np.ndarray, np.ndarray]:
        """(p, p) and (p,) of its own errors alone: a rest shows the bias and its drift."""
        at_s, rate = self.moving.rests[:, 0], self.moving.rests[:, 1:]
        design = np.zeros((len(at_s), 3, len(self.own)))
        design[:, :, BIAS] = np.eye(3)
        design[:, :, DRIFT] = at_s[:, None, None] * np.eye(3)
        flat = design.reshape(-1, len(self.own)) / REST_SIGMA
        return flat.T @ flat, flat.T @ (rate.ravel() / REST_SIGMA - flat @ self.own)

    def own_beside(self, step: np.ndarray) -> np.ndarray:
        """By how much its own errors change where the entries do by a step (9,)."""
        normal, right = self.normal()
        right = right[MATRIX:] - normal[MATRIX:, :MATRIX] @ step
        return np.linalg.solve(normal[MATRIX:, MATRIX:], right)

    def move(self, step: np.ndarray) -> None:
        """Move its own errors to where they are likeliest beside a matrix moved by (3, 3)."""
        self.own += _TAKEN_OUT * self.own_beside(step.ravel())

    def _of(self, matrix: np.ndarray, take: np.ndarray) -> Shown:
        normal, right = self.normal(take)
        own, back = normal[MATRIX:, MATRIX:], normal[:MATRIX, MATRIX:]
        bare = normal[:MATRIX, :MATRIX] - back @ np.linalg.solve(own, back.T)
        right = right[:MATRIX] - back @ np.linalg.solve(own, right[MATRIX:])
        return Shown(bare, right + bare @ matrix.ravel())

    def left(self, step: np.ndarray) -> np.ndarray:
        """(w, q, 3) what is left of rows beside entries that are a step (9,) from the matrix; what
        the recording has of its own is fitted anew."""
        return self.rows.errors - self.rows.columns @ np.r_[step, self.own_beside(step)]

    def nats(self, step: np.ndarray, fold: int | None) -> float:
        """Log-likelihood of a fold, or of all, beside entries a step (9,) off, less sure by as much
        as its parts contradict each other."""
        rows, counts = self.rows, self.rows.counts * self.rows.there
        square = (counts[..., None] * self.left(step) ** 2 / self.noise).sum(axis=2)
        loud = (FREEDOM + 3.0 * counts @ rows.bands.T) * np.log1p(square @ rows.bands.T / FREEDOM)
        quiet = counts @ np.log(self.noise).sum(axis=1)
        return float(-0.5 * (loud.sum(axis=1) + quiet)[self.of(fold)].sum() / self.doubt)

    def of(self, fold: int | None) -> np.ndarray:
        """(w,) whether a window is of a fold, or of any."""
        return self.folds >= 0 if fold is None else self.folds == fold

    def tilts(self, step: np.ndarray, fold: int | None) -> np.ndarray:
        """(w, 2) degrees a minute by which each window's frame tilts against gravity beside entries
        a step (9,) off, and what that is worth: a hand that pushes hides a tilt."""
        rows, left, take = self.rows, self.left(step), self.of(fold)
        slow = rows.tilting * self.precision[..., None]
        square = np.einsum("wqac,wqad->wcd", slow, rows.tilting)[take]
        score = np.einsum("wqac,wqa->wc", slow, left)[take]
        rate = np.einsum("wcd,wd->wc", np.linalg.pinv(square, rcond=1e-6, hermitian=True), score)
        tilt = np.degrees(np.linalg.norm(rate, axis=1)) * 60.0
        return np.column_stack([tilt, np.trace(square, axis1=1, axis2=2)])


def fit(recordings: list[Moving]) -> tuple[np.ndarray, list[Fitted]]:
    """(3, 3) the matrix of all, and each recording beside it, twice where it has an attitude;
    recordings without a whole window in motion are left out."""
    matrix = np.zeros((3, 3))
    fitted: dict[int, Fitted] = {}
    measured = [way for moving in recordings for way in moving.measured]
    for seconds in _SECONDS:
        for key, moving in enumerate(measured):
            now = _beside(moving, seconds, matrix, fitted.get(key))
            if now is not None:
                fitted[key] = now
        every = list(fitted.values())
        if not every:
            break
        said = by_recording((f, f.shown(matrix)) for f in every)
        step = device_of(list(said.values())).entries.reshape(3, 3) - matrix
        for f in every:
            f.move(step)
        matrix = matrix + step
    return matrix, list(fitted.values())


def by_recording(said: Iterable[tuple[Fitted, Shown]]) -> dict[str, Shown]:
    """What each recording says, by its name: the sum of what it says in each way, less sure by as
    much as the ways contradict each other."""
    ways: dict[str, list[Shown]] = {}
    for fitted, shown in said:
        ways.setdefault(fitted.moving.name, []).append(shown)
    return {name: _as_one(every) for name, every in ways.items()}


def _as_one(ways: list[Shown]) -> Shown:
    apart = distance(*ways) / MATRIX if len(ways) > 1 else 1.0
    whole, less_sure = sum(ways, Shown()), max(1.0, apart)
    return Shown(whole.normal / less_sure, whole.right / less_sure)


def beside(moving: Moving, matrix: np.ndarray) -> Fitted | None:
    """A recording with errors of its own beside a matrix that it took no part in."""
    fitted = None
    for seconds in _SECONDS:
        fitted = _beside(moving, seconds, matrix, fitted)
        if fitted is not None:
            fitted.move(np.zeros((3, 3)))
    return fitted


def again(f: Fitted, matrix: np.ndarray, other: np.ndarray) -> Fitted:
    """A recording that was fitted beside a matrix, integrated anew beside another."""
    own = f.own + _TAKEN_OUT * f.own_beside((other - matrix).ravel())
    fitted = _beside(f.moving, _SECONDS[-1], other, replace(f, own=own))
    assert fitted is not None, "it was fitted before"
    return fitted


def of_what_shows_more(moving: Moving) -> Moving:
    """The recording, without its attitude where gravity shows more of the matrix: an attitude with
    jumps or drift, or one that is hardly seen."""
    if moving.given is None:
        return moving
    every = (moving, replace(moving, given=None))
    fitted = [(f, m) for m in every if (f := beside(m, np.zeros((3, 3)))) is not None]
    return max(fitted, key=lambda f: _known(f[0]), default=(None, moving))[1]


def _known(f: Fitted) -> float:
    """Nats by which its windows narrow the entries of a data sheet; turns of the axes, which an
    attitude of a mounted body cannot show, are not counted."""
    normal = _NO_TURN @ f.shown(np.zeros((3, 3))).normal @ _NO_TURN
    return float(np.linalg.slogdet(np.eye(MATRIX) + SIZES[-1] ** 2 * normal)[1])


def _beside(
    moving: Moving, seconds: float, matrix: np.ndarray, before: Fitted | None
) -> Fitted | None:
    own = np.zeros(sum(OWN.values())) if before is None else before.own.copy()
    longest = (s for s in reversed(_SECONDS) if s <= seconds)
    fit_in = (s for s in longest if len(moving.spans(s)) >= LEAST_WINDOWS)
    seconds = next(fit_in, _SECONDS[0])
    rows = rows_of(moving, seconds, matrix, own)
    if rows is None:
        return None
    windows = len(rows.errors)
    blocks = min(max(windows // _LEAST_BLOCK, FOLDS), _MOST_BLOCKS)
    folds = np.arange(windows) * blocks // windows % FOLDS
    fixed = moving.given is not None and not moving.mounted
    heading = rows.heading if fixed else _NO_TURN @ rows.heading @ _NO_TURN
    fitted = Fitted(moving, own, _WIDTH**-2.0, rows, np.ones(rows.errors.shape), folds, heading)
    for _ in range(ROUNDS):
        fitted = _weighed(fitted, matrix)
    doubt = _contradiction(fitted, matrix)
    return replace(fitted, doubt=doubt, precision=fitted.precision / doubt)


def _contradiction(f: Fitted, matrix: np.ndarray) -> float:
    """By how much parts of a recording differ more than their errors allow (Birge 1932): a hand
    whose acceleration moves with the turning fits one part and not the next. 1 where they agree."""
    excess = [distance(f.shown(matrix, k), f.without(matrix, k)) for k in set(f.folds)]
    return max(1.0, float(np.mean(excess)) / MATRIX) if len(excess) > 1 else 1.0


def _weighed(f: Fitted, matrix: np.ndarray) -> Fitted:
    """With the precision of rows and of its own errors once more. A hand is now quiet and now loud:
    beside the noise of each frequency each window and band has a loudness of its own (Student's t,
    by expectation and maximisation: Lange, Little and Taylor 1989)."""
    rows = f.rows
    number = 2.0 * (rows.counts * rows.there) @ rows.bands.T
    left, taken, own = _left(f, matrix)
    free = rows.there[..., None] - np.minimum(taken * f.precision, 1.0)
    noise = _variances(rows, f.precision * f.noise * left, free)[rows.kinds]
    level = (rows.counts[:, None] * (left + taken) / noise)[..., :2].sum(axis=2)
    quiet = (FREEDOM + number) / (FREEDOM + level @ rows.bands.T)
    precision = (quiet @ rows.bands)[..., None] / noise
    return replace(f, noise=noise, precision=precision, likely=_likely(own))


def _likely(own: np.ndarray) -> np.ndarray:
    """(p,) precision of a recording's own errors before, given their mean squares (p,). A force
    that it carries along, as a drone its thrust, is no different from an accelerometer's bias, and
    may be any: their size has a loudness of its own, too."""
    precision = _WIDTH**-2.0
    number = ACCEL_BIAS.stop - ACCEL_BIAS.start
    level = (own * precision)[ACCEL_BIAS].sum()
    precision[ACCEL_BIAS] *= (FREEDOM + number) / (FREEDOM + level)
    return precision


def _left(f: Fitted, matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(w, q, 3) squares of what is left of rows, the variance of what the fit took there, and mean
    squares (p,) of its own errors. Pushes up and down go with strides, and an accelerometer's
    errors fit them: all that waves show of the vertical is left."""
    normal, right = f.normal()
    normal[:MATRIX, :MATRIX] += np.eye(MATRIX) * SIZES[-1] ** -2
    right[:MATRIX] -= matrix.ravel() * SIZES[-1] ** -2
    inverse, columns = np.linalg.inv(normal), f.rows.columns
    step = inverse @ right
    left = (f.rows.errors - columns @ step) ** 2
    if f.moving.given is None:
        upright = f.rows.errors + columns[..., MATRIX:] @ f.own
        left[:, :-1, 2] = upright[:, :-1, 2] ** 2
    taken = np.stack([((window @ inverse) * window).sum(axis=2) for window in columns])
    return left, taken, (f.own + step[MATRIX:]) ** 2 + np.diag(inverse)[MATRIX:]


def _variances(rows: Rows, left: np.ndarray, free: np.ndarray) -> np.ndarray:
    """(k,) of each noise. Of waves those of one frequency and the next are much alike; the last,
    of turns between rests, is what data sheets say where there are few."""
    sums = [np.bincount(rows.kinds.ravel(), x.sum(axis=0).ravel()) for x in (left, free)]
    parts = np.reshape(sums, (2, -1, rows.kinds[-1, 0] + 1))
    parts[..., -1] += _TURN_WORTH
    noise = np.log(np.where(parts[0] > 0, parts[0], 1.0) / np.maximum(parts[1], 1e-3))
    noise[:, :-1] = uniform_filter1d(noise[:, :-1], 3, axis=1, mode="nearest")
    # a large tilt is vertical, too: what the columns have of it is linear
    return np.exp([noise[0], noise.max(axis=0)]).ravel()
