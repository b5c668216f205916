"""An effect that the held-out sessions speak against is taken out again.

An effect that is there hardly ever makes a power-on that no fit has seen less likely; what noise
alone made of the others does more often than not. Both the likelihood, which looks where the noise
is small, and the plain error, which is what counts in the end, must speak against it. And on no
axis may the error grow: there the effect is left out, whatever the likelihood says, unless those
found after it need it: with all of them the error is smaller than before it, and than with all but
it.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.stats import wilcoxon

from ..fit.noise import USUAL
from ..read.sessions import Session
from ..search.selection import Selection
from .judge import Judgement, judge, residuals, rms_dps


def prune_by_holdout(selection: Selection, holdout: list[Session]) -> tuple[Selection, Judgement]:
    """What of the effects found the holdout does not speak against, and the judgement of it.

    What is taken out is said in `Selection.withdrawn`, with the error that it would have left.
    """
    judgement = judge(selection, holdout)
    if selection.stands_alone:
        return selection, judgement
    for i in [int(i) for i in judgement.gains.argsort() if judgement.gains[i] < 0]:
        less = selection.without(i)
        without = judge(less, holdout)
        if without.after_rms <= judgement.after_rms:
            said = (selection.found[i].candidate.label, _said(judgement, i, without))
            return prune_by_holdout(replace(less, withdrawn=[*less.withdrawn, said]), holdout)
    some = [*map(selection.first, range(len(selection.found))), selection]
    after = [_left(one, holdout) for one in some]
    less = without_harmful(selection, after, lambda i: _left(selection.without(i), holdout))
    return (selection, judgement) if less is selection else prune_by_holdout(less, holdout)


def _left(selection: Selection, holdout: list[Session]) -> list[np.ndarray]:
    return [r for r, _ in residuals(selection, holdout)]


def without_harmful(
    selection: Selection,
    after: Sequence[list[np.ndarray]],
    without: Callable[[int], list[np.ndarray]],
) -> Selection:
    """The selection without what makes the error larger: of every axis the effect that does so
    most, or the selection itself where none does.

    after: residuals (n, 3) of what was held out with the first 0, 1, ... effects; without: with all
    but the i-th.
    """
    errors = np.array([rms_dps(r) for r in after])
    grows = _grows(selection, errors, without)
    worst = grows.max(axis=0, initial=0.0)
    for i in reversed(range(len(grows))):
        axes = (grows[i] > 0) & (grows[i] == worst)
        if axes.any():
            selection = selection.without_axes(i, axes, _grown(errors, i))
    return selection


def _grows(
    selection: Selection, errors: np.ndarray, without: Callable[[int], list[np.ndarray]]
) -> np.ndarray:
    """(effects, 3) by which the error is larger with an effect; zero where later ones need it.

    errors: (1 + effects, 3) with the first so many; without: as for `without_harmful`.
    """
    grows = errors[1:] - errors[:-1]
    used = np.array([f.axes for f in selection.found], bool).reshape(grows.shape)
    grows = np.where(used, grows, 0.0)
    for i in range(len(grows) - 1):
        needed = (grows[i] > 0) & (errors[-1] <= errors[i])
        if needed.any():
            needed &= errors[-1] <= rms_dps(without(i))
            grows[i, needed] = 0.0
    return grows


def _grown(errors: np.ndarray, i: int) -> str:
    with_it, now = (1e3 * float(np.sqrt((e**2).mean())) for e in (errors[i + 1], errors[i]))
    return f"the error of what was held out grows: with it {with_it:.3g} mdps, without {now:.3g}"


def _said(judgement: Judgement, i: int, without: Judgement) -> str:
    nats, with_it, now = -judgement.gains[i], 1e3 * judgement.after_rms, 1e3 * without.after_rms
    why = f"what was held out speaks against it by {nats:.1f} nats"
    return f"{why}: error with it {with_it:.3g} mdps, without {now:.3g}"


def without_unshown(
    selection: Selection,
    after: Sequence[list[np.ndarray]],
    without: Callable[[int], list[np.ndarray]],
    pieces: Sequence[np.ndarray],
) -> Selection:
    """The selection without the effect that pieces left out show least, if noise alone gains as
    much in as many of them once in twenty times; else the selection itself.

    after, without: as of `without_harmful`; pieces: (n,) of each recording, which piece
    each block is of.
    """
    if not selection.found:
        return selection
    rest = [*map(without, range(len(selection.found) - 1)), after[-2]]
    gained = [_gained(left, after[-1], pieces) for left in rest]
    chances = [float(wilcoxon(g, zero_method="zsplit", alternative="greater")[1]) for g in gained]
    least = int(np.argmax(chances))
    if chances[least] <= USUAL:
        return selection
    better, number = (gained[least] > 0).sum(), len(gained[least])
    why = f"better on {better} of {number} pieces left out, which may be chance"
    said = selection.found[least].candidate.label, why
    less = selection.without(least)
    return replace(less, withdrawn=[*less.withdrawn, said])


def _gained(
    before: list[np.ndarray], after: list[np.ndarray], pieces: Sequence[np.ndarray]
) -> np.ndarray:
    """(pieces,) dps^2 less over the blocks of each piece of all recordings."""
    each = (np.nansum(b**2 - a**2, axis=1) for b, a in zip(before, after))
    return np.concatenate([np.bincount(of, less) for of, less in zip(pieces, each)])
