"""What a search comes to: its effects refined, with less in it, and in the board's slots."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from zerorate_tools.loop.search.examine import cancels
from zerorate_tools.loop.search.selection import fits_in_slots
from zerorate_tools.model.term import Term

from . import dense
from .dense import A, B

LAG = Term("temp", lag_s=9.0, lag_mode="lag")
PLAY = Term("temp", memory="play", width=1.0)
TABLE = replace(LAG, table=(0.0,) * 9)
PLAYS = [replace(PLAY, width=float(width)) for width in range(1, 8)]
DELAYS = [replace(LAG, delay_s=float(delay)) for delay in (1, 2, 3)]
PRODUCTS = [Term(f"c{k}", second=f"d{k}") for k in range(4)]


@pytest.mark.parametrize(
    ("terms", "taken", "fits"),
    [
        *(([LAG] * 8, 0, True), ([LAG] * 9, 0, False)),
        *(([LAG] * 6, 2, True), ([LAG] * 6, 3, False)),
        *((PLAYS[:6] + [LAG] * 8, 0, True), (PLAYS, 0, False)),
        (PLAYS[:6] + [replace(p, power=2) for p in PLAYS[:6]], 0, True),
        *((DELAYS[:2], 0, True), (DELAYS, 0, False)),
        *(([TABLE] * 2, 0, True), ([TABLE] * 3, 0, False)),
        *((PRODUCTS + [Term("time"), Term("one")], 0, True), (PRODUCTS + [Term("c9")], 0, False)),
    ],
)
def test_what_the_board_has_room_for(terms, taken, fits):
    assert fits_in_slots(terms, taken) is fits


@pytest.fixture
def alike():
    """alike(apart): sessions with two sources, the first so far from the second."""

    def sources(apart):
        made = [dense.made(1, 20, gap=(3,)), dense.made(2, 23), dense.made(3, 26)]
        for s in made:
            s.sources["b"] = s.sources["a"] + apart * s.sources["c"]
        return made

    return sources


def larger(sessions, beside):
    """Squares of what the first source adds by least squares, over those of the error without."""
    rows = []
    for s in sessions:
        whole = np.column_stack([s.sources["a"], s.sources["b"], s.rate_dps])[s.available]
        rows.append(whole - whole.mean(axis=0))
    a, b, *y = np.vstack(rows).T
    y = np.column_stack(y)
    x = np.column_stack([a, b] if beside else [a])
    size = np.linalg.lstsq(x, y, rcond=None)[0][0]
    without = y - np.outer(b, b @ y) / (b @ b) if beside else y
    return (np.outer(a, size) ** 2).sum() / (without**2).sum()


def test_an_effect_of_twice_the_error_without_it_only_stands_against_another(alike):
    just = brentq(lambda apart: larger(alike(apart), True) - 4.0, 0.01, 1.0)
    assert cancels(alike(0.999 * just), [B], [A])
    assert not cancels(alike(1.001 * just), [B], [A])
    assert larger(alike(1.0), False) < 4 and not cancels(alike(1.0), [], [A])
