"""What recordings in motion show of the nine entries, and whether it holds on windows held out."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import compress

import numpy as np
from scipy.stats import chi2

from .columns import MATRIX
from .device import LEVEL, Shown, check_one_device, device_of, groups
from .heading import heading_lost, tells_worse
from .matrix import FOLDS, Fitted, again, beside, by_recording, fit, of_what_shows_more
from .moving import Moving, check_axes


@dataclass(frozen=True)
class RateScale:
    """What the windows of the training recordings say, and what those held out say of it.

    matrix: (3, 3) dps per dps, what the gyroscope adds; p_value: of no such matrix; kind:
    scale-factor, cross-axis, turned-axes or several; reference: what it was measured against;
    gains: of each way to judge what was left out, above zero where it is no worse; before, after:
    RMS of what turns windows, in `unit`; fastest_dps: (3,) up to which it was seen; unseen: (3, 3)
    bool, entries that the motion did not show; level: of p; deployed: (3, 3) what is taken out;
    lost: degrees a minute by which the entries turn the heading, without and with what is deployed,
    by their posterior; heading: those lost against an attitude that was given, without and with the
    matrix of what was left out; worse: of that, or of what was fitted, where it forbids the matrix;
    aside: sentences of what was left out; by_others: of several
    recordings without a holdout, what would be deployed by all but the one named.
    """

    matrix: np.ndarray
    deviation: np.ndarray
    p_value: float
    kind: str
    reference: str
    gains: np.ndarray
    before: float
    after: float
    unit: str
    runs: int
    fastest_dps: np.ndarray
    unseen: np.ndarray
    level: float
    deployed: np.ndarray
    lost: tuple[float, float]
    heading: tuple[float, float] | None = None
    worse: tuple[float, float] | None = None
    aside: tuple[str, ...] = ()
    by_others: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def found(self) -> bool:
        """Whether M is significant, some of it seen, and what was left out is better with it."""
        better = bool((self.gains > 0).all())
        return self.p_value < self.level and better and not self.unseen.all()

    @property
    def confirmed(self) -> bool:
        """Whether the windows held out, of which there must be some, are better with it."""
        return self.found and bool(np.isfinite(self.after)) and self.after < self.before

    @property
    def notes(self) -> list[str]:
        """What was left out, and what an attitude forbids, a sentence each."""
        said = [*self.aside]
        if self.worse is not None:
            before, after = self.worse
            lost = f"heading would lose {after:.2f} degrees a minute against the attitude"
            said.append(f"the matrix is not deployed: {lost}, {before:.2f} without it")
        return said


GRAVITY, GIVEN = "gravity while it moved", "the reference given"
UNIT = {GRAVITY: "degrees a minute of tilt", GIVEN: "degrees a minute of turn"}


def seen_in_words(before: float, unit: str) -> str:
    """What is left where motion shows no matrix. before: RMS of what turns windows, in the unit."""
    if unit == UNIT[GIVEN]:
        return f"the reference sees {before:.2f} {unit}"
    return f"gravity sees {before:.2f} {unit}, the device's own acceleration included"


#: Sigma of an entry above which the motion did not show it, a data sheet's 0.5 %; of an entry that
#: is larger, as of axes that are turned, a third of it.
UNSEEN, _CLEAR = 0.005, 1 / 3
#: Of devices without errors, so many may be said to have one.
_LEVEL = 1 / 200
#: By how much more may be left and be no worse, as the loop's figures count harm: headings of half
#: a minute, and tilts of a recording held out, scatter by as much. Parts of a recording that others
#: of it were fitted to share its pushes, and must get better.
_NO_WORSE, _BETTER = 1.02, 1.0
#: Of an entry: what a share of nothing leaves of it in floats is none.
_DECIMALS = 12
#: Of the whole matrix: a part that is smaller is not named.
_TRIFLE = 0.1


@dataclass(frozen=True)
class _Judged:
    """A recording, its rates integrated without a matrix and beside the one that is deployed, as
    what turns a frame by much is not linear in the entries; step: (9,) by which entries of others
    differ from those deployed; fold: the part that is judged, None for all."""

    bare: Fitted
    beside: Fitted
    step: np.ndarray
    fold: int | None

    def gain(self) -> float:
        """Nats by which the entries are likelier than none."""
        return self.beside.nats(self.step, self.fold) - self.bare.nats(0.0 * self.step, self.fold)

    def tilts(self) -> np.ndarray:
        """(2, w, 2) tilts of windows and what they are worth, without entries and with them."""
        bare = self.bare.tilts(0.0 * self.step, self.fold)
        return np.array([bare, self.beside.tilts(self.step, self.fold)])


def by_windows(train: list[Moving], holdout: list[Moving]) -> RateScale | None:
    """The matrix of the recordings to fit, judged on windows held out and on the heading where an
    attitude is given; None where none moves or too little to be judged on.

    holdout: recordings held out whole; without any, every fourth part of each is, in turn. Raises
    CannotClose for axes that do not agree, and DifferentDevices.
    """
    for moving in [*train, *holdout]:
        check_axes(moving)
    used = [[of_what_shows_more(m) for m in part] for part in (train, holdout)]
    shown = _by_windows(*used)
    if shown is None:
        return None
    pairs = zip([*train, *holdout], [m for part in used for m in part])
    unused = ", ".join(m.name for m, now in pairs if now is not m)
    why = "gravity shows more of the axes than the reference given, which was left out"
    aside = [f"{unused}: {why}"] if unused else []
    aside += [m.railed for m in (*train, *holdout) if m.railed]
    return replace(_judged_by_heading(shown, *used) if shown.found else shown, aside=tuple(aside))


def _judged_by_heading(shown: RateScale, train: list[Moving], holdout: list[Moving]) -> RateScale:
    """With what the heading gains in what was left out, and in what was fitted."""
    left_out = list(_left_out(shown, train, holdout))
    fitted = [(m, shown.deployed) for m in train]
    heading = heading_lost(left_out)
    either = ((heading, left_out), (heading_lost(fitted), fitted))
    told = [lost for lost, judged in either if lost is not None and tells_worse(judged)]
    most = _NO_WORSE if shown.reference == GIVEN else _BETTER
    gains = [most * before - after for before, after in told]
    worse = next((lost for lost, gain in zip(told, gains) if gain <= 0), None)
    return replace(shown, heading=heading, worse=worse, gains=np.r_[shown.gains, gains])


def _left_out(
    shown: RateScale, train: list[Moving], holdout: list[Moving]
) -> Iterator[tuple[Moving, np.ndarray]]:
    """Recordings with an attitude, beside a matrix that they were not fitted to: each that is held
    out, else each beside the others, one alone its second half beside its first."""
    if holdout:
        yield from ((m, shown.deployed) for m in holdout)
    elif len(train) == 1:
        middle = len(train[0].rate) // 2
        first, second = (train[0].part(s) for s in (slice(middle), slice(middle, None)))
        yield second, _deployed([first])
    else:
        yield from ((m, shown.by_others[m.name]) for m in train if m.name in shown.by_others)


def _deployed(train: list[Moving]) -> np.ndarray:
    shown = _by_windows(train, [])
    return shown.deployed if shown is not None else np.zeros((3, 3))


def _by_others(
    statements: Mapping[str, Shown], headings: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Name -> (3, 3) what would be deployed by all recordings but this one, linear about the matrix
    of all."""
    names = statements.keys() if len(statements) > 1 else ()
    others = {name: [n for n in names if n != name] for name in names}
    devices = {name: device_of([statements[n] for n in rest]) for name, rest in others.items()}
    kept = {name: d.kept([headings[n] for n in others[name]]) for name, d in devices.items()}
    return {name: (kept[name] @ d.entries).reshape(3, 3) for name, d in devices.items()}


