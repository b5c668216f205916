"""Windows of a recording in motion, each a measurement of the rate error, linear in the errors.

Cosines and sines under a Hann taper turn each window into rows. The taper and its slope
end at zero, so a slow row sees only the hand's position, which is bounded: there is little noise.
Between two rests there is no hand: gravity after a turn less gravity before it is a row, too.
"""

from dataclasses import dataclass

import numpy as np

from ..read.still import runs
from .columns import MATRIX, MOST_HZ, Columns, columns_of
from .moving import Moving

#: Of so many rows their noise is told; fewer are not used.
LEAST_WINDOWS = 8
#: What a row of waves counts: windows a quarter on are a tight frame, four rows for each number.
OVERLAP = 0.25
#: A band of frequencies in which a hand has one loudness.
_BAND_HZ = 0.1
#: A turn between rests: seconds of rest on either side, next to it left out as the turn may reach
#: into them, used; seconds of the longest turn.
_REST_S, _EDGE_S, _USED_S, _LONGEST_TURN_S = 3.0, 1.0, 10.0, 180.0
#: What a turn adds up to between rests: a gyroscope's noise, rad in a root of a second, and what is
#: not in proportion to its rate, a share of it, as if drawn anew each second. Data sheets: 0.01 dps
#: in a root of a Hz, 0.1 %.
_NOISE, _BENT = np.radians(0.01), 1e-3


