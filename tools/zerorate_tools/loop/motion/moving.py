"""A recording as its motion is read: rates, acceleration, rests, an attitude if one is given."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from ...recordings import open_recording
from ...recordings.reading import OpenRecording
from ...recordings.recording import ACCEL, GYRO, TIME
from ...recordings.turning import axes_of, axes_words
from ...simulate.attitude import IDENTITY, integrate, into_body, multiply, rotation
from ..read.bad_readings import saturated
from ..read.gate import CannotClose
from ..read.reference import Reference
from ..read.still import runs, still_ticks
from ..read.ticks import TICK_S, AnyPath, Ticks, read_ticks
from .clock import GAP, evenly

#: A device is in motion where its rates spread by this in a window.
LEAST_DPS = 5.0
#: Shares, of the mean square, of rates about other axes than the main one and of gravity beside its
#: mean direction, below which a device turns about one axis in one pose: a tenth of it, rms.
_PLANAR = 0.01
_RAIL, _MOST_RAILED = 32767, 0.01
#: scipy's order of a quaternion.
W_LAST = [1, 2, 3, 0]
#: Of a recording whose rates spread by less no window moves.
_WORTH_READING_DPS = 1.0
#: Share of the samples that an attitude must be seen at: below it gravity shows more.
_LEAST_SEEN = 0.5
#: Seconds over which gravity is held in one place by about the right bias, and samples asked.
_HELD_S, _SOME = 3.0, 65_536
#: Of what an attitude's turns lack of the rates', its inverse's lack no more; and of the rates'
#: turns, an attitude lacks no more: optical ones lack 0.02 to 0.26 of a phone's or a hand's.
_PLAINLY = 0.5
#: Rounds in which seconds that are far off are left out of a fit; three more move a share by 0.002.
_ROBUST = 3
#: Rests this long are a reading of the bias, with what it wanders meanwhile.
_REST_TICKS, REST_SIGMA = 10, np.radians(0.005)


@dataclass(frozen=True)
class Moving:
    """A recording as motion needs it.

    rate: (n, 3) rad/s less `offset` (3,), which is near the bias; accel: (n, 3) g; at_s: (n,) from
    the recording's middle; turned, felt, still: (n,) bool, no rate, no force is at the end of its
    range, at rest; rests: (k, 4) s and rad/s less the offset; given: (n, 4) attitude, body to a
    frame that stands still, NaN where it was not seen and free to change there, None where none is
    given; mounted: whether it is that of a body whose axes are turned against the sensor's, which
    is no error of the sensor.
    """

    name: str
    rate: np.ndarray
    accel: np.ndarray
    at_s: np.ndarray
    turned: np.ndarray
    felt: np.ndarray
    still: np.ndarray
    offset: np.ndarray
    rests: np.ndarray
    given: np.ndarray | None = None
    mounted: bool = False

    @cached_property
    def dt_s(self) -> float:
        """Seconds between samples, gaps left out; a mean, as stamps are whole microseconds and a
        sample that is lost now and then is time all the same."""
        apart_s = np.diff(self.at_s)
        return float(apart_s[apart_s <= GAP * np.median(apart_s)].mean())

    @property
    def usable(self) -> np.ndarray:
        """(n,) bool: what a window may hold. Beside an attitude no force is asked."""
        return self.turned if self.given is not None else self.turned & self.felt

    @property
    def railed(self) -> str:
        """How much is at the end of a sensor's range, in words; empty where hardly any is."""
        share = 1.0 - float(self.usable.mean())
        words = (
            f"{self.name}: {100 * share:.0f} % of the readings are at the end of a sensor's range "
            "and show nothing: move it gently, or widen the gyroscope's or accelerometer's range"
        )
        return words if share > _MOST_RAILED else ""

    @property
    def planar(self) -> bool:
        """Whether it turns about one axis in one pose, as a robot on a floor. An acceleration that
        goes with such turns, as speed times rate does, is then no different from axes that are off.
        """
        n = max(1, round(1.0 / self.dt_s))
        accel, rate = (x[: len(x) // n * n].reshape(-1, n, 3) for x in (self.accel, self.rate))
        moves = np.degrees(np.sqrt((rate**2).sum(axis=2).mean(axis=1))) > LEAST_DPS
        poses = accel[moves].mean(axis=1)
        # an accelerometer that reads nothing has no pose
        poses = poses / np.maximum(np.linalg.norm(poses, axis=1, keepdims=True), 1e-9)
        return _beside_main(poses) < _PLANAR and _beside_main(rate[moves].reshape(-1, 3)) < _PLANAR

    @property
    def measured(self) -> list["Moving"]:
        """The recording beside what was given, and beside gravity: axes that are turned against the
        accelerometer's are what an attitude of a mounted body does not show."""
        both = self.mounted and self.given is not None and self.accel.any()
        return [self, replace(self, given=None, mounted=False)] if both else [self]

    def part(self, span: slice) -> "Moving":
        """Of its samples."""
        names = ("rate", "accel", "at_s", "turned", "felt", "still")
        parts = {n: getattr(self, n)[span] for n in names}
        at_s = parts["at_s"]
        inside = (self.rests[:, 0] >= at_s[0]) & (self.rests[:, 0] <= at_s[-1])
        given = None if self.given is None else self.given[span]
        return replace(self, **parts, rests=self.rests[inside], given=given)

    def spans(self, seconds: float) -> list[slice]:
        """Windows of so many seconds, each a quarter on, that move, without gap or rail."""
        if seconds not in self._spans:
            n, end = round(seconds / self.dt_s), len(self.rate)
            spans = [slice(a, a + n) for a in range(0, end - n + 1, n // 4)] if n > 8 else []
            self._spans[seconds] = [s for s in spans if self._moves(s)]
        return self._spans[seconds]

    @cached_property
    def _spans(self) -> dict[float, list[slice]]:
        """By their seconds, as they are asked for again and again."""
        return {}

    def _moves(self, s: slice) -> bool:
        spread = np.degrees(np.sqrt(self.rate[s].var(axis=0).sum()))
        return self.whole(s) and spread > LEAST_DPS

    def whole(self, s: slice) -> bool:
        """Whether samples are without gap or rail."""
        apart_s = self.at_s[s][-1] - self.at_s[s][0] - (s.stop - s.start - 1) * self.dt_s
        return bool(abs(apart_s) < GAP * self.dt_s and self.usable[s].all())


def _beside_main(vectors: np.ndarray) -> float:
    """Share of the mean square of vectors (n, 3) that lies across their main direction."""
    squares = np.linalg.eigvalsh(vectors.T @ vectors)
    return float(1.0 - squares[-1] / max(squares.sum(), 1e-300))


def check_axes(moving: Moving) -> None:
    """Raise CannotClose where gravity turns as it would about other axes than those of the rates:
    no small error of a matrix is told then; or where the attitude given turns as its inverse, or
    neither so."""
    if moving.mounted and moving.given is not None:
        left, inverse = _unexplained(moving, moving.given)
        if inverse < _PLAINLY * min(left, 1.0):
            raise CannotClose(
                f"{moving.name}: its attitude turns the world's axes into the body's: import it "
                "with --map qx=-COLUMN --map qy=-COLUMN --map qz=-COLUMN"
            )
        if left > _PLAINLY:
            raise CannotClose(
                f"{moving.name}: its attitude does not turn as the rates do from second to second: "
                "import it without qw qx qy qz, or with the attitude of this device and time"
            )
    if moving.given is not None or not moving.accel.any():
        return
    axes = axes_of(np.degrees(moving.rate).T, moving.accel.T, moving.at_s)
    if axes is not None and not np.array_equal(axes, np.eye(3)):
        raise CannotClose(
            f"{moving.name}: gravity turns as if the rates x y z were {axes_words(axes)} of the "
            "accelerometer's axes: import it with --map gx=-COLUMN or the like, so that both agree"
        )


def _unexplained(moving: Moving, given: np.ndarray) -> tuple[float, float]:
    """What the turns of an attitude, and of its inverse, lack of the rates', as a share."""
    ends = seconds_seen(given, moving.dt_s)
    if not ends:
        return 0.0, 1.0
    integrated = integrate(np.degrees(moving.rate), moving.dt_s, IDENTITY)
    ours = turned_between(integrated, ends).as_rotvec()
    either = (given, given * [1.0, -1.0, -1.0, -1.0])
    turns = (turned_between(q, ends).as_rotvec() for q in either)
    left, inverse = (_lacking(ours, theirs) for theirs in turns)
    return left, inverse


def _lacking(ours: np.ndarray, theirs: np.ndarray) -> float:
    """What turns (n, 3) lack of ours beside a bias, as a share of ours. Absolute values: optics
    that lose a body for a second are wrong by half a turn there."""
    near, bias = np.full(len(ours), True), np.zeros(3)
    for _ in range(_ROBUST):
        apart = ours - _mounting((ours - bias)[near], theirs[near]).apply(theirs)
        bias = np.median(apart, axis=0)
        size = np.linalg.norm(apart - bias, axis=1)
        near = size <= 2.0 * np.median(size)
    return float(size.sum() / max(np.linalg.norm(ours, axis=1).sum(), 1e-300))


def moving_of(path: AnyPath, ticks: Ticks | None = None) -> Moving | None:
    """A recording read for its motion; None where it never turns, or has neither an accelerometer
    nor a reference.

    Raises BadRecording.
    """
    opened = open_recording(path, keep_gaps=True)
    reference = Reference(opened.column_names, opened.scales.gyro_lsb_per_dps)
    lsb_per_g = opened.scales.accel_lsb_per_g if set(ACCEL) <= set(opened.column_names) else None
    if lsb_per_g is None and not reference.names:
        return None
    t_us, gyro, accel, given = _samples(opened, lsb_per_g, reference)
    rate = gyro * np.radians(1.0) / opened.scales.gyro_lsb_per_dps
    if len(t_us) < 16 or np.degrees(rate.std(axis=0).max()) < _WORTH_READING_DPS:
        return None
    railed = [(np.abs(x) >= _RAIL).any(axis=1) | saturated(x) for x in (gyro, accel)]
    t_us, put = evenly(t_us)
    rate, accel = put(rate), put(accel)
    turned, felt = (put(np.where(x, np.nan, 0.0)[:, None])[:, 0] == 0.0 for x in railed)
    ticks = ticks or read_ticks(path, TICK_S)
    still = still_ticks(ticks)
    rests = _rests(ticks, still)
    offset = np.median(rests[:, 1:], axis=0) if len(rests) else _offset(rate, accel, t_us)
    middle_us = 0.5 * (t_us[0] + t_us[-1])
    rests[:, 0] += (ticks.start_us - middle_us) * 1e-6
    rests[:, 1:] -= offset
    tick = ((t_us - ticks.start_us) / (ticks.tick_s * 1e6)).astype(np.int64)
    moving = Moving(
        *(opened.name, rate - offset, accel / (lsb_per_g or 1.0), (t_us - middle_us) * 1e-6),
        *(turned, felt, still[np.clip(tick, 0, len(still) - 1)], offset, rests),
    )
    given = put(given)
    if reference.rates:
        given = _attitude_by(given, moving.dt_s)
    seen = np.isfinite(given).all(axis=1).mean() if reference.names else 0.0
    if seen <= _LEAST_SEEN:
        return moving
    if reference.rates:
        return replace(moving, given=given)
    return replace(moving, given=in_the_axes_of(moving, given), mounted=True)


def _offset(rate: np.ndarray, accel: np.ndarray, t_us: np.ndarray) -> np.ndarray:
    """(3,) rad/s near the bias of what never rests: the mean, or nothing where that holds gravity
    more in one place over seconds, as of a hand that turns one way more than back."""
    some = slice(_SOME)
    dt_s = float(np.median(np.diff(t_us[some]))) * 1e-6
    n = max(1, round(_HELD_S / dt_s))

    def held(offset: np.ndarray) -> float:
        attitude = integrate(np.degrees(rate[some] - offset), dt_s, IDENTITY)
        seen = [(into_body(attitude, e) * accel[some]).sum(axis=1) for e in np.eye(3)]
        means = np.add.reduceat(seen, np.arange(0, len(attitude), n), axis=1)
        return float(np.linalg.norm(means, axis=0).sum())

    return max(rate.mean(axis=0), np.zeros(3), key=held)


def in_the_axes_of(moving: Moving, given: np.ndarray) -> np.ndarray:
    """The attitude (n, 4) turned, once, so that its body has the axes of the rates."""
    ends = seconds_seen(given, moving.dt_s)
    if not ends:
        return given
    integrated = integrate(np.degrees(moving.rate), moving.dt_s, IDENTITY)
    theirs, ours = (turned_between(q, ends).as_rotvec() for q in (given, integrated))
    return multiply(given, rotation(-np.degrees(_mounting(ours, theirs).as_rotvec())))


def _mounting(ours: np.ndarray, theirs: np.ndarray) -> Rotation:
    """From the axes of turns (n, 3) to those of ours; what no turn shows is left as it is."""
    faint = np.eye(3) * np.sqrt(_PLANAR * (ours**2).sum())
    return Rotation.align_vectors(np.vstack([ours, faint]), np.vstack([theirs, faint]))[0]


def seconds_seen(attitude: np.ndarray, dt_s: float) -> list[tuple[int, int]]:
    """First and last sample of each second, one after the other, at both of which an attitude
    (n, 4) was seen."""
    seen, second = np.isfinite(attitude).all(axis=1), max(1, round(1.0 / dt_s))
    ends = [(a, a + second) for a in range(0, len(seen) - second, second)]
    return [(a, b) for a, b in ends if seen[a] and seen[b]]


def turned_between(attitude: np.ndarray, ends: Sequence[tuple[int, int]]) -> Rotation:
    """From the first to the last sample of each pair of an attitude (n, 4), in the body's frame."""
    first, last = (Rotation.from_quat(attitude[list(at)][:, W_LAST]) for at in zip(*ends))
    return first.inv() * last


def _attitude_by(rate_dps: np.ndarray, dt_s: float) -> np.ndarray:
    """(n, 4) attitude that true rates (n, 3) tell, NaN where they are not known."""
    known = np.isfinite(rate_dps).all(axis=1)
    attitude = integrate(np.where(known[:, None], rate_dps, 0.0), dt_s, IDENTITY)
    attitude[~known] = np.nan
    return attitude


def _rests(ticks: Ticks, still: np.ndarray) -> np.ndarray:
    """(k, 4) s from the first tick and mean rate in rad/s of its rests, ten ticks each."""
    parts = [
        (a, min(a + _REST_TICKS, end))
        for first, end in runs(still)
        for a in range(first, end, _REST_TICKS)
    ]
    rows = [
        [0.5 * (a + b) * ticks.tick_s, *np.radians(ticks.rate[a:b].mean(axis=0))]
        for a, b in parts
        if b - a >= _REST_TICKS // 2
    ]
    return np.array(rows).reshape(-1, 4)


def _samples(
    opened: OpenRecording, lsb_per_g: float | None, reference: Reference
) -> tuple[np.ndarray, ...]:
    """Times in us, rates and accelerations in LSB, and what the reference gives."""
    rows = []
    for batch in filter(lambda b: len(b[TIME]), opened.batches(rows=262_144)):
        t_us, gyro = batch[TIME], np.column_stack([batch[n] for n in GYRO])
        accel = np.column_stack([batch[n] for n in ACCEL]) if lsb_per_g else np.zeros_like(gyro)
        given = np.zeros((len(t_us), 0))
        if reference.rates:
            given = reference.rate_dps(t_us, batch, None)
        elif reference.attitude:
            given = reference.quaternions(batch)
        rows.append((t_us, gyro, accel, given))
    return tuple(np.concatenate(part) for part in zip(*rows))