def _by_windows(train: list[Moving], holdout: list[Moving]) -> RateScale | None:
    matrix, fitted = fit(train)
    if not fitted:
        return None
    statements = by_recording((f, f.shown(matrix)) for f in fitted)
    check_one_device(list(statements.items()))
    device = device_of(list(statements.values()))
    headings = {f.moving.name: f.heading for f in fitted}
    seen = [*headings.values()]
    kept = device.kept(seen)
    entries, covariance, shown = device.entries, device.covariance, device.shown
    # small sizes are the better guess; how far off it is, is not said as if they were known
    wide = device_of(list(statements.values()), large=True)
    deviation = np.sqrt(np.diag(wide.covariance) + (wide.entries - entries) ** 2)
    deployed = kept @ entries
    ways = [way for m in holdout for way in m.measured]
    held = [(f, 0.0 * matrix) for f in (beside(m, 0.0 * matrix) for m in ways) if f is not None]
    held_out = [_Judged(*_either(*one, deployed), 0.0 * deployed, None) for one in held]
    left_out = list(_folds(fitted, matrix, kept, deployed))
    judged = held_out or left_out
    if not judged:
        return None
    gain, predicted = (sum(j.gain() for j in some) for some in (judged, left_out))
    given = {f.moving.name for f in fitted if f.moving.given is not None}
    reference = GIVEN if given >= statements.keys() else GRAVITY
    by_it = [f for f in fitted if (f.moving.given is not None) == (reference == GIVEN)]
    told = [j for j in judged if (j.bare.moving.given is not None) == (reference == GIVEN)]
    before, after = _tilt([j.tilts() for j in told])
    most = _NO_WORSE if held_out or reference == GIVEN else _BETTER
    fastest = np.degrees(np.max([np.abs(f.moving.rate).max(axis=0) for f in fitted], axis=0))
    sigma = np.sqrt(np.diag(np.linalg.pinv(shown.normal + _FAINT)))
    unseen = sigma > np.maximum(UNSEEN, _CLEAR * np.abs(entries))
    return RateScale(
        matrix=entries.reshape(3, 3),
        deviation=deviation.reshape(3, 3),
        # a likelihood ratio averaged over sizes: Markov bounds its chance without errors. The fit
        # takes the noise for even, which a few bouts of a hand are not: parts left out must agree.
        p_value=float(np.exp(-max(min(device.nats, predicted), 0.0))),
        level=0.0 if all(f.moving.planar and f.moving.given is None for f in fitted) else _LEVEL,
        deployed=np.round(deployed, _DECIMALS).reshape(3, 3) + 0.0,  # no -0.0
        lost=(device.heading_lost(seen, 0 * deployed), device.heading_lost(seen, deployed)),
        kind=_kind(entries, covariance),
        reference=reference,
        gains=np.array([gain, most * before - after]),
        before=before,
        after=after,
        unit=UNIT[reference],
        runs=sum(len(f.rows.errors) for f in by_it),
        fastest_dps=fastest,
        unseen=unseen.reshape(3, 3),
        by_others={} if holdout else _by_others(statements, headings),
    )