def tapers(n: int, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """(q, n) rows, each without what is constant, and (q,) the number of their frequency."""
    at = (np.arange(n) + 0.5) / n
    hann = np.sin(np.pi * at) ** 2
    waves = np.arange(1, int(MOST_HZ * seconds) + 1)[:, None]
    cosines, sines = np.cos(2 * np.pi * waves * at), np.sin(2 * np.pi * waves * at)
    cosines[0] += 0.5  # the one that the taper does not make orthogonal to a constant
    rows = np.stack([cosines, sines], axis=1).reshape(-1, n) * hann
    return rows * np.sqrt(2.0 / (0.375 * n)), np.repeat(waves.ravel() - 1, 2)


@dataclass(frozen=True)
class Rows:
    """What windows of a recording measure, in time order.

    errors: (w, q, 3); columns: (w, q, 3, p); tilting: (w, q, 3, 3) by a steady turn of the window's
    frame in rad/s; there: (w, q) bool, other rows are zeros; kinds: (q, 3) number of rows of one
    noise, the vertical's apart; counts: (q,) share of a row that is no other row's; bands: (b, q)
    whether a row is of a band, the last one of turns between rests; heading: (9, 9) by entries,
    mean square of the steady drift of heading, rad/s, that is as far off over a window, or beside
    an attitude of all three turns.
    """

    errors: np.ndarray
    columns: np.ndarray
    tilting: np.ndarray
    there: np.ndarray
    kinds: np.ndarray
    counts: np.ndarray
    bands: np.ndarray
    heading: np.ndarray


def rows_of(moving: Moving, seconds: float, matrix: np.ndarray, own: np.ndarray) -> Rows | None:
    """Of windows of so many seconds, and of turns between rests; None without a window."""
    spans = moving.spans(seconds)
    if not spans:
        return None
    found, headings, kinds = _measured(columns_of(moving, matrix, own), moving, spans, seconds)
    if not headings:
        return None
    _, errors, of = (np.stack(part) for part in zip(*sorted(found, key=lambda f: f[0])))
    counts = np.append(np.full(len(kinds) - 1, OVERLAP), 1.0)
    band = np.append(kinds[:-1] / seconds // _BAND_HZ, -1)
    bands = (band == np.unique(band)[:, None]) * 1.0
    upright = 0 if moving.given is not None else kinds[-1] + 1
    kinds = kinds[:, None] + [0, 0, upright]
    heading = np.mean(headings, axis=0)
    there = np.asarray(of.any(axis=(2, 3)))
    return Rows(errors, of[..., :-3], of[..., -3:], there, kinds, counts, bands, heading)


def _measured(
    columns: Columns, moving: Moving, spans: list[slice], seconds: float
) -> tuple[list[tuple[int, np.ndarray, np.ndarray]], list[np.ndarray], np.ndarray]:
    """First step, errors (q, 3) and columns (q, 3, p + 3) of each window and turn between rests;
    (9, 9) of each window as `Rows.heading`; (q,) number of each row's frequency."""
    long = int(seconds / columns.step_s)
    rows, kinds = tapers(long, seconds)
    rows, kinds = np.vstack([rows, np.zeros(long)]), np.append(kinds, kinds[-1] + 1)
    found, headings = [], []
    for first in np.searchsorted(columns.at, [s.start for s in spans]):
        steps = np.arange(first, min(first + long, len(columns.at)))
        seen, of = columns.of(steps)
        if len(seen) == long and np.isfinite(seen).all():
            level = _level(seen) if moving.given is None else np.eye(3)
            found.append((first, rows @ seen @ level.T, level @ np.tensordot(rows, of, 1)))
            headings.append(_heading(columns, steps))
    turns = _rests_beside_turns(columns, moving) if headings and moving.given is None else []
    found += [(t[0][0], *_between(columns, moving, *t, len(rows))) for t in turns]
    return found, headings, kinds


def _rests_beside_turns(columns: Columns, moving: Moving) -> list[tuple[np.ndarray, np.ndarray]]:
    """Steps of the rest before and of that after each turn that moves gravity."""
    last = np.append(columns.at[1:], len(moving.still)) - 1
    still = runs(moving.still[columns.at] & moving.still[last])
    least, edge, used = (round(s / columns.step_s) for s in (_REST_S, _EDGE_S, _USED_S))
    rests = [(a, b) for a, b in still if b - a >= least]
    found = []
    for (first, end), (start, stop) in zip(rests, rests[1:]):
        between = slice(columns.at[end - edge - 1], columns.at[start + edge])
        before = np.arange(max(first, end - used), end - edge)
        after = np.arange(start + edge, min(stop, start + used))
        brief = (start - end) * columns.step_s < _LONGEST_TURN_S
        if brief and moving.whole(between):
            found.append((before, after))
    return found


def _between(
    columns: Columns, moving: Moving, before: np.ndarray, after: np.ndarray, q: int
) -> tuple[np.ndarray, np.ndarray]:
    """(q, 3) and (q, 3, p + 3) of gravity after a turn less gravity before it, as the last row:
    over what a data sheet lets the turn between be wrong by."""
    row = np.r_[np.full(len(before), -1 / len(before)), np.full(len(after), 1 / len(after))]
    turn = moving.rate[columns.at[before[-1]] : columns.at[after[0]]]
    row /= np.sqrt((len(turn) * _NOISE**2 + (turn**2).sum() * _BENT**2) * moving.dt_s)
    seen, of = columns.of(np.r_[before, after])
    last, level = np.arange(q) == q - 1, _level(seen)
    error, column = row @ seen @ level.T, level @ np.tensordot(row, of, 1)
    return last[:, None] * error, last[:, None, None] * column


def _level(seen: np.ndarray) -> np.ndarray:
    """(3, 3) from the frame of specific force (k, 3) to one whose third axis is up."""
    up = seen.mean(axis=0) / max(np.linalg.norm(seen.mean(axis=0)), 1e-300)
    return np.roll(np.linalg.qr(np.column_stack([up, np.eye(3)]))[0].T, -1, axis=0)


def _heading(columns: Columns, steps: np.ndarray) -> np.ndarray:
    theta = columns.theta[steps][..., :MATRIX]
    turned = theta - theta[0]
    if columns.off is None:
        up = columns.seen[steps].mean(axis=0)
        turned = np.einsum("kir,i->kr", turned, up / np.linalg.norm(up))
    turned = turned.reshape(-1, MATRIX) / (len(steps) * columns.step_s)
    return 3.0 * turned.T @ turned / len(steps)  # a steady drift has a third of its last square
