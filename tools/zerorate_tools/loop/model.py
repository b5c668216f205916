"""The found effects as data: what model.json holds and model.bin is made from."""

from __future__ import annotations

import numpy as np

from .basis import Term
from .select import Selection

VERSION = 1


def slots(selection: Selection, coefficients: np.ndarray) -> list[dict]:
    """One dict a slot: effect, term fields, coefficient per axis in dps per unit of its basis.

    coefficients: (straight line and terms, 3), as `Analysis.coefficients`.
    """
    kinds = [f.candidate.kind for f in selection.found for _ in f.candidate.terms]
    rows = coefficients[len(selection.straight) :]
    return [
        {"effect": kind, **term.to_dict(), "coefficient_dps": [float(c) for c in row]}
        for kind, term, row in zip(kinds, selection.terms, rows)
    ]


def terms_of(slots: list[dict]) -> tuple[list[Term], np.ndarray]:
    """Terms and (terms, 3) coefficients of `slots`' dicts."""
    own = ("effect", "coefficient_dps")
    terms = [Term.from_dict({k: v for k, v in s.items() if k not in own}) for s in slots]
    rows = np.array([s["coefficient_dps"] for s in slots]).reshape(len(slots), 3)
    return terms, rows
