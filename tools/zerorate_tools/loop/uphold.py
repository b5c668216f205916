"""An effect that the locked sessions speak against is taken out again.

An effect that is there hardly ever makes a power-on that no fit has seen less likely; what noise
alone made of the others does more often than not. Above all noise steeper than a random walk, which
drifts at every power-on, but each time another way.

Bends of a single recording stay: there the noise's walk is the bend, likelihoods say nothing of it,
and the firmware's own error on pieces left out has judged it already.
"""

from __future__ import annotations

from dataclasses import replace

from .confounding import label
from .judge import Judgement, judge
from .selection import Selection
from .sessions import Session

#: Nats that the locked sessions may lose: a cause that rests there says nothing, not no.
MOST_LOST = 0.5


def upheld(selection: Selection, locked: list[Session]) -> tuple[Selection, Judgement]:
    """What of the effects found the locked sessions do not speak against, and the judgement of it.

    What is taken out is said in `Selection.withdrawn`, with the error that it would have left.
    """
    judgement = judge(selection, locked)
    while (worst := _spoken_against(selection, judgement)) is not None:
        less = selection.without(worst)
        without = judge(less, locked)
        said = (label(selection.found[worst].candidate), _said(judgement, worst, without))
        selection = replace(less, withdrawn=[*less.withdrawn, said])
        judgement = without
    return selection, judgement


def _spoken_against(selection: Selection, judgement: Judgement) -> int | None:
    """Index of the effect that the locked sessions lose most by, if they lose enough."""
    gains = judgement.gains[selection.bends :]
    if not (gains < -MOST_LOST).any():
        return None
    return selection.bends + int(gains.argmin())


def _said(judgement: Judgement, i: int, without: Judgement) -> str:
    nats = f"what was held out speaks against it by {-judgement.gains[i]:.1f} nats"
    with_it, now = 1e3 * judgement.after_rms, 1e3 * without.after_rms
    return f"{nats}: error with it {with_it:.3g} mdps, without {now:.3g}"
