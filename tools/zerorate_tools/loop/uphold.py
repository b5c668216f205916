"""An effect that the locked sessions speak against is taken out again.

An effect that is there hardly ever makes a power-on that no fit has seen less likely; what noise
alone made of the others does more often than not. Above all noise steeper than a random walk, which
drifts at every power-on, but each time another way.

Both must: the likelihood, which looks where the noise is small, and the plain error, which is what
counts in the end and where slow noise has most to say.
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
    for worst in _spoken_against(judgement):
        less = selection.without(worst)
        without = judge(less, locked)
        if without.after_rms <= judgement.after_rms:
            name = label(selection.found[worst].candidate)
            said = (name, _said(judgement, worst, without))
            return upheld(replace(less, withdrawn=[*less.withdrawn, said]), locked)
    return selection, judgement


def _spoken_against(judgement: Judgement) -> list[int]:
    """Indices of the effects that the locked sessions lose nats by, the worst first."""
    return [int(i) for i in judgement.gains.argsort() if judgement.gains[i] < -MOST_LOST]


def _said(judgement: Judgement, i: int, without: Judgement) -> str:
    nats = f"what was held out speaks against it by {-judgement.gains[i]:.1f} nats"
    with_it, now = 1e3 * judgement.after_rms, 1e3 * without.after_rms
    return f"{nats}: error with it {with_it:.3g} mdps, without {now:.3g}"