#: Keeps an inverse finite where nothing at all was seen: an entry of ten.
_FAINT = np.eye(MATRIX) * 1e-2


def _either(f: Fitted, matrix: np.ndarray, entries: np.ndarray) -> tuple[Fitted, Fitted]:
    """A recording fitted beside a matrix, beside none and beside entries (9,)."""
    return again(f, matrix, 0.0 * matrix), again(f, matrix, entries.reshape(3, 3))


def _folds(
    fitted: list[Fitted], matrix: np.ndarray, kept: np.ndarray, deployed: np.ndarray
) -> Iterator[_Judged]:
    """Each recording's part held out, with the entries that all other parts show."""
    either = [_either(f, matrix, deployed) for f in fitted]
    for k in range(FOLDS):
        left = [(f.folds == k).any() and (f.folds != k).any() for f in fitted]
        if any(left):
            said = by_recording((f, f.without(matrix, k)) for f in fitted)
            step = kept @ device_of(list(said.values())).entries - deployed
            yield from (_Judged(*e, step, k) for e in compress(either, left))


def _tilt(parts: Sequence[np.ndarray]) -> tuple[float, float]:
    """RMS of what turns windows without entries and with them. parts: as `_Judged.tilts`."""
    tilt, worth = np.moveaxis(np.concatenate([np.zeros((2, 0, 2)), *parts], axis=1), 2, 0)
    worth = worth.sum(axis=0)
    before, after = np.sqrt(tilt**2 @ worth / worth.sum()) if worth.any() else (np.nan, np.nan)
    return float(before), float(after)


def _kind(entries: np.ndarray, covariance: np.ndarray) -> str:
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
